using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// The safe floor under RATTLE: M (v - v0) = h f + J(x')^T l, C(x') = 0 with x' the flight of v. Newton's method with
/// M + h K in place of M, K the geometric stiffness of the bodies under the impulses l, shifted to be positive
/// semi-definite; it keeps to the bodies' blocks, so that the matrix has its usual pattern. Unconditionally stable and
/// strongly dissipative. Starts from l = 0, since a warm l carries loads that no motion asks for.
/// K = sum over anchors of (F.r + |F||r|)/2 1 - sym(r F^T), F the impulse at the lever r.
/// </summary>
internal sealed class ImplicitEulerStep
{
    private const int MaxIterations = 20;

    // One share for all rows: with the larger one for angles the iteration stops converging.
    private const double Share = 1e-6;

    private readonly Batch<ScalarLane> _batch;
    private readonly double[] _aim;
    private readonly double[] _residual;
    private readonly double[] _momenta;
    private readonly double[] _stiffness;

    public ImplicitEulerStep(Batch<ScalarLane> batch)
    {
        _batch = batch;
        int bodies = batch.Shape.MovingBodies;
        _aim = new double[6 * bodies];
        _residual = new double[6 * bodies];
        _momenta = new double[6 * bodies];
        _stiffness = new double[9 * bodies];
    }

    /// <summary>From the start pose to a closed end pose; false when that was not reached.</summary>
    public bool Fly(double h, double tolerance)
    {
        Batch<ScalarLane> batch = _batch;
        Laws<ScalarLane>? laws = batch.Laws;
        batch.Work.Active[0] = 1;
        batch.SoftStep = 0;
        laws?.Begin(h, true);
        RattleStep<ScalarLane>.Kick(batch, h);
        Gather(_aim);
        Array.Clear(batch.Work.First, 0, batch.Work.First.Length);
        laws?.StartFromZero();
        Flight<ScalarLane>.MoveKinematic(batch, h);
        int lawPasses = 0;
        for (int iteration = 0; iteration < MaxIterations; iteration++)
        {
            Flight<ScalarLane>.Run(batch, h);
            RigidRows<ScalarLane>.Evaluate(batch);
            laws?.Evaluate(h);
            RigidRows<ScalarLane>.Rate(batch);
            RigidRows<ScalarLane>.Build(batch);
            laws?.WriteRows(true);
            double unbalanced = h * Residual();
            bool isClosed = RattleStep<ScalarLane>.IsClosed(batch, 0, tolerance, iteration > 0);
            if (isClosed && unbalanced < tolerance && !(laws != null && laws.Update(lawPasses++, tolerance)))
            {
                return true;
            }

            if (!(batch.Work.MaxError[0] < double.MaxValue && unbalanced < double.MaxValue))
            {
                return false;
            }

            laws?.Evaluate(h);
            Correct(h);
        }

        // With the anchors together, forces and angles that are a little off are better than no step.
        return batch.Work.MaxGap[0] < 10 * tolerance;
    }

    // r = (v - aim) - M^-1 J^T l for the linear part, L - aim - J^T l for the angular one; the largest as a speed.
    private double Residual()
    {
        Batch<ScalarLane> batch = _batch;
        ResponseMatrix<ScalarLane>.InverseInertias(batch);
        Gather(_momenta);
        for (int i = 0; i < _residual.Length; i++)
        {
            _residual[i] = _aim[i];
        }

        Scatter(_residual);
        Impulses<ScalarLane>.Apply(batch, batch.Work.First);
        Gather(_residual);
        double most = 0;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            for (int i = 0; i < 6; i++)
            {
                _residual[6 * body + i] = _momenta[6 * body + i] - _residual[6 * body + i];
            }

            double inverse = batch.Bodies[Batch<ScalarLane>.Body(body, BodySlot.MostInverseInertia)];
            for (int i = 0; i < 3; i++)
            {
                most = Math.Max(most, Math.Abs(_residual[6 * body + i]));
                most = Math.Max(most, Math.Abs(_residual[6 * body + 3 + i]) * inverse);
            }
        }

        Scatter(_momenta);
        return most;
    }

    // (J M~^-1 J^T) dl = -C / h + J M~^-1 r; dv = M~^-1 (J^T dl - r).
    private void Correct(double h)
    {
        Batch<ScalarLane> batch = _batch;
        Stiffen(h);
        batch.Laws?.WriteRows(false);
        ResponseMatrix<ScalarLane>.Assemble(batch, Share);
        batch.Laws?.Condition(true);
        BlockCholesky<ScalarLane>.Factor(batch.Shape.Pattern, batch.Matrix);
        Scatter(_residual);
        Impulses<ScalarLane>.NegativeSpeeds(batch, false);
        for (int i = 0; i < batch.Work.Solution.Length; i++)
        {
            batch.Work.Solution[i] = -batch.Work.Error[i] / h - batch.Work.Solution[i];
        }

        batch.Laws?.ClearClamped(batch.Work.Solution);
        BlockCholesky<ScalarLane>.Solve(batch.Shape.Pattern, batch.Matrix, batch.Work.Solution);
        for (int i = 0; i < batch.Work.Solution.Length; i++)
        {
            batch.Work.First[i] += batch.Work.Solution[i];
        }

        for (int i = 0; i < _residual.Length; i++)
        {
            _residual[i] = -_residual[i];
        }

        Scatter(_residual);
        Impulses<ScalarLane>.Apply(batch, batch.Work.Solution);
        Gather(_residual);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            Advance(body);
        }

        Scatter(_momenta);
    }

    // The step of one body: dv as it is; dL = I (I + h K)^-1 (what was gathered), that is: gathered - h K dw.
    private void Advance(int body)
    {
        double[] a = _batch.Bodies;
        int o = Batch<ScalarLane>.Body(body, BodySlot.WorldInverse);
        double tx = _residual[6 * body + 3], ty = _residual[6 * body + 4], tz = _residual[6 * body + 5];
        double wx = a[o] * tx + a[o + 3] * ty + a[o + 4] * tz;
        double wy = a[o + 3] * tx + a[o + 1] * ty + a[o + 5] * tz;
        double wz = a[o + 4] * tx + a[o + 5] * ty + a[o + 2] * tz;
        int k = 9 * body;
        for (int i = 0; i < 3; i++)
        {
            _momenta[6 * body + i] += _residual[6 * body + i];
            double held = _stiffness[k + 3 * i] * wx + _stiffness[k + 3 * i + 1] * wy + _stiffness[k + 3 * i + 2] * wz;
            _momenta[6 * body + 3 + i] += _residual[6 * body + 3 + i] - held;
        }
    }

    // h K of every body from the impulses, and (I + h K)^-1 = (1 + I^-1 h K)^-1 I^-1 into the world inverse inertia.
    private void Stiffen(double h)
    {
        Array.Clear(_stiffness, 0, _stiffness.Length);
        Island shape = _batch.Shape;
        for (int n = 0; n < shape.Nodes.Length; n++)
        {
            Node node = shape.Nodes[n];
            if (node.Joint == null)
            {
                continue;
            }

            for (int side = 0; side < 2; side++)
            {
                if (node.Bodies[side] < shape.MovingBodies)
                {
                    Vector3d force = Impulses<ScalarLane>.Force(_batch, n, side, _batch.Work.First);
                    int lever = Batch<ScalarLane>.Joint(n, Batch<ScalarLane>.Placed(side));
                    AddStiffness(9 * node.Bodies[side], force * h, new Vector3d(_batch.Joints[lever], _batch.Joints[lever + 1], _batch.Joints[lever + 2]));
                }
            }
        }

        for (int body = 0; body < shape.MovingBodies; body++)
        {
            StiffenBody(body);
        }
    }

    private void AddStiffness(int k, Vector3d force, Vector3d lever)
    {
        double diagonal = (Vector3d.Dot(force, lever) + force.Length * lever.Length) / 2;
        for (int i = 0; i < 3; i++)
        {
            for (int j = 0; j < 3; j++)
            {
                _stiffness[k + 3 * i + j] += (i == j ? diagonal : 0) - (lever[i] * force[j] + force[i] * lever[j]) / 2;
            }
        }
    }

    private void StiffenBody(int body)
    {
        double[] a = _batch.Bodies;
        int o = Batch<ScalarLane>.Body(body, BodySlot.WorldInverse);
        var inverse = Symmetric3.Load(a, o);
        var stiffness = new Symmetric3(
            _stiffness[9 * body], _stiffness[9 * body + 4], _stiffness[9 * body + 8],
            _stiffness[9 * body + 1], _stiffness[9 * body + 2], _stiffness[9 * body + 5]);
        Symmetric3.InverseOfSum(inverse, stiffness).Store(a, o);
    }

    private void Gather(double[] momenta)
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            Array.Copy(_batch.Bodies, Batch<ScalarLane>.Body(body, BodySlot.V), momenta, 6 * body, 6);
        }
    }

    private void Scatter(double[] momenta)
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            Array.Copy(momenta, 6 * body, _batch.Bodies, Batch<ScalarLane>.Body(body, BodySlot.V), 6);
        }
    }
}
