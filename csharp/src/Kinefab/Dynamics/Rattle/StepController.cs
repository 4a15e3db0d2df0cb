using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// One island's step by whatever it takes: RATTLE; where that does not converge, or energy shows that it is too coarse, the
/// step again in even parts, from its start; below the finest of these, halves of a part, and at last a projected step. Steps are
/// also cut up front where bodies turn far or where tension makes them stiff. Even parts from the start, and kept for a
/// while, since RATTLE keeps energy over long times at a constant step and pays for a change amid a violent motion.
/// </summary>
internal sealed partial class StepController
{
    /// <summary>Halvings into even parts, and, below these, of a part alone.</summary>
    public const int MaxHalvings = 10;
    private const int MaxDepth = 12;

    // Halvings of a part that no method takes: a scene that 64 times shorter steps can follow is not stopped.
    private const int LastDepth = 18;

    // Halvings into even parts where limits and drives act: blows end the long account of energy for which the parts are even.
    private const int MaxEvenHalvings = 6;

    // Failures in a step after which one that was halved where it failed is cut into even parts all the same, and, below the finest of these, parts that
    // fail are left to the method that needs no chord.
    private const int MaxFailures = 48;

    // Stops in a step after which the rest of it is not tried: the scene cannot be followed, and says so.
    private const int MaxDampedSteps = 8;

    // Largest change of the energy in a step against its kinetic part, where nothing but known forces does work.
    private const double MostEnergyChange = 0.002;

    // Largest growth of the energy in a step, springs included, where scalar rows may take any amount.
    private const double MostEnergyGain = 5e-4;

    // Of what energy may grow by in a step, the share that is a part's from the start on; the rest comes with the time.
    private const double EarlyShare = 0.25;

    // Halvings after which a loss that is still more than a share of what it was at first is none of the step's.
    private const int TellingHalvings = 3;
    private const double KeptLoss = 0.5;

    // Of parts that were taken as one, failures after which none are.
    private const int MaxFailedJoints = 3;

    // What a part that stands still leaves of the speeds.
    private const double KeptSpeed = 0.9;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly ConjugateGradient _conjugateGradient;
    private readonly Substep _part;
    private readonly PositionProjection _closure;
    private readonly Snapshot _start;
    private readonly Snapshot?[] _substepStarts = new Snapshot?[LastDepth + 1];
    private int _failures;
    private int _dampedInStep;
    private bool _isMoved;
    private bool _hasSettled;
    private bool _hasLookedForHeld;
    private bool _isTrial;
    private bool _hasGivenUp;
    private bool _hasArrived;
    private bool _hasMoved;
    private int _worst;
    private double _worstError;
    private int _forbidden = -1;
    private double _forbiddenSpeed;
    private StepTroubles _troubles;
    private bool _isAudited;
    private bool _isSingular;
    private int _firstLossHalvings;
    private double _firstLoss;
    private EnergyAudit _energy;
    private EnergyLedger _ledger;
    private int _leastHalvings;
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
        _leastHalvings = halvings;
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
        _failures = 0;
        _elapsed = 0;
        _dampedInStep = 0;
        _hasMoved = false;
        _hasSettled = false;
        _hasLookedForHeld = false;
        _isSingular = isSingular;
        _firstLoss = 0;
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
            FindHeldDrives();
        }

        if (_batch.ActiveSet != null && _batch.ActiveSet.NextResting(0) >= 0)
        {
            HeldDrives.Wake(_batch, _batch.ActiveSet, _conjugateGradient);
            Return(_start, _dt);
        }
    }

    private void FindHeldDrives()
    {
        _hasLookedForHeld = true;
        HeldDrives.Find(_batch, _batch.ActiveSet!, _conjugateGradient);
        Return(_start, _dt);
    }

    // The step in even parts, as few as will do; where more are of no use, in whatever parts a method takes. The halvings that it took.
    private int TakeParts(int halvings, ref SubstepHistory cut)
    {
        bool hasHalvedThere = false;
        while (true)
        {
            bool isTaken = TryEvenParts(halvings);
            if (HasRunAway)
            {
                // Before the step counts, what holds the drive that ran away is looked for.
                Return(_start, _dt);
                _hasMoved = false;
                FindHeldDrives();
                continue;
            }

            if (isTaken)
            {
                break;
            }

            bool wasEager = _part.IsEager;
            ReturnToStart();
            if (RestOn())
            {
                _start.Save(_batch);
                continue;
            }

            LookAgainAtStart();
            if (wasEager && !hasHalvedThere && IsInOnePlace())
            {
                hasHalvedThere = true;
                if (TryHalving(halvings))
                {
                    break;
                }

                Return(_start, _dt);
            }

            if (halvings >= MostEven)
            {
                halvings = SubstepUntilSolved(halvings);
                break;
            }

            halvings = NextHalvings(halvings, wasEager, ref cut);
        }

        return halvings;
    }

    private bool HasRunAway => !_hasLookedForHeld && _batch.ActiveSet is { HasRunAway: true };

    // What failed is tried again with rows that keep to their bounds in each iteration.
    private void ReturnToStart()
    {
        Return(_start, _dt);
        _hasMoved = false;
        _part.IsEager = true;
    }

    // What a step that goes well has no need to ask: which drives the joints hold, and which speeds they forbid.
    private void LookAgainAtStart()
    {
        if (!_hasLookedForHeld && _batch.ActiveSet != null && _batch.ActiveSet.HasEndless())
        {
            FindHeldDrives();
        }

        if (!_hasSettled)
        {
            ProjectStartSpeeds();
            SaveStart();
        }
    }

    // Where it has come out that what is lost is none of the step's length, as few as it was first lost at.
    private int NextHalvings(int halvings, bool wasEager, ref SubstepHistory cut)
    {
        if (_isSingular == cut.IsSingular)
        {
            return wasEager ? halvings + 1 : halvings;
        }

        cut.IsSingular = true;
        return _firstLossHalvings;
    }

    // What the island's next step takes from this one.
    private void End(ref SubstepHistory cut, int halvings, double demand)
    {
        cut.IsSingular = _isSingular && !new EnergyAudit(_batch, _dt, _tolerance).IsKept(_energy, false, MostEnergyChange);
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

    private int MostEven => _batch.ActiveSet == null ? MaxHalvings : MaxEvenHalvings;

    private void Enter(ref EnergyLedger ledger)
    {
        if (!_isAudited)
        {
            return;
        }

        var end = new EnergyAudit(_batch, _dt, _tolerance);
        if (end.IsClosed)
        {
            double takeable = LaneEnergy<ScalarLane>.Takeable(_batch, 0, end.Kinetic, out CommonMotion common);
            LaneEnergy<ScalarLane>.Take(_batch, 0, ledger.Enter(end.GainSince(_energy), end.Moving, takeable, MayLose), takeable, common);
        }
    }

    // What slows a body down to its largest angular speed leaves speeds that the joints forbid, and these go.
    private bool MayLose => _isSingular || _batch.Work.Slowed[0] > 0 || LaneEnergy<ScalarLane>.IsLed(_batch, 0) || _energy.IsSprung || CompliantAngles<ScalarLane>.HaveActed(_batch, 0, _energy.Kinetic) || _batch.ActiveSet is { HasActed: true };

    // At the finest even parts a violent motion on which no scalar row acts may lose energy: nothing below these is better. Were it allowed to lose
    // at any, while a gain is mended, an energy that swings about its value would be let down step by step. What is left there of a gain the account takes
    // from the speeds.
    private bool IsEnergyKept(int halvings, double h) => !_isAudited || IsEnergyKept(new EnergyAudit(_batch, _dt, _tolerance), halvings, h);

    private bool IsEnergyKept(in EnergyAudit end, int halvings, double h)
    {
        // A gain is a part's own to mend, not that of the part after it.
        double share = EarlyShare + (1 - EarlyShare) * (_elapsed + h) / _dt;
        bool mayLose = MayLose || halvings >= MostEven;
        return end.IsKept(_energy, mayLose, share * (mayLose ? MostEnergyGain : MostEnergyChange));
    }

    private bool TryEvenParts(int halvings)
    {
        _hasArrived = TrySubsteps(halvings);
        if (!_hasArrived)
        {
            return false;
        }

        if (!_isAudited)
        {
            return true;
        }

        var end = new EnergyAudit(_batch, _dt, _tolerance);
        if (IsEnergyKept(end, halvings, _dt) && (halvings >= MostEven || CanTakeGain(end)))
        {
            return true;
        }

        FindSingular(end, halvings);
        return false;
    }

    // Whether what the account takes of the step at its end is enough.
    private bool CanTakeGain(in EnergyAudit end) =>
        !end.IsClosed || _ledger.CanTake(end.GainSince(_energy), end.Moving, LaneEnergy<ScalarLane>.Takeable(_batch, 0, end.Kinetic, out _));

    // What a step that is too long loses, shorter ones do not lose; what goes where branches of a loop's motion meet, goes whatever their length.
    private void FindSingular(in EnergyAudit end, int halvings)
    {
        double loss = -end.GainSince(_energy);
        if (_isSingular || !(loss > 0) || !_batch.Shape.HasJointLoops)
        {
            return;
        }

        if (_firstLoss == 0)
        {
            _firstLoss = loss;
            _firstLossHalvings = halvings;
        }

        _isSingular = halvings >= _firstLossHalvings + TellingHalvings && loss > KeptLoss * _firstLoss;
    }

    private bool TrySubsteps(int halvings)
    {
        double h = _dt / (1 << halvings);
        _part.SetLength(h);
        for (int i = 1 << halvings; i > 0; i--)
        {
            if (!_part.TryRattle(h, _tolerance) || HasRunAway)
            {
                return false;
            }

            _hasMoved = true;
        }

        return true;
    }

    // Where limits and drives act, what does not arrive is mostly in one place. Energy is a matter of the whole step's length, and a drive without limit of
    // force that does not get on is in the way all along.
    private bool IsInOnePlace() => _part.HasFailedAtEvent || (!_hasArrived && _batch.ActiveSet != null && !_batch.ActiveSet.HasSlowedDown());

    // The step is halved where it fails and nowhere else; false where that takes more than a few parts.
    private bool TryHalving(int halvings)
    {
        _isTrial = true;
        SubstepUntilSolved(halvings);
        _isTrial = false;
        if (!_hasGivenUp)
        {
            return true;
        }

        _hasGivenUp = false;
        _hasMoved = false;
        _failures = 0;
        _elapsed = 0;
        return false;
    }

    // Parts of so many halvings, the next two as one after each that was taken: what is hard in one place is not so after it. The halvings at the end.
    private int SubstepUntilSolved(int finest)
    {
        int failedJoints = 0;
        int halvings = finest;
        for (int done = 0; done < 1 << finest;)
        {
            int depth = halvings;
            while (done % (1 << (finest - depth)) != 0)
            {
                depth++;
            }

            int failures = _failures;
            Halve(_dt / (1 << depth), depth);
            done += 1 << (finest - depth);
            if (failures != _failures)
            {
                failedJoints += depth < finest ? 1 : 0;
                halvings = Math.Min(finest, depth + 1);
            }
            else if (depth == halvings && halvings > _leastHalvings && failedJoints < MaxFailedJoints)
            {
                halvings--;
            }
        }

        return halvings;
    }

    private void Halve(double h, int depth)
    {
        _hasGivenUp = _isTrial && (_hasGivenUp || _failures > MaxFailures);
        if (_hasGivenUp)
        {
            return;
        }

        Snapshot start = _substepStarts[depth] ??= new Snapshot(_batch);
        _part.SetLength(h);
        start.Save(_batch);
        bool isHopeless = _dampedInStep == MaxDampedSteps;
        _part.HoldsPassedLimits = depth >= MaxDepth;
        if (!isHopeless && _part.TryRattle(h, _tolerance) && IsEnergyKept(depth, h))
        {
            _hasMoved = true;
            _elapsed += h;
            return;
        }

        if (!isHopeless && depth < MaxDepth && _failures++ < MaxFailures)
        {
            HalveAgain(start, h, depth);
            return;
        }

        if (!isHopeless && TryFallback(start, h, depth))
        {
            _hasMoved = true;
        }
        else if (_isTrial)
        {
            _hasGivenUp = true;
            return;
        }
        else if (!isHopeless && depth < LastDepth)
        {
            HalveAgain(start, h, depth);
            return;
        }
        else
        {
            Stop(start, h, isHopeless);
        }

        _elapsed += h;
    }

    // A part that no method takes stands still, and of the first in the step it is noted why.
    private void Stop(Snapshot start, double h, bool isHopeless)
    {
        if (_dampedInStep == 0)
        {
            MeasureWorstResidual();
            start.Restore(_batch);
            FindTroubles();
        }

        Return(start, h);
        _dampedInStep += isHopeless ? 0 : 1;
        DampedSteps++;
        Damp(KeptSpeed);
    }

    private void HalveAgain(Snapshot start, double h, int depth)
    {
        Return(start, h);
        Halve(h / 2, depth + 1);
        Halve(h / 2, depth + 1);
        _part.SetLength(h);
    }

    private bool TryFallback(Snapshot start, double h, int depth)
    {
        Return(start, h);
        return _part.TryProjected(h, _tolerance, _isAudited ? _energy : null) && IsEnergyKept(depth, h);
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
