using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// One island's step by whatever it takes: RATTLE; where that does not converge, or energy shows that it is too coarse, the
/// step again in even parts, from its start; below the finest of these, halves of a part; at last implicit Euler. Steps are
/// also cut up front where bodies turn far or where tension makes them stiff. Even parts from the start, and kept for a
/// while, since RATTLE keeps energy over long times at a constant step and pays for a change amid a violent motion.
/// </summary>
internal sealed class Ladder
{
    /// <summary>Halvings into even parts, and, below these, of a part alone.</summary>
    public const int MaxHalvings = 10;
    private const int MaxDepth = 12;

    // Failures in a step after which parts that fail are left to implicit Euler.
    private const int MaxFailures = 48;

    // Stops in a step after which the rest of it is not tried: the scene cannot be followed, and says so.
    private const int MaxStops = 8;

    // Largest error of a quaternion's square.
    private const double MostStretch = 1e-3;

    // Largest change of the energy in a step against its kinetic part, where nothing but known forces does work.
    private const double MostEnergyChange = 0.002;

    // Largest growth of the energy in a step, springs included, where laws may take any amount.
    private const double MostEnergyGain = 0.005;

    private readonly Batch<ScalarLane> _batch;
    private readonly ImplicitEulerStep _floor;
    private readonly PoseClosure _closure;
    private readonly Snapshot _start;
    private readonly Snapshot[] _parts = new Snapshot[MaxDepth - MaxHalvings + 1];
    private readonly bool[] _converged = new bool[1];
    private double _part;
    private int _failures;
    private int _stops;
    private int _worst;
    private double _worstError;
    private bool _isEager;
    private bool _isAudited;
    private Energy _energy;
    private double _dt;

    public Ladder(Batch<ScalarLane> batch)
    {
        _batch = batch;
        _floor = new ImplicitEulerStep(batch);
        _closure = new PoseClosure(batch);
        _start = new Snapshot(batch);
        for (int i = 0; i < _parts.Length; i++)
        {
            _parts[i] = new Snapshot(batch);
        }
    }

    /// <summary>Substeps in which the island stood still: not even implicit Euler could take them, or too many before them.</summary>
    public int Stops { get; private set; }

    /// <summary>What was farthest from closed in the last step that had a stop.</summary>
    /// <param name="island">The island that was stepped; the batch may be of another of its shape.</param>
    public UnsolvedStep Unsolved(Island island)
    {
        return _worst < 0
            ? new UnsolvedStep { Body = island.Bodies[0] }
            : new UnsolvedStep { Body = island.Bodies[0], Joint = JointOf(island, _worst), Error = _worstError, IsAngular = island.IsAngular[_worst] };
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
    public void Step(double dt, double tolerance, ref StepCut cut, bool hasFailed, bool isMoved)
    {
        Array.Clear(_batch.Work.Total, 0, _batch.Work.Total.Length);
        _batch.Laws?.ClearWork();
        _part = dt;
        _failures = 0;
        _stops = 0;
        _isEager = false;
        _isAudited = Energy.IsKnown(_batch);
        HasClosed = isMoved && _closure.TryClose(tolerance);
        bool hasSettled = hasFailed || HasClosed;
        if (hasSettled)
        {
            Settle();
        }

        double demand = StepDemand.Of(_batch, dt);
        int halvings = Math.Max(cut.Halvings, hasFailed ? 1 : 0);
        while (halvings < MaxHalvings && demand > 1 << halvings)
        {
            halvings++;
        }

        _start.Save(_batch);
        Audit(dt);
        _dt = dt;
        while (!TryParts(dt, halvings, tolerance) || !IsEnergyKept(halvings))
        {
            _start.Restore(_batch);
            _part = dt;
            if (!hasSettled)
            {
                hasSettled = true;
                _isEager = true;
                Settle();
                _start.Save(_batch);
                Audit(dt);
            }

            if (halvings == MaxHalvings)
            {
                ForceParts(dt, tolerance);
                break;
            }

            halvings++;
        }

        cut.Note(halvings, demand);
        SetPart(dt);
    }

    // Closing what stands open does work on springs.
    private void Settle()
    {
        _isAudited &= !_closure.IsOpen();
        RattleStep<ScalarLane>.Rebuild(_batch);
        ForbiddenSpeeds.TakeOff(_batch);
    }

    private void Audit(double dt)
    {
        if (_isAudited)
        {
            _energy = new Energy(_batch, dt);
        }
    }

    private static JointModel? JointOf(Island island, int row)
    {
        int n = Array.FindLastIndex(island.Pattern.Rows, first => first <= row);
        return island.Nodes[n].Joint ?? island.Nodes[n].Coupling!.B.Joint;
    }

    // Of the first part that no method could take.
    private void Blame(double tolerance)
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

    // At the finest even parts a violent motion without laws may lose energy: nothing below these is better.
    private bool IsEnergyKept(int halvings)
    {
        bool mayLose = _batch.Laws != null || halvings >= MaxHalvings;
        return !_isAudited || new Energy(_batch, _dt).IsKept(_energy, mayLose, mayLose ? MostEnergyGain : MostEnergyChange);
    }

    private bool TryParts(double dt, int halvings, double tolerance)
    {
        double h = dt / (1 << halvings);
        SetPart(h);
        for (int i = 1 << halvings; i > 0; i--)
        {
            if (!TryRattle(h, tolerance))
            {
                return false;
            }
        }

        return true;
    }

    private void ForceParts(double dt, double tolerance)
    {
        for (int i = 1 << MaxHalvings; i > 0; i--)
        {
            Force(dt / (1 << MaxHalvings), MaxHalvings, tolerance);
        }
    }

    private void Force(double h, int depth, double tolerance)
    {
        if (_stops == MaxStops)
        {
            Stop();
            return;
        }

        Snapshot start = _parts[depth - MaxHalvings];
        SetPart(h);
        start.Save(_batch);
        if (TryRattle(h, tolerance) && IsEnergyKept(depth))
        {
            return;
        }

        start.Restore(_batch);
        if (depth < MaxDepth && _failures++ < MaxFailures)
        {
            Force(h / 2, depth + 1, tolerance);
            Force(h / 2, depth + 1, tolerance);
            SetPart(h);
            return;
        }

        if (TryFloor(h, tolerance) && IsEnergyKept(depth))
        {
            return;
        }

        if (_stops == 0)
        {
            Blame(tolerance);
        }

        start.Restore(_batch);
        _stops++;
        Stop();
    }

    private bool TryRattle(double h, double tolerance)
    {
        _batch.Work.Active[0] = 1;
        RattleStep<ScalarLane>.Fly(_batch, h, tolerance, _converged, _isEager);
        if (!_converged[0] || (_batch.Laws != null && _batch.Laws.HasPassedUnseen(tolerance)))
        {
            return false;
        }

        _batch.Laws?.AddWork();
        RattleStep<ScalarLane>.Build(_batch);
        _batch.Work.Active[0] = 1;
        VelocityProjection<ScalarLane>.Run(_batch, h, tolerance);
        Finish();
        Stiffness<ScalarLane>.Measure(_batch, _batch.Half, h / 2);
        return IsFinite();
    }

    private bool TryFloor(double h, double tolerance)
    {
        if (!_floor.Fly(h, tolerance))
        {
            return false;
        }

        _batch.Laws?.AddWork();
        RattleStep<ScalarLane>.Build(_batch);
        Stiffness<ScalarLane>.Measure(_batch, _batch.Work.First, h);
        _batch.Work.Active[0] = 1;
        VelocityProjection<ScalarLane>.Run(_batch, 0, tolerance);
        Finish();

        // What implicit Euler leaves behind is no guess for RATTLE.
        Array.Clear(_batch.Half, 0, _batch.Half.Length);
        return IsFinite();
    }

    private void Finish()
    {
        RattleStep<ScalarLane>.Accept(_batch);
        for (int i = 0; i < _batch.Work.Total.Length; i++)
        {
            _batch.Work.Total[i] += _batch.Work.First[i] + _batch.Half[i];
        }
    }

    // Impulses are proportional to the part's length; the guess is scaled to it.
    private void SetPart(double h)
    {
        if (_part > 0 && _part != h)
        {
            double factor = h / _part;
            for (int i = 0; i < _batch.Half.Length; i++)
            {
                _batch.Half[i] *= factor;
            }

            _batch.Laws?.ScaleHistory(factor);
        }

        _part = h;
    }

    private bool IsFinite()
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = Batch<ScalarLane>.Body(body, 0);
            for (int i = 0; i < BodySlot.EndX; i++)
            {
                if (!(Math.Abs(_batch.Bodies[o + i]) < 1e100))
                {
                    return false;
                }
            }

            // A turn too wide for the series leaves a quaternion that is none.
            double norm = 0;
            for (int i = BodySlot.Q; i < BodySlot.EndX; i++)
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
    private void Stop()
    {
        const double share = 0.9;
        Stops++;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = Batch<ScalarLane>.Body(body, BodySlot.V);
            for (int i = 0; i < 6; i++)
            {
                double kept = share * _batch.Bodies[o + i];
                _batch.Bodies[o + i] = Math.Abs(kept) < 1e100 ? kept : 0;
            }
        }

        Array.Clear(_batch.Half, 0, _batch.Half.Length);
        _batch.Laws?.ClearHistory();
    }
}
