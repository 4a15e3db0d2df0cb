using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// One island's step by whatever it takes: RATTLE; where that does not converge, or energy shows that it is too coarse, in parts that are halved where they
/// fail; where shorter parts are of no use, a projected step. Steps are also cut up front where bodies turn far or where tension makes them stiff.
/// </summary>
internal sealed partial class StepController
{
    /// <summary>The most halvings that a step begins with.</summary>
    public const int MaxHalvings = 10;

    // Halvings after which a part that fails is left to the method that needs no chord.
    private const int MaxRattleHalvings = 12;

    // The most that steps keep where limits and drives act: blows end the long account of energy for which their parts stay even.
    private const int MaxKeptHalvings = 5;

    // Tries in a step, beside those that it begins with, after which drives are slowed down, and those with slower drives after which parts that fail are left
    // to the method that needs no chord.
    private const int MostTries = 12;
    private const int MostTriesSlowed = 4;

    // Stops in a step after which the rest of it is not tried: the scene cannot be followed, and says so.
    private const int MaxDampedSteps = 8;

    // What a part that stands still leaves of the speeds.
    private const double KeptSpeed = 0.9;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly ConjugateGradient _conjugateGradient;
    private readonly Substep _part;
    private readonly StepStart _stepStart;
    private readonly Snapshot _start;
    private readonly Snapshot _partStart;
    private readonly StepEnergy _energy;
    private int _dampedInStep;
    private bool _hasLookedForHeld;
    private bool _hasMoved;
    private int _worst;
    private double _worstError;
    private StepTroubles _troubles;

    // What is tried beside halves of the parts that fail, and the tries after which it is more.
    private Resort _resort;
    private int _mostTries;

    private double _dt;
    private double _tolerance;

    public StepController(LaneBatch<ScalarLane> batch)
    {
        _batch = batch;
        _conjugateGradient = new ConjugateGradient(batch);
        _part = new Substep(batch, _conjugateGradient);
        _stepStart = new StepStart(batch, _conjugateGradient);
        _start = new Snapshot(batch);
        _partStart = new Snapshot(batch);
        _energy = new StepEnergy(batch, MaxKept);
    }

    /// <summary>Parts in which the island stood still: no method could take them, or too many before them.</summary>
    public int DampedSteps { get; private set; }

    /// <summary>Parts of the last step that were tried: 1 of a plain one.</summary>
    public int Tries => _part.Tries;

    /// <summary>A whole step of dt from the loaded state; the batch is built at the start pose.</summary>
    /// <param name="dt">Step, s.</param>
    /// <param name="tolerance">Largest C, metres or radians.</param>
    /// <param name="cut">The island's cut; takes note of the step.</param>
    /// <param name="still">The island's; takes note of the step.</param>
    /// <param name="hasFailed">Whether the plain step was tried already.</param>
    /// <param name="isMoved">Whether the start pose is not the one that the last step left.</param>
    public void Advance(double dt, double tolerance, ref SubstepHistory cut, Standstill still, bool hasFailed, bool isMoved)
    {
        if (still.IsKnown(_batch, dt, cut.Halvings))
        {
            StandStill(still.Verdict);
            return;
        }

        Begin(dt, tolerance, cut, hasFailed);
        _stepStart.Close(tolerance, isMoved);
        if (hasFailed || HasClosed || HasForbiddenSpeed)
        {
            ProjectStartSpeeds();
        }

        int stops = DampedSteps;
        int halvings = FirstHalvings(hasFailed && !_part.IsEager ? Math.Max(cut.Halvings, 1) : cut.Halvings, out double demand);
        SaveStart();
        FindDrivesThatMove();
        halvings = TakePartsUntilFineEnough(halvings);
        End(ref cut, halvings, demand);
        if (_dampedInStep == 0 || _hasMoved)
        {
            still.Forget();
            return;
        }

        Damp(0);
        still.Remember(new StepVerdict { Stops = DampedSteps - stops, Worst = _worst, Error = _worstError, Troubles = _troubles });
    }

    private void Begin(double dt, double tolerance, in SubstepHistory history, bool hasFailed)
    {
        Array.Clear(_batch.Work.TotalImpulses, 0, _batch.Work.TotalImpulses.Length);
        _batch.ActiveSet?.ClearWork();
        _batch.Work.CompliantWork[0] = 0;
        _batch.Work.DrivenWork = 0;
        _part.Begin(dt);
        _part.Tries = 0;
        _part.IsEager = hasFailed && _batch.ActiveSet != null;
        _part.HoldsPassedLimits = false;
        _dt = dt;
        _tolerance = tolerance;
        _dampedInStep = 0;
        _hasMoved = false;
        _hasLookedForHeld = false;
        _energy.Begin(dt, tolerance, history.Energy, history.IsSingular);
        _batch.ActiveSet?.BeginPace(dt);
    }

    private void ProjectStartSpeeds()
    {
        if (_stepStart.IsLeftOpen())
        {
            _energy.Ignore();
        }

        _stepStart.ProjectSpeeds();
    }

    // Halvings that the step has up front, by how far bodies turn and how stiff tension makes them; drives that rest on ask for none.
    private int FirstHalvings(int kept, out double demand)
    {
        int halvings = kept;
        demand = StepLimit.Of(_batch, _dt);
        if (demand > 1 << halvings && RestOn())
        {
            demand = StepLimit.Of(_batch, _dt);
        }

        while (halvings < MaxHalvings && demand > 1 << halvings)
        {
            halvings++;
        }

        return halvings;
    }

    private bool RestOn() => _batch.ActiveSet != null && _batch.ActiveSet.RestOn();

    private void SaveStart()
    {
        _start.Save(_batch);
        _energy.MarkStart();
    }

    // Drives that were held may be so no more, and those that rest may be free.
    private void FindDrivesThatMove()
    {
        if (_batch.ActiveSet != null && _batch.ActiveSet.HasHeld())
        {
            FindHeldDrives(_start, _dt);
        }

        if (_batch.ActiveSet != null && _batch.ActiveSet.NextResting(0) >= 0)
        {
            HeldDrives.Wake(_batch, _batch.ActiveSet, _conjugateGradient);
            Return(_start, _dt);
        }
    }

    private void FindHeldDrives(Snapshot start, double h)
    {
        _hasLookedForHeld = true;
        HeldDrives.Find(_batch, _batch.ActiveSet!, _conjugateGradient);
        Return(start, h);
    }

    // Once more from its start in shorter parts where the account does not take what they left too much. The halvings of the next step's.
    private int TakePartsUntilFineEnough(int halvings)
    {
        int next = TakeParts(halvings);
        while (halvings < MaxKept && _dampedInStep == 0 && _energy.IsTooCoarse)
        {
            ReturnToStart();
            halvings++;
            next = TakeParts(halvings);
        }

        return next;
    }

    private void ReturnToStart()
    {
        _energy.BeginAgain();
        Return(_start, _dt);
        _hasMoved = false;
    }

    private bool HasRunAway => !_hasLookedForHeld && _batch.ActiveSet is { HasRunAway: true };

    // What the island's next step takes from this one.
    private void End(ref SubstepHistory cut, int halvings, double demand)
    {
        cut.IsSingular = _energy.StaysSingular;
        _energy.Enter(ref cut.Energy);
        bool comesToRest = false;
        cut.IsSlowedDown = _batch.ActiveSet != null && _batch.ActiveSet.EndPace(_dt, _tolerance / _dt, out comesToRest);
        if (!comesToRest)
        {
            cut.Record(halvings, demand);
        }

        _part.SetLength(_dt);
    }

    // The step as it was made before from the same state.
    private void StandStill(in StepVerdict verdict)
    {
        Array.Clear(_batch.Work.TotalImpulses, 0, _batch.Work.TotalImpulses.Length);
        _part.Tries = 1;
        _stepStart.Forget();
        DampedSteps += verdict.Stops;
        _worst = verdict.Worst;
        _worstError = verdict.Error;
        _troubles = verdict.Troubles;
        Damp(0);
    }

    private int MaxKept => _batch.ActiveSet == null ? MaxHalvings : MaxKeptHalvings;

    // The step in parts of so many halvings, and shorter ones where these fail; where more are asked for than steps keep, longer ones once bodies turn less.
    // The halvings of the next step's.
    private int TakeParts(int halvings)
    {
        int least = Math.Min(halvings, MaxKeptHalvings);
        var length = new PartLength(least, halvings);
        _resort = Resort.None;
        _mostTries = _part.Tries + MostTries + (1 << halvings);
        bool isOfEnergy = false;
        while (!length.IsDone && _dampedInStep < MaxDampedSteps)
        {
            while (halvings > least && length.Halvings < MaxHalvings && StepLimit.Of(_batch, _dt) > 1 << length.Halvings)
            {
                length.Halve();
            }

            double h = _dt / (1 << length.Halvings);
            Snapshot start = SavePartStart(length.IsFirst);
            if (!TryPart(h, length.Halvings, out bool hasArrived))
            {
                Return(start, h);
                if (IsChanged(start, h, hasArrived, ref length))
                {
                    continue;
                }

                isOfEnergy |= hasArrived;
                if (TakesNextResort(ref length) || TriesInHalves(start, h, ref length, new PartLength(least, halvings)))
                {
                    continue;
                }
            }

            _energy.BeginPart();
            length.Take(_energy.IsSmooth);
        }

        // What does not arrive in one place is none of the next step's.
        return Math.Min(MaxKept, length.Fewest == least + 1 && !isOfEnergy ? least : length.Fewest);
    }

    // Whether the step has had its tries, and what is left of it is tried otherwise.
    private bool TakesNextResort(ref PartLength length)
    {
        if (_resort >= Resort.Projection || _part.Tries < _mostTries)
        {
            return false;
        }

        _resort = _resort == Resort.None && _batch.ActiveSet != null && _batch.ActiveSet.SlowDown() ? Resort.SlowerDrives : Resort.Projection;
        _mostTries = _part.Tries + MostTriesSlowed;
        length.Lengthen(MaxKeptHalvings);
        return true;
    }

    private Snapshot SavePartStart(bool isFirst)
    {
        if (isFirst)
        {
            return _start;
        }

        _partStart.Save(_batch);
        return _partStart;
    }

    // Of a part that RATTLE does not take: false where it was made by the method that needs no chord, or, the shortest, stood still.
    private bool TriesInHalves(Snapshot start, double h, ref PartLength length, in PartLength whole)
    {
        bool isProjected = _resort == Resort.Projection || _energy.IsOfAnyLength || length.Halvings >= MaxRattleHalvings;
        if (isProjected && TryProjected(h, length.Halvings))
        {
            return false;
        }

        if (length.Halvings < PartLength.MaxHalvings)
        {
            Return(start, h);
            length.Halve();
            return true;
        }

        if (_resort == Resort.Projection)
        {
            _resort = Resort.Halves;
            ReturnToStart();
            length = whole;
            return true;
        }

        Stop(start, h);
        return false;
    }

    private bool TryPart(double h, int halvings, out bool hasArrived)
    {
        _part.SetLength(h);
        _part.HoldsPassedLimits = halvings >= MaxRattleHalvings;
        hasArrived = _part.TryRattle(h, _tolerance) && !HasRunAway;
        if (!hasArrived || !_energy.TryTake(h, halvings))
        {
            return false;
        }

        _hasMoved = true;
        return true;
    }

    // What a part that goes well has no need to ask: whether the loop is singular, which speeds the joints forbid at the step's start and which drives they
    // hold, and whether rows keep to their bounds in each iteration. Whether the part is worth another try after it.
    private bool IsChanged(Snapshot start, double h, bool hasArrived, ref PartLength length)
    {
        if (_energy.HasBecomeSingular())
        {
            length.Lengthen(_energy.FirstGainHalvings);
            return true;
        }

        if (length.IsFirst && RestOn())
        {
            start.Save(_batch);
            return true;
        }

        bool isChanged = LooksForHeld(start, h);
        if (length.IsFirst && !_stepStart.HasProjectedSpeeds)
        {
            ProjectStartSpeeds();
            SaveStart();
            isChanged = true;
        }

        return isChanged;
    }

    private bool LooksForHeld(Snapshot start, double h)
    {
        if (_hasLookedForHeld || _batch.ActiveSet == null || !_batch.ActiveSet.HasEndless())
        {
            return false;
        }

        FindHeldDrives(start, h);
        return true;
    }

    // A part that no method takes stands still, and of the first in the step it is noted why.
    private void Stop(Snapshot start, double h)
    {
        if (_dampedInStep == 0)
        {
            MeasureWorstResidual();
            start.Restore(_batch);
            FindTroubles();
        }

        Return(start, h);
        _dampedInStep++;
        DampedSteps++;
        Damp(KeptSpeed);
        _energy.TakeStop();
    }

    private bool TryProjected(double h, int halvings)
    {
        if (!_part.TryProjected(h, _tolerance, _energy.Start) || !_energy.TryTake(h, halvings))
        {
            return false;
        }

        _hasMoved = true;
        return true;
    }

    private void Return(Snapshot start, double h)
    {
        start.Restore(_batch);
        _part.Begin(h);
    }

    // The poses stay for this substep and the motion slows down, so that a state that no method can leave comes to rest.
    private void Damp(double share)
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.V);
            for (int i = 0; i < 6; i++)
            {
                double kept = share * _batch.Bodies[o + i];
                _batch.Bodies[o + i] = Math.Abs(kept) < 1e100 ? kept : 0;
            }
        }

        _batch.ClearHistory();
    }
}
