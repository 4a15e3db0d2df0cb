using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// One island's step by whatever it takes: RATTLE; RATTLE in halves while it does not converge; implicit Euler below
/// that. Also cuts the step up front where bodies turn far or where tension makes it stiff.
/// </summary>
internal sealed class Ladder
{
    /// <summary>Halvings before implicit Euler, and of the substeps chosen up front.</summary>
    private const int MaxHalvings = 3;

    // Geometric stiffness against inertia, times h^2, above which RATTLE (a leapfrog: stable below 4) is given halves.
    private const double MostStiffness = 3.5;

    // Largest turn of a body in a substep, radians.
    private const double MostTurn = 0.5;

    private readonly Batch<ScalarLane> _batch;
    private readonly ImplicitEulerStep _floor;
    private readonly Snapshot[] _snapshots = new Snapshot[MaxHalvings + 1];
    private readonly bool[] _converged = new bool[1];
    private double _lastStep;

    public Ladder(Batch<ScalarLane> batch)
    {
        _batch = batch;
        _floor = new ImplicitEulerStep(batch);
        for (int i = 0; i < _snapshots.Length; i++)
        {
            _snapshots[i] = new Snapshot(batch);
        }
    }

    /// <summary>Steps that not even implicit Euler could take: the island stood still for a substep.</summary>
    public int Stops { get; private set; }

    /// <summary>Substeps by implicit Euler.</summary>
    public int Falls { get; private set; }

    /// <summary>Up to 1 a plain RATTLE step of dt will do; above, it takes as many shorter ones.</summary>
    /// <param name="stiffness">Largest <see cref="BodySlot.Stiffness"/>.</param>
    /// <param name="speed">Largest angular speed, rad/s.</param>
    /// <param name="dt">Step, s.</param>
    public static double Demand(double stiffness, double speed, double dt) =>
        Math.Max(dt * Math.Sqrt(stiffness / MostStiffness), dt * speed / MostTurn);

    /// <summary>A whole step of dt from the loaded state; the batch is built at the start pose.</summary>
    public void Step(double dt, double tolerance)
    {
        int halvings = 0;
        double demand = Demand(Stiffest(), Fastest(), dt);
        while (halvings < MaxHalvings && demand > 1)
        {
            demand /= 2;
            halvings++;
        }

        int substeps = 1 << halvings;
        _lastStep = dt;
        Array.Clear(_batch.Total, 0, _batch.Total.Length);
        for (int i = 0; i < substeps; i++)
        {
            Advance(dt / substeps, halvings, tolerance);
        }

        SetStep(dt);
    }

    private void Advance(double h, int depth, double tolerance)
    {
        Snapshot start = _snapshots[depth];
        start.Save(_batch);
        SetStep(h);
        if (TryRattle(h, tolerance))
        {
            return;
        }

        start.Restore(_batch);
        if (depth < MaxHalvings)
        {
            Advance(h / 2, depth + 1, tolerance);
            Advance(h / 2, depth + 1, tolerance);
            return;
        }

        SetStep(h);
        if (TryFloor(h, tolerance))
        {
            Falls++;
            return;
        }

        start.Restore(_batch);
        Stop();
    }

    private bool TryRattle(double h, double tolerance)
    {
        _batch.Active[0] = 1;
        RattleStep<ScalarLane>.Fly(_batch, h, tolerance, _converged);
        if (!_converged[0])
        {
            return false;
        }

        RattleStep<ScalarLane>.Build(_batch);
        _batch.Active[0] = 1;
        RattleStep<ScalarLane>.Project(_batch, h, tolerance);
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

        RattleStep<ScalarLane>.Build(_batch);
        Stiffness<ScalarLane>.Measure(_batch, _batch.First, h);
        _batch.Active[0] = 1;
        RattleStep<ScalarLane>.Project(_batch, 0, tolerance);
        Finish();

        // What implicit Euler leaves behind is no guess for RATTLE.
        Array.Clear(_batch.Half, 0, _batch.Half.Length);
        return IsFinite();
    }

    private void Finish()
    {
        RattleStep<ScalarLane>.Accept(_batch);
        for (int i = 0; i < _batch.Total.Length; i++)
        {
            _batch.Total[i] += _batch.First[i] + _batch.Half[i];
        }
    }

    // Impulses are proportional to the step; the guess is scaled to it.
    private void SetStep(double h)
    {
        if (_lastStep > 0 && _lastStep != h)
        {
            double factor = h / _lastStep;
            for (int i = 0; i < _batch.Half.Length; i++)
            {
                _batch.Half[i] *= factor;
            }

            _batch.Laws?.ScaleHistory(factor);
        }

        _lastStep = h;
    }

    private double Stiffest()
    {
        double most = 0;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            most = Math.Max(most, _batch.Bodies[Batch<ScalarLane>.Body(body, BodySlot.Stiffness)]);
        }

        return most;
    }

    private double Fastest()
    {
        double most = 0;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            most = Math.Max(most, Impulses<ScalarLane>.AngularVelocity(_batch, body).LengthSquared);
        }

        return Math.Sqrt(most);
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

    /// <summary>All that an attempt at a step changes.</summary>
    private sealed class Snapshot
    {
        private readonly double[] _bodies;
        private readonly double[] _half;
        private readonly double[] _total;
        private readonly Law[] _laws;

        public Snapshot(Batch<ScalarLane> batch)
        {
            _bodies = new double[batch.Bodies.Length];
            _half = new double[batch.Half.Length];
            _total = new double[batch.Half.Length];
            _laws = new Law[batch.Shape.Laws];
        }

        public void Save(Batch<ScalarLane> batch)
        {
            Array.Copy(batch.Bodies, _bodies, _bodies.Length);
            Array.Copy(batch.Half, _half, _half.Length);
            Array.Copy(batch.Total, _total, _total.Length);
            batch.Laws?.Save(_laws);
        }

        public void Restore(Batch<ScalarLane> batch)
        {
            Array.Copy(_bodies, batch.Bodies, _bodies.Length);
            Array.Copy(_half, batch.Half, _half.Length);
            Array.Copy(_total, batch.Total, _total.Length);
            RattleStep<ScalarLane>.Build(batch);
            batch.Laws?.Restore(_laws);
        }
    }
}
