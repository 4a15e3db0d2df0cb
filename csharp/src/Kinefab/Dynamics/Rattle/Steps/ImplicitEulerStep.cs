using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The safe floor under RATTLE: M (v - v0) = h f + J(x')^T l, C(x') = 0 with x' the drift of v. Newton's method with
/// M + h K in place of M, K the geometric stiffness of the bodies under the impulses l, shifted to be positive
/// semi-definite; it keeps to the bodies' blocks, so that the matrix has its usual pattern. Unconditionally stable and
/// strongly dissipative. Starts from l = 0, since a warm l carries loads that no motion asks for.
/// K = sum over anchors of (F.r + |F||r|)/2 1 - sym(r F^T), F the impulse at the lever r.
/// </summary>
internal sealed class ImplicitEulerStep
{
    private const int MaxIterations = 20;

    // A matrix of a place this near to the end, m, serves further iterations, as long as each leaves at most this share of
    // what is off.
    private const double Near = 1e-2;
    private const double MostLeft = 0.05;

    // One share for all rows: with the larger one for angles the iteration stops converging.
    private const double Share = 1e-6;

    private readonly LaneBatch<ScalarLane> _batch;

    // Of each body velocity and angular momentum: wanted without joints, what they lack, what they are.
    private readonly double[] _aim;
    private readonly double[] _residual;
    private readonly double[] _momenta;

    // h K of each body: xx, yy, zz, xy, xz, yz.
    private readonly double[] _stiffness;

    public ImplicitEulerStep(LaneBatch<ScalarLane> batch)
    {
        _batch = batch;
        int bodies = batch.Shape.MovingBodies;
        _aim = new double[6 * bodies];
        _residual = new double[6 * bodies];
        _momenta = new double[6 * bodies];
        _stiffness = new double[6 * bodies];
    }

    /// <summary>From the start pose to a closed end pose; false when that was not reached.</summary>
    public bool TrySolve(double h, double tolerance)
    {
        LaneBatch<ScalarLane> batch = _batch;
        ActiveSet<ScalarLane>? scalars = batch.ActiveSet;
        batch.Work.Active[0] = 1;
        CompliantAngles<ScalarLane>.Begin(batch, h);
        scalars?.Begin(h, tolerance, true);
        RattleStep<ScalarLane>.Kick(batch, h);
        Read(_aim);
        Array.Clear(batch.Work.PositionImpulses, 0, batch.Work.PositionImpulses.Length);
        scalars?.ClearFree();
        FreeMotion<ScalarLane>.DriftKinematic(batch, h);
        int searches = 0;
        double last = 0;
        bool isNear = false;
        for (int iteration = 0; iteration < MaxIterations; iteration++)
        {
            LockedInertiaAxes<ScalarLane>.ClearMomentum(batch);
            FreeMotion<ScalarLane>.Drift(batch, h);
            BilateralRows<ScalarLane>.Evaluate(batch);
            CompliantAngles<ScalarLane>.Evaluate(batch);
            scalars?.Evaluate(h);
            BilateralRows<ScalarLane>.MeasureErrors(batch);
            BilateralRows<ScalarLane>.Build(batch);
            scalars?.WriteRows(true);
            double unbalanced = h * Residual();
            double off = Math.Max(batch.Work.MaxError[0], unbalanced);
            isNear &= off <= MostLeft * last;
            last = off;
            bool isClosed = ChordIteration<ScalarLane>.IsClosed(batch, 0, tolerance, iteration > 0);
            if (isClosed && unbalanced < tolerance)
            {
                if (scalars == null || !scalars.UpdatePositions(searches++, tolerance))
                {
                    return true;
                }

                isNear = false;
            }

            if (!(off < double.MaxValue))
            {
                return false;
            }

            if (isClosed && scalars != null)
            {
                // A row may have come to its bound just now.
                scalars.Evaluate(h);
                scalars.WriteRows(true);
                Residual();
            }

            if (isNear)
            {
                scalars?.WriteRows(false);
            }
            else
            {
                Factor(h);

                // The first one knows of no tension yet.
                isNear = iteration > 0 && off < Near;
            }

            Correct(h);
        }

        // With the anchors together, forces and angles that are a little off are better than no step.
        return batch.Work.MaxGap[0] < ChordIteration<ScalarLane>.MostGaps * tolerance;
    }

    // r = (v - aim) - M^-1 J^T l for the linear part, L - aim - J^T l for the angular one; the largest as a speed.
    private double Residual()
    {
        LaneBatch<ScalarLane> batch = _batch;
        Read(_momenta);
        Write(_aim, 1);
        Impulses<ScalarLane>.Apply(batch, batch.Work.PositionImpulses);
        LockedInertiaAxes<ScalarLane>.ClearMomentum(batch);
        double[] a = batch.Bodies;
        double most = 0;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.V);
            double inverse = a[LaneBatch<ScalarLane>.Body(body, BodyLanes.MostInverseInertia)];
            for (int i = 0; i < 6; i++)
            {
                double r = _momenta[6 * body + i] - a[o + i];
                _residual[6 * body + i] = r;
                most = Math.Max(most, Math.Abs(r) * (i < 3 ? 1 : inverse));
            }
        }

        Write(_momenta, 1);
        return most;
    }

    // J M~^-1 J^T, by the impulses and where the bodies are now.
    private void Factor(double h)
    {
        DelassusMatrix<ScalarLane>.InverseInertias(_batch);
        Stiffen(h);
        _batch.ActiveSet?.WriteRows(false);
        DelassusMatrix<ScalarLane>.Assemble(_batch, _batch.CompliantStep > 0 ? CompliantAngles<ScalarLane>.Share(h) : Share);
        _batch.ActiveSet?.AddToDiagonal(true);
        DelassusMatrix<ScalarLane>.Factor(_batch);
    }

    // (J M~^-1 J^T) dl = -C / h + J M~^-1 r; dv = M~^-1 (J^T dl - r).
    private void Correct(double h)
    {
        LaneBatch<ScalarLane> batch = _batch;
        double[] solution = batch.Work.Solution;
        Write(_residual, 1);
        Impulses<ScalarLane>.NegativeSpeeds(batch, false);
        for (int i = 0; i < solution.Length; i++)
        {
            solution[i] = -batch.Work.Error[i] / h - solution[i];
        }

        batch.ActiveSet?.ClearAtBound(solution);
        DelassusMatrix<ScalarLane>.Solve(batch, solution);
        for (int i = 0; i < solution.Length; i++)
        {
            batch.Work.PositionImpulses[i] += solution[i];
        }

        Write(_residual, -1);
        Impulses<ScalarLane>.Apply(batch, solution);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            Advance(body);
        }
    }

    // From what the impulses and the residual give a body to its new momenta: dv as it is; dL = I (I + h K)^-1 of it, that
    // is: less h K dw.
    private void Advance(int body)
    {
        double[] a = _batch.Bodies;
        int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.V);
        Vector3d turn = Symmetric3.Load(a, LaneBatch<ScalarLane>.Body(body, BodyLanes.WorldInverse)).Times(new Vector3d(a[o + 3], a[o + 4], a[o + 5]));
        Vector3d held = Symmetric3.Load(_stiffness, 6 * body).Times(turn);
        for (int i = 0; i < 6; i++)
        {
            a[o + i] += _momenta[6 * body + i];
        }

        a[o + 3] -= held.X;
        a[o + 4] -= held.Y;
        a[o + 5] -= held.Z;
    }

    // h K of every body from the impulses, and (I + h K)^-1 = (1 + I^-1 h K)^-1 I^-1 into the world inverse inertia.
    private void Stiffen(double h)
    {
        Array.Clear(_stiffness, 0, _stiffness.Length);
        Island shape = _batch.Shape;
        for (int n = 0; n < shape.Blocks.Length; n++)
        {
            RowBlock block = shape.Blocks[n];
            if (block.Joint == null)
            {
                continue;
            }

            for (int side = 0; side < 2; side++)
            {
                if (block.Bodies[side] < shape.MovingBodies)
                {
                    Vector3d force = Impulses<ScalarLane>.Force(_batch, n, side, _batch.Work.PositionImpulses);
                    int lever = LaneBatch<ScalarLane>.Joint(n, LaneBatch<ScalarLane>.WorldFrame(side));
                    AddStiffness(6 * block.Bodies[side], force * h, new Vector3d(_batch.Joints[lever], _batch.Joints[lever + 1], _batch.Joints[lever + 2]));
                }
            }
        }

        for (int body = 0; body < shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.WorldInverse);
            Symmetric3.InverseOfSum(Symmetric3.Load(_batch.Bodies, o), Symmetric3.Load(_stiffness, 6 * body)).Store(_batch.Bodies, o);
        }
    }

    private void AddStiffness(int k, Vector3d force, Vector3d lever)
    {
        double[] sum = _stiffness;
        double along = (Vector3d.Dot(force, lever) + Math.Sqrt(force.LengthSquared * lever.LengthSquared)) / 2;
        sum[k] += along - lever.X * force.X;
        sum[k + 1] += along - lever.Y * force.Y;
        sum[k + 2] += along - lever.Z * force.Z;
        sum[k + 3] -= (lever.X * force.Y + force.X * lever.Y) / 2;
        sum[k + 4] -= (lever.X * force.Z + force.X * lever.Z) / 2;
        sum[k + 5] -= (lever.Y * force.Z + force.Y * lever.Z) / 2;
    }

    private void Read(double[] momenta)
    {
        double[] a = _batch.Bodies;
        for (int k = 0, o = BodyLanes.V; k < momenta.Length; k += 6, o += BodyLanes.Count)
        {
            for (int i = 0; i < 6; i++)
            {
                momenta[k + i] = a[o + i];
            }
        }
    }

    private void Write(double[] momenta, double factor)
    {
        double[] a = _batch.Bodies;
        for (int k = 0, o = BodyLanes.V; k < momenta.Length; k += 6, o += BodyLanes.Count)
        {
            for (int i = 0; i < 6; i++)
            {
                a[o + i] = factor * momenta[k + i];
            }
        }
    }
}
