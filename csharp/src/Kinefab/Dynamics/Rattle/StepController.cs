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
    private const int MostTries = 24;
    private const int MostTriesSlowed = 4;

    // Stops in a step after which the rest of it is not tried: the scene cannot be followed, and says so.
    private const int MaxDampedSteps = 8;

    // Largest change of the energy in a step against its kinetic part, where nothing but known forces does work.
    private const double MostEnergyChange = 0.002;

    // Largest growth of the energy in a step, springs included, where scalar rows may take any amount.
    private const double MostEnergyGain = 5e-4;

    // Of what energy may change by in a step, what a part may, and, before it is tried in shorter ones from its start, what all may together.
    private const double PartShare = 0.25;
    private const double MostShares = 2;

    // Halvings after which a gain or loss that is still more than a share of what it was at first is none of the step's.
    private const int TellingHalvings = 3;
    private const double KeptGain = 0.5;

    // What a part that stands still leaves of the speeds.
    private const double KeptSpeed = 0.9;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly ConjugateGradient _conjugateGradient;
    private readonly Substep _part;
    private readonly PositionProjection _closure;
    private readonly Snapshot _start;
    private readonly Snapshot _partStart;
    private int _dampedInStep;
    private bool _isMoved;
    private bool _hasSettled;
    private bool _hasLookedForHeld;
    private bool _hasMoved;
    private int _worst;
    private double _worstError;
    private int _forbidden = -1;
    private double _forbiddenSpeed;
    private StepTroubles _troubles;
    private bool _isAudited;
    private bool _isSingular;
    private bool _wasSingular;

    // Of the step up to the next part: energy that came of nothing, J, and what that is of the allowance.
    private double _gain;
    private double _excess;

    // Of the next part: what the longest that was tried gained, J, whether shorter ones gain as much, and whether the last one speaks for a longer one.
    private int _firstGainHalvings;
    private double _firstGain;
    private bool _isOfAnyLength;
    private bool _isSmooth;

    // What is tried beside halves of the parts that fail, and the tries after which it is more.
    private Resort _resort;
    private int _mostTries;

    // At the step's start, and after the last part that was taken.
    private EnergyAudit _energy;
    private EnergyAudit _end;

    private EnergyLedger _ledger;
    private double _dt;
    private double _elapsed;
    private double _tolerance;

    public StepController(LaneBatch<ScalarLane> batch)
    {
        _batch = batch;
        _conjugateGradient = new ConjugateGradient(batch);
        _part = new Substep(batch, _conjugateGradient);
        _closure = new PositionProjection(batch, _conjugateGradient);
        _start = new Snapshot(batch);
        _partStart = new Snapshot(batch);
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

        Begin(dt, tolerance, cut.IsSingular, hasFailed);
        CloseStartPose(isMoved);
        if (hasFailed || HasClosed || HasForbiddenSpeed)
        {
            ProjectStartSpeeds();
        }

        _ledger = cut.Energy;
        int stops = DampedSteps;
        int halvings = FirstHalvings(hasFailed && !_part.IsEager ? Math.Max(cut.Halvings, 1) : cut.Halvings, out double demand);
        SaveStart();
        FindDrivesThatMove();
        halvings = TakeParts(halvings, ref cut);
        End(ref cut, halvings, demand);
        if (_dampedInStep == 0 || _hasMoved)
        {
            still.Forget();
            return;
        }

        Damp(0);
        still.Remember(new StepVerdict { Stops = DampedSteps - stops, Worst = _worst, Error = _worstError, Troubles = _troubles });
    }

    private void Begin(double dt, double tolerance, bool isSingular, bool hasFailed)
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
        _elapsed = 0;
        _dampedInStep = 0;
        _hasMoved = false;
        _hasSettled = false;
        _hasLookedForHeld = false;
        _isSingular = isSingular;
        _wasSingular = isSingular;
        _firstGain = 0;
        _gain = 0;
        _excess = 0;
        _isOfAnyLength = false;
        _isAudited = LaneEnergy<ScalarLane>.IsKnown(_batch, 0);
        _batch.ActiveSet?.BeginPace(dt);
    }

    // Of a pose that the last step did not leave so: closes it, and finds the speeds that it forbids.
    private void CloseStartPose(bool isMoved)
    {
        _isMoved = isMoved || (_batch.ActiveSet != null && _batch.ActiveSet.IsNewlyPassed());
        HasClosed = _isMoved && _closure.TryClose(_tolerance);
        _forbidden = _isMoved && !_batch.Shape.IsInconsistent ? InitialVelocityProjection.Find(_batch, out _forbiddenSpeed) : -1;
    }

    // Takes off the speeds that the joints forbid. Closing what stood open before the step does work on springs.
    private void ProjectStartSpeeds()
    {
        _hasSettled = true;
        _isAudited &= !(_isMoved && _closure.IsOpen());
        RattleStep<ScalarLane>.Rebuild(_batch);
        InitialVelocityProjection.Apply(_batch, _conjugateGradient);
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
        if (_isAudited)
        {
            _energy = new EnergyAudit(_batch, _dt, _tolerance);
        }
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
    private int TakeParts(int halvings, ref SubstepHistory cut)
    {
        int next = TakeParts(halvings);
        while (halvings < MaxKept && _isAudited && _dampedInStep == 0 && (_excess > MostShares || !CanTakeGain()))
        {
            ReturnToStart();
            halvings++;
            next = TakeParts(halvings);
        }

        cut.IsSingular |= _isSingular;
        return next;
    }

    private void ReturnToStart()
    {
        _gain = 0;
        _excess = 0;
        Return(_start, _dt);
        _hasMoved = false;
        _elapsed = 0;
    }

    private bool HasRunAway => !_hasLookedForHeld && _batch.ActiveSet is { HasRunAway: true };

    // What the island's next step takes from this one.
    private void End(ref SubstepHistory cut, int halvings, double demand)
    {
        cut.IsSingular = _isSingular && _isAudited && _end.Excess(_energy, false, MostEnergyChange) > 1;
        Enter(ref cut.Energy);
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
        HasClosed = false;
        _forbidden = -1;
        DampedSteps += verdict.Stops;
        _worst = verdict.Worst;
        _worstError = verdict.Error;
        _troubles = verdict.Troubles;
        Damp(0);
    }

    private int MaxKept => _batch.ActiveSet == null ? MaxHalvings : MaxKeptHalvings;

    private void Enter(ref EnergyLedger ledger)
    {
        if (!_isAudited)
        {
            return;
        }

        if (_end.IsClosed)
        {
            double takeable = LaneEnergy<ScalarLane>.Takeable(_batch, 0, _end.Kinetic, out CommonMotion common);
            LaneEnergy<ScalarLane>.Take(_batch, 0, ledger.Enter(_end.GainSince(_energy), _end.Moving, takeable, MayLose), takeable, common);
        }
    }

    // What slows a body down to its largest angular speed leaves speeds that the joints forbid, and these go.
    private bool MayLose => _isSingular || _batch.Work.Slowed[0] > 0 || LaneEnergy<ScalarLane>.IsLed(_batch, 0) || _energy.IsSprung || CompliantAngles<ScalarLane>.HaveActed(_batch, 0, _energy.Kinetic) || _batch.ActiveSet is { HasActed: true };

    // In parts as short as steps keep, a violent motion on which no scalar row acts may lose energy: nothing below these is better. Were it allowed to lose
    // at any, while a gain is mended, an energy that swings about its value would be let down step by step. What is left there of a gain the account takes
    // from the speeds.
    private double Excess(in EnergyAudit end, int halvings)
    {
        bool mayLose = MayLose || halvings >= MaxKept;
        return end.Excess(_energy, mayLose, mayLose ? MostEnergyGain : MostEnergyChange);
    }

    // Whether what the account takes of the step at its end is enough.
    private bool CanTakeGain() =>
        !_end.IsClosed || _ledger.CanTake(_end.GainSince(_energy), _end.Moving, LaneEnergy<ScalarLane>.Takeable(_batch, 0, _end.Kinetic, out _));

    // What a step that is too long gains or loses, shorter ones do not; what goes where branches of a loop's motion meet, goes whatever their length.
    private void FindGainOfAnyLength(double gain, int halvings)
    {
        if (_firstGain == 0)
        {
            _firstGain = gain;
            _firstGainHalvings = halvings;
        }

        _isOfAnyLength = halvings >= _firstGainHalvings + TellingHalvings && gain / _firstGain > KeptGain;
        _isSingular |= _isOfAnyLength && gain < 0 && _batch.Shape.HasJointLoops;
    }

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
                if (IsSpent())
                {
                    length.Lengthen(MaxKeptHalvings);
                    continue;
                }

                if (_resort == Resort.Projection && length.Halvings == PartLength.MaxHalvings)
                {
                    _resort = Resort.Halves;
                    ReturnToStart();
                    length = new PartLength(least, halvings);
                    continue;
                }

                if ((_resort != Resort.Projection && !_isOfAnyLength && length.Halvings < MaxRattleHalvings) || !TakeOtherwise(start, h, length.Halvings))
                {
                    length.Halve();
                    continue;
                }
            }

            _elapsed += h;
            _firstGain = 0;
            _isOfAnyLength = false;
            length.Take(_isSmooth);
        }

        // What does not arrive in one place is none of the next step's.
        return Math.Min(MaxKept, length.Fewest == least + 1 && !isOfEnergy ? least : length.Fewest);
    }

    // Whether the step has had its tries, and what is left of it is tried otherwise.
    private bool IsSpent()
    {
        bool isSpent = _part.Tries >= _mostTries && _resort < Resort.Projection;
        if (isSpent)
        {
            _resort = _resort == Resort.None && _batch.ActiveSet != null && _batch.ActiveSet.SlowDown() ? Resort.SlowerDrives : Resort.Projection;
            _mostTries = _part.Tries + MostTriesSlowed;
        }

        return isSpent;
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

    // By the method that needs no chord, or, the shortest, standing still.
    private bool TakeOtherwise(Snapshot start, double h, int halvings)
    {
        if (TryProjected(h, halvings))
        {
            return true;
        }

        if (halvings < PartLength.MaxHalvings)
        {
            Return(start, h);
            return false;
        }

        Stop(start, h);
        return true;
    }

    private bool TryPart(double h, int halvings, out bool hasArrived)
    {
        _part.SetLength(h);
        _part.HoldsPassedLimits = halvings >= MaxRattleHalvings;
        hasArrived = _part.TryRattle(h, _tolerance) && !HasRunAway;
        if (!hasArrived || !IsPartKept(h, halvings))
        {
            return false;
        }

        _hasMoved = true;
        return true;
    }

    // Local errors of a second order method are of the third: where parts keep to a share of what the step may have, whatever their length, so does their sum.
    private bool IsPartKept(double h, int halvings)
    {
        if (!_isAudited)
        {
            _isSmooth = true;
            return true;
        }

        var end = new EnergyAudit(_batch, _dt, _tolerance);
        double excess = Excess(end, halvings), gain = end.GainSince(_energy);
        if (!(excess <= _excess + Math.Max(PartShare, h / _dt)))
        {
            FindGainOfAnyLength(gain - _gain, halvings);
            return false;
        }

        _isSmooth = gain - _gain <= end.Allowed(_energy, MayLose, PartShare * (MayLose ? MostEnergyGain : MostEnergyChange));
        _excess = excess;
        _gain = gain;
        _end = end;
        return true;
    }

    // What a part that goes well has no need to ask: whether the loop is singular, which speeds the joints forbid at the step's start and which drives they
    // hold, and whether rows keep to their bounds in each iteration. Whether the part is worth another try after it.
    private bool IsChanged(Snapshot start, double h, bool hasArrived, ref PartLength length)
    {
        if (_isSingular != _wasSingular)
        {
            _wasSingular = true;
            length.Lengthen(_firstGainHalvings);
            return true;
        }

        if (length.IsFirst && RestOn())
        {
            start.Save(_batch);
            return true;
        }

        bool isChanged = LooksForHeld(start, h);
        if (length.IsFirst && !_hasSettled)
        {
            ProjectStartSpeeds();
            SaveStart();
            isChanged = true;
        }

        if (!hasArrived && !_part.IsEager && _batch.ActiveSet != null)
        {
            _part.IsEager = true;
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
        _end = new EnergyAudit(_batch, _dt, _tolerance);
    }

    private bool TryProjected(double h, int halvings)
    {
        if (!_part.TryProjected(h, _tolerance, _isAudited ? _energy : null) || !IsPartKept(h, halvings))
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
