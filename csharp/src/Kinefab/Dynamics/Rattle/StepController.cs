using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// One island's step by whatever it takes: RATTLE; where that does not converge, or energy shows that it is too coarse, the
/// step again in even parts, from its start; below the finest of these, halves of a part; at last implicit Euler. Steps are
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

    // Failures in a step after which parts that fail are left to implicit Euler.
    private const int MaxFailures = 48;

    // And after which a step that was halved where it failed is cut into even parts all the same.
    private const int MaxTrialFailures = 24;

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

    // What a part that stands still leaves of the speeds.
    private const double KeptSpeed = 0.9;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly ConjugateGradient _exact;
    private readonly Substep _part;
    private readonly PositionProjection _closure;
    private readonly Snapshot _start;
    private readonly Snapshot?[] _substepStarts = new Snapshot?[LastDepth + 1];
    private int _failures;
    private int _dampedInStep;
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
    private double _dt;
    private double _elapsed;
    private double _tolerance;

    public StepController(LaneBatch<ScalarLane> batch)
    {
        _batch = batch;
        _exact = new ConjugateGradient(batch);
        _part = new Substep(batch, _exact);
        _closure = new PositionProjection(batch, _exact);
        _start = new Snapshot(batch);
    }

    /// <summary>Substeps in which the island stood still: not even implicit Euler could take them, or too many before them.</summary>
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

        Array.Clear(_batch.Work.TotalImpulses, 0, _batch.Work.TotalImpulses.Length);
        _batch.ActiveSet?.ClearWork();
        _batch.Work.CompliantWork[0] = 0;
        _batch.Work.DrivenWork = 0;
        _part.Begin(dt);
        _part.Tries = 0;
        _tolerance = tolerance;
        _failures = 0;
        _elapsed = 0;
        _dampedInStep = 0;
        _hasMoved = false;
        _part.IsEager = hasFailed && _batch.ActiveSet != null;
        _isAudited = LaneEnergy<ScalarLane>.IsKnown(_batch, 0);
        _batch.ActiveSet?.BeginPace(dt);
        isMoved |= _batch.ActiveSet != null && _batch.ActiveSet.IsNewlyPassed();
        _part.HoldsPassedLimits = false;
        HasClosed = isMoved && _closure.TryClose(tolerance);
        _forbidden = isMoved && !_batch.Shape.IsInconsistent ? InitialVelocityProjection.Find(_batch, out _forbiddenSpeed) : -1;
        bool hasSettled = hasFailed || HasClosed || HasForbiddenSpeed;
        if (hasSettled)
        {
            CloseInitialState(isMoved);
        }

        int stops = DampedSteps;
        double demand = StepLimit.Of(_batch, dt);
        int halvings = Math.Max(cut.Halvings, hasFailed && !_part.IsEager ? 1 : 0);
        if (demand > 1 << halvings && _batch.ActiveSet != null && _batch.ActiveSet.RestOn())
        {
            demand = StepLimit.Of(_batch, dt);
        }

        _isSingular = cut.IsSingular;
        _firstLoss = 0;
        while (halvings < MaxHalvings && demand > 1 << halvings)
        {
            halvings++;
        }

        _start.Save(_batch);
        Audit(dt);
        _dt = dt;
        bool hasHalvedThere = false;
        bool hasLooked = _batch.ActiveSet != null && _batch.ActiveSet.HasHeld();
        if (hasLooked)
        {
            FindHeldDrives(dt);
        }

        if (_batch.ActiveSet != null && _batch.ActiveSet.NextResting(0) >= 0)
        {
            HeldDrives.Wake(_batch, _batch.ActiveSet, _exact);
            Return(_start, dt);
        }

        while (true)
        {
            bool isDone = TryEvenParts(dt, halvings, tolerance);
            if (isDone && (hasLooked || _batch.ActiveSet is not { HasRunAway: true }))
            {
                break;
            }

            Return(_start, dt);
            _hasMoved = false;
            if (isDone)
            {
                hasLooked = true;
                FindHeldDrives(dt);
                continue;
            }

            bool wasEager = _part.IsEager;
            _part.IsEager = true;
            if (_batch.ActiveSet != null && _batch.ActiveSet.RestOn())
            {
                _start.Save(_batch);
                continue;
            }

            if (!hasLooked && _batch.ActiveSet != null && _batch.ActiveSet.HasEndless())
            {
                hasLooked = true;
                FindHeldDrives(dt);
            }

            if (!hasSettled)
            {
                hasSettled = true;
                CloseInitialState(isMoved);
                _start.Save(_batch);
                Audit(dt);
            }

            if (wasEager && !hasHalvedThere && IsInOnePlace())
            {
                hasHalvedThere = true;
                if (TryHalving(dt, halvings, tolerance))
                {
                    break;
                }

                Return(_start, dt);
            }

            if (halvings >= MostEven)
            {
                SubstepUntilSolved(dt, halvings, tolerance);
                break;
            }

            if (_isSingular != cut.IsSingular)
            {
                cut.IsSingular = true;
                halvings = _firstLossHalvings;
            }
            else if (wasEager)
            {
                halvings++;
            }
        }

        cut.IsSingular = _isSingular && !new EnergyAudit(_batch, dt, tolerance).IsKept(_energy, false, MostEnergyChange);
        Enter(ref cut.Energy);
        bool comesToRest = false;
        cut.IsSlowedDown = _batch.ActiveSet != null && _batch.ActiveSet.EndPace(dt, tolerance / dt, out comesToRest);
        if (!comesToRest)
        {
            cut.Record(halvings, demand);
        }

        _part.SetLength(dt);
        if (_dampedInStep == 0 || _hasMoved)
        {
            still.Forget();
            return;
        }

        Damp(0);
        still.Remember(new StepVerdict { Stops = DampedSteps - stops, Worst = _worst, Error = _worstError, Troubles = _troubles });
    }

    private void FindHeldDrives(double dt)
    {
        HeldDrives.Find(_batch, _batch.ActiveSet!, _exact);
        Return(_start, dt);
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

    // Closing what stood open before the step does work on springs.
    private void CloseInitialState(bool isMoved)
    {
        _isAudited &= !(isMoved && _closure.IsOpen());
        RattleStep<ScalarLane>.Rebuild(_batch);
        InitialVelocityProjection.Apply(_batch, _exact);
    }

    private int MostEven => _batch.ActiveSet == null ? MaxHalvings : MaxEvenHalvings;

    private void Audit(double dt)
    {
        if (_isAudited)
        {
            _energy = new EnergyAudit(_batch, dt, _tolerance);
        }
    }

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

    private bool MayLose => _isSingular || _batch.Shape.HasKinematic || _energy.IsSprung || CompliantAngles<ScalarLane>.HaveActed(_batch, 0, _energy.Kinetic) || _batch.ActiveSet is { HasActed: true };

    // At the finest even parts a violent motion on which no scalar row acts may lose energy: nothing below these is better. Were it allowed to lose
    // at any, while a gain is mended, an energy that swings about its value would be let down step by step. What is left there of a gain the account takes
    // from the speeds.
    private bool IsEnergyKept(int halvings, double h)
    {
        // A gain is a part's own to mend, not that of the part after it.
        double share = EarlyShare + (1 - EarlyShare) * (_elapsed + h) / _dt;
        bool mayLose = MayLose || halvings >= MostEven;
        return !_isAudited || new EnergyAudit(_batch, _dt, _tolerance).IsKept(_energy, mayLose, share * (mayLose ? MostEnergyGain : MostEnergyChange));
    }

    private bool TryEvenParts(double dt, int halvings, double tolerance)
    {
        _hasArrived = TrySubsteps(dt, halvings, tolerance);
        if (!_hasArrived)
        {
            return false;
        }

        if (IsEnergyKept(halvings, dt))
        {
            return true;
        }

        FindSingular(halvings);
        return false;
    }

    // What a step that is too long loses, shorter ones do not lose; what goes where branches of a loop's motion meet, goes whatever their length.
    private void FindSingular(int halvings)
    {
        double loss = -new EnergyAudit(_batch, _dt, _tolerance).GainSince(_energy);
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

    private bool TrySubsteps(double dt, int halvings, double tolerance)
    {
        double h = dt / (1 << halvings);
        _part.SetLength(h);
        for (int i = 1 << halvings; i > 0; i--)
        {
            if (!_part.TryRattle(h, tolerance))
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
    private bool TryHalving(double dt, int halvings, double tolerance)
    {
        _isTrial = true;
        SubstepUntilSolved(dt, halvings, tolerance);
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

    private void SubstepUntilSolved(double dt, int halvings, double tolerance)
    {
        for (int i = 1 << halvings; i > 0; i--)
        {
            Halve(dt / (1 << halvings), halvings, tolerance);
        }
    }

    private void Halve(double h, int depth, double tolerance)
    {
        _hasGivenUp = _isTrial && (_hasGivenUp || _failures > MaxTrialFailures);
        if (_hasGivenUp)
        {
            return;
        }

        Snapshot start = _substepStarts[depth] ??= new Snapshot(_batch);
        _part.SetLength(h);
        start.Save(_batch);
        bool isHopeless = _dampedInStep == MaxDampedSteps;
        _part.HoldsPassedLimits = depth >= MaxDepth;
        if (!isHopeless && _part.TryRattle(h, tolerance) && IsEnergyKept(depth, h))
        {
            _hasMoved = true;
            _elapsed += h;
            return;
        }

        if (!isHopeless && depth < MaxDepth && _failures++ < MaxFailures)
        {
            HalveAgain(start, h, depth, tolerance);
            return;
        }

        if (isHopeless || !TryFallback(start, h, depth, tolerance))
        {
            if (_isTrial)
            {
                _hasGivenUp = true;
                return;
            }

            if (!isHopeless && depth < LastDepth)
            {
                HalveAgain(start, h, depth, tolerance);
                return;
            }

            if (_dampedInStep == 0)
            {
                MeasureWorstResidual(tolerance);
                start.Restore(_batch);
                FindTroubles(tolerance);
            }

            Return(start, h);
            _dampedInStep += isHopeless ? 0 : 1;
            DampedSteps++;
            Damp(KeptSpeed);
        }
        else
        {
            _hasMoved = true;
        }

        _elapsed += h;
    }

    private void HalveAgain(Snapshot start, double h, int depth, double tolerance)
    {
        Return(start, h);
        Halve(h / 2, depth + 1, tolerance);
        Halve(h / 2, depth + 1, tolerance);
        _part.SetLength(h);
    }

    private bool TryFallback(Snapshot start, double h, int depth, double tolerance)
    {
        Return(start, h);
        if (_part.TryImplicitEuler(h, tolerance) && IsEnergyKept(depth, h))
        {
            return true;
        }

        Return(start, h);
        return _part.TryProjected(h, tolerance, _isAudited ? _energy : null) && IsEnergyKept(depth, h);
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
