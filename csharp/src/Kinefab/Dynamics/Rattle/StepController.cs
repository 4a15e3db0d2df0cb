using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// One island's step by whatever it takes: RATTLE; where that does not converge, or energy shows that it is too coarse, the
/// step again in even parts, from its start; below the finest of these, halves of a part; at last implicit Euler. Steps are
/// also cut up front where bodies turn far or where tension makes them stiff. Even parts from the start, and kept for a
/// while, since RATTLE keeps energy over long times at a constant step and pays for a change amid a violent motion.
/// </summary>
internal sealed class StepController
{
    /// <summary>Halvings into even parts, and, below these, of a part alone.</summary>
    public const int MaxHalvings = 10;
    private const int MaxDepth = 12;

    // Failures in a step after which parts that fail are left to implicit Euler.
    private const int MaxFailures = 48;

    // Stops in a step after which the rest of it is not tried: the scene cannot be followed, and says so.
    private const int MaxDampedSteps = 8;

    // Largest error of a quaternion's square.
    private const double MostStretch = 1e-3;

    // Largest change of the energy in a step against its kinetic part, where nothing but known forces does work.
    private const double MostEnergyChange = 0.002;

    // Largest growth of the energy in a step, springs included, where scalar rows may take any amount.
    private const double MostEnergyGain = 0.005;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly ImplicitEulerStep _fallback;
    private readonly PositionProjection _closure;
    private readonly Snapshot _start;
    private readonly Snapshot[] _substepStarts = new Snapshot[MaxDepth - MaxHalvings + 1];
    private readonly bool[] _converged = new bool[1];
    private double _substep;
    private int _failures;
    private int _dampedInStep;
    private int _worst;
    private double _worstError;
    private bool _refinesAfterFailure;
    private bool _isAudited;
    private EnergyAudit _energy;
    private double _dt;
    private double _tolerance;

    public StepController(LaneBatch<ScalarLane> batch)
    {
        _batch = batch;
        _fallback = new ImplicitEulerStep(batch);
        _closure = new PositionProjection(batch);
        _start = new Snapshot(batch);
        for (int i = 0; i < _substepStarts.Length; i++)
        {
            _substepStarts[i] = new Snapshot(batch);
        }
    }

    /// <summary>Substeps in which the island stood still: not even implicit Euler could take them, or too many before them.</summary>
    public int DampedSteps { get; private set; }

    /// <summary>What was farthest from closed in the last step that had a stop.</summary>
    /// <param name="island">The island that was stepped; the batch may be of another of its shape.</param>
    public UnsolvedStep Unsolved(Island island)
    {
        return _worst < 0
            ? new UnsolvedStep { Body = island.Bodies[0] }
            : new UnsolvedStep { Body = island.Bodies[0], Joint = JointOf(island, _worst), Error = _worstError, IsAngular = island.IsAngular[_worst] };
    }

    /// <summary>The joints whose limits stand passed and cannot be closed are added to a list.</summary>
    /// <param name="island">The island that was stepped; the batch may be of another of its shape.</param>
    /// <param name="held">Takes them.</param>
    public void AddHeldLimits(Island island, List<HeldLimit> held)
    {
        for (int i = _batch.ActiveSet?.NextHeldOpen(0) ?? -1; i >= 0; i = _batch.ActiveSet!.NextHeldOpen(i + 1))
        {
            ref readonly ScalarRow row = ref _batch.ActiveSet!.Row(i);
            held.Add(new HeldLimit { Body = island.Bodies[0], Joint = island.Blocks[row.Block].Joint!, Error = -row.Allowed, IsAngular = row.Built.Has(RowFlags.Angular) });
        }
    }

    /// <summary>Whether the last step began by closing its start pose.</summary>
    public bool HasClosed { get; private set; }

    /// <summary>What was moved then.</summary>
    /// <param name="island">The island that was stepped; the batch may be of another of its shape.</param>
    public ClosedPose Closed(Island island) => new()
    {
        Body = island.Bodies[0],
        Joint = JointOf(island, _closure.Worst),
        Error = _closure.WorstError,
        IsAngular = island.IsAngular[_closure.Worst],
        Distance = _closure.Distance,
        Angle = _closure.Angle,
    };

    /// <summary>A whole step of dt from the loaded state; the batch is built at the start pose.</summary>
    /// <param name="dt">Step, s.</param>
    /// <param name="tolerance">Largest C, metres or radians.</param>
    /// <param name="cut">The island's cut; takes note of the step.</param>
    /// <param name="hasFailed">Whether the plain step was tried already.</param>
    /// <param name="isMoved">Whether the start pose is not the one that the last step left.</param>
    public void Advance(double dt, double tolerance, ref SubstepHistory cut, bool hasFailed, bool isMoved)
    {
        Array.Clear(_batch.Work.TotalImpulses, 0, _batch.Work.TotalImpulses.Length);
        _batch.ActiveSet?.ClearWork();
        _substep = dt;
        _tolerance = tolerance;
        _failures = 0;
        _dampedInStep = 0;
        _refinesAfterFailure = false;
        _isAudited = EnergyAudit.IsKnown(_batch);
        isMoved |= _batch.ActiveSet != null && _batch.ActiveSet.IsNewlyPassed();
        HasClosed = isMoved && _closure.TryClose(tolerance);
        bool hasSettled = hasFailed || HasClosed;
        if (hasSettled)
        {
            CloseInitialState(isMoved);
        }

        double demand = StepLimit.Of(_batch, dt);
        int halvings = Math.Max(cut.Halvings, hasFailed ? 1 : 0);
        while (halvings < MaxHalvings && demand > 1 << halvings)
        {
            halvings++;
        }

        _start.Save(_batch);
        Audit(dt);
        _dt = dt;
        while (!TrySubsteps(dt, halvings, tolerance) || !IsEnergyKept(halvings))
        {
            _start.Restore(_batch);
            _substep = dt;
            if (!hasSettled)
            {
                hasSettled = true;
                _refinesAfterFailure = true;
                CloseInitialState(isMoved);
                _start.Save(_batch);
                Audit(dt);
            }

            if (halvings == MaxHalvings)
            {
                SubstepUntilSolved(dt, tolerance);
                break;
            }

            halvings++;
        }

        cut.Record(halvings, demand);
        SetSubstep(dt);
    }

    // Closing what stood open before the step does work on springs.
    private void CloseInitialState(bool isMoved)
    {
        _isAudited &= !(isMoved && _closure.IsOpen());
        RattleStep<ScalarLane>.Rebuild(_batch);
        InitialVelocityProjection.Apply(_batch);
    }

    private void Audit(double dt)
    {
        if (_isAudited)
        {
            _energy = new EnergyAudit(_batch, dt, _tolerance);
        }
    }

    private static JointModel? JointOf(Island island, int row)
    {
        int n = Array.FindLastIndex(island.Pattern.Rows, first => first <= row);
        return island.Blocks[n].Joint ?? island.Blocks[n].Coupling!.Coordinates[^1].Joint;
    }

    // Of the first part that no method could take.
    private void MeasureWorstResidual(double tolerance)
    {
        _worst = -1;
        _worstError = tolerance;
        for (int i = 0; i < _batch.Work.Error.Length; i++)
        {
            double error = Math.Abs(_batch.Work.Error[i]);
            error = double.IsNaN(error) ? double.PositiveInfinity : error;
            if (error > _worstError)
            {
                _worst = i;
                _worstError = error;
            }
        }
    }

    // At the finest even parts a violent motion without scalar rows may lose energy: nothing below these is better.
    private bool IsEnergyKept(int halvings)
    {
        bool mayLose = _batch.ActiveSet != null || halvings >= MaxHalvings;
        return !_isAudited || new EnergyAudit(_batch, _dt, _tolerance).IsKept(_energy, mayLose, mayLose ? MostEnergyGain : MostEnergyChange);
    }

    private bool TrySubsteps(double dt, int halvings, double tolerance)
    {
        double h = dt / (1 << halvings);
        SetSubstep(h);
        for (int i = 1 << halvings; i > 0; i--)
        {
            if (!TryRattle(h, tolerance))
            {
                return false;
            }
        }

        return true;
    }

    private void SubstepUntilSolved(double dt, double tolerance)
    {
        for (int i = 1 << MaxHalvings; i > 0; i--)
        {
            Halve(dt / (1 << MaxHalvings), MaxHalvings, tolerance);
        }
    }

    private void Halve(double h, int depth, double tolerance)
    {
        if (_dampedInStep == MaxDampedSteps)
        {
            Damp();
            return;
        }

        Snapshot start = _substepStarts[depth - MaxHalvings];
        SetSubstep(h);
        start.Save(_batch);
        if (TryRattle(h, tolerance) && IsEnergyKept(depth))
        {
            return;
        }

        start.Restore(_batch);
        if (depth < MaxDepth && _failures++ < MaxFailures)
        {
            Halve(h / 2, depth + 1, tolerance);
            Halve(h / 2, depth + 1, tolerance);
            SetSubstep(h);
            return;
        }

        if (TryImplicitEuler(h, tolerance) && IsEnergyKept(depth))
        {
            return;
        }

        if (_dampedInStep == 0)
        {
            MeasureWorstResidual(tolerance);
        }

        start.Restore(_batch);
        _dampedInStep++;
        Damp();
    }

    private bool TryRattle(double h, double tolerance)
    {
        _batch.Work.Active[0] = 1;
        RattleStep<ScalarLane>.KickAndDrift(_batch, h, tolerance, _converged, _refinesAfterFailure);
        if (!_converged[0] || (_batch.ActiveSet != null && _batch.ActiveSet.HasMissedEvent(tolerance)))
        {
            return false;
        }

        _batch.ActiveSet?.AddWork();
        RattleStep<ScalarLane>.Build(_batch);
        _batch.Work.Active[0] = 1;
        VelocityProjection<ScalarLane>.Run(_batch, h, tolerance);
        Finish();
        GeometricStiffness<ScalarLane>.Estimate(_batch, _batch.VelocityImpulses, h / 2);
        return IsFinite();
    }

    private bool TryImplicitEuler(double h, double tolerance)
    {
        if (!_fallback.TrySolve(h, tolerance))
        {
            return false;
        }

        _batch.ActiveSet?.AddWork();
        RattleStep<ScalarLane>.Build(_batch);
        GeometricStiffness<ScalarLane>.Estimate(_batch, _batch.Work.PositionImpulses, h);
        _batch.Work.Active[0] = 1;
        VelocityProjection<ScalarLane>.Run(_batch, 0, tolerance);
        Finish();

        // What implicit Euler leaves behind is no guess for RATTLE.
        Array.Clear(_batch.VelocityImpulses, 0, _batch.VelocityImpulses.Length);
        return IsFinite();
    }

    private void Finish()
    {
        RattleStep<ScalarLane>.Accept(_batch);
        AssembledRows<ScalarLane>.FinishAngles(_batch);
        for (int i = 0; i < _batch.Work.TotalImpulses.Length; i++)
        {
            _batch.Work.TotalImpulses[i] += _batch.Work.PositionImpulses[i] + _batch.VelocityImpulses[i];
        }
    }

    // Impulses are proportional to the part's length; the guess is scaled to it.
    private void SetSubstep(double h)
    {
        if (_substep > 0 && _substep != h)
        {
            double factor = h / _substep;
            for (int i = 0; i < _batch.VelocityImpulses.Length; i++)
            {
                _batch.VelocityImpulses[i] *= factor;
            }

            _batch.Scalars?.ScaleHistory(factor);
        }

        _substep = h;
    }

    private bool IsFinite()
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            for (int i = 0; i < BodyLanes.EndX; i++)
            {
                if (!(Math.Abs(_batch.Bodies[o + i]) < 1e100))
                {
                    return false;
                }
            }

            // A turn too wide for the series leaves a quaternion that is none.
            double norm = 0;
            for (int i = BodyLanes.Q; i < BodyLanes.EndX; i++)
            {
                norm += _batch.Bodies[o + i] * _batch.Bodies[o + i];
            }

            if (!(Math.Abs(norm - 1) < MostStretch))
            {
                return false;
            }
        }

        return true;
    }

    // The poses stay for this substep and the motion slows down, so that a state that no method can leave comes to rest.
    private void Damp()
    {
        const double share = 0.9;
        DampedSteps++;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.V);
            for (int i = 0; i < 6; i++)
            {
                double kept = share * _batch.Bodies[o + i];
                _batch.Bodies[o + i] = Math.Abs(kept) < 1e100 ? kept : 0;
            }
        }

        Array.Clear(_batch.VelocityImpulses, 0, _batch.VelocityImpulses.Length);
        _batch.Scalars?.ClearHistory();
    }
}
