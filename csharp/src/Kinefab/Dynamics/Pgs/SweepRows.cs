using System;
using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// The rows of all joints, an array a quantity so that a sweep reads nothing else, and one sweep over those of a joint.
/// Source: DySolverConstraint1D.h, SolverConstraint1D; DySolverConstraints.cpp, solve1D.
/// </summary>
internal sealed class SweepRows
{
    /// <summary>No joint needs more factors than this: at most six equalities, each taken from all rows after it.</summary>
    public const int MaxFactors = 6 * JointModel.MaxRows;

    public readonly RowVectors[] Vectors;

    /// <summary>Angular0 as the joint gave it, for the reported torque.</summary>
    public readonly Vector3d[] Angular0;

    /// <summary>By which preprocessing took rows from each other, in its order; with them the reported torque does the same.</summary>
    public readonly double[] Factors;

    /// <summary>Whether the impulse counts for breaking and for the reported force.</summary>
    public readonly bool[] Counts;
    public readonly RowBounds[] Bounds;

    /// <summary>Impulse that the start velocity and the bias ask for.</summary>
    public readonly double[] BiasedConstants;

    /// <summary>The same without bias, for the velocity iterations.</summary>
    public readonly double[] UnbiasedConstants;

    public readonly double[] VelocityMultipliers;

    /// <summary>Accumulated.</summary>
    public readonly double[] Impulses;

    public SweepRows(int joints)
    {
        int capacity = joints * JointModel.MaxRows;
        Vectors = new RowVectors[capacity];
        Angular0 = new Vector3d[capacity];
        Factors = new double[joints * MaxFactors];
        Counts = new bool[capacity];
        Bounds = new RowBounds[capacity];
        BiasedConstants = new double[capacity];
        UnbiasedConstants = new double[capacity];
        VelocityMultipliers = new double[capacity];
        Impulses = new double[capacity];
    }

    /// <summary>Any rows, one after the other: lambda = clamp(i lambda + m Cdot + constant).</summary>
    public void SolveInTurn(int start, int end, in JointBlock block, BodyDelta[] bodies, double[] constants)
    {
        BodyDelta body0 = bodies[block.Body0];
        BodyDelta body1 = bodies[block.Body1];
        for (int i = start; i < end; i++)
        {
            ref RowVectors row = ref Vectors[i];
            ref RowBounds bounds = ref Bounds[i];
            double velocity = Products(row, body0.Linear - body1.Linear, body0.Angular, body1.Angular).Sum3;
            double impulse = bounds.ImpulseMultiplier * Impulses[i] + VelocityMultipliers[i] * velocity + constants[i];
            impulse = Math.Min(bounds.Maximum, Math.Max(bounds.Minimum, impulse));
            double delta = impulse - Impulses[i];
            Impulses[i] = impulse;
            Apply(delta * row.Linear, delta * row.Sqrt0, delta * row.Sqrt1, block.Mass, ref body0, ref body1);
        }

        bodies[block.Moved0] = body0;
        bodies[block.Moved1] = body1;
    }

    /// <summary>Equalities that are mass-orthogonal: none changes another's Cdot, so all see the velocities from before.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public void SolveTogether(in JointBlock block, BodyDelta[] bodies, double[] constants)
    {
        BodyDelta body0 = bodies[block.Body0];
        BodyDelta body1 = bodies[block.Body1];
        Double4 relative = body0.Linear - body1.Linear;
        Double4 before0 = body0.Angular;
        Double4 before1 = body1.Angular;
        Double4 linear = default;
        Double4 angular0 = default;
        Double4 angular1 = default;
        int i = block.Equalities;
        int end = block.Inequalities;
        for (; i <= end - 4; i += 4)
        {
            Span<RowVectors> rows = Vectors.AsSpan(i, 4);
            Double4 velocities = Double4.Sums3(
                Products(rows[0], relative, before0, before1),
                Products(rows[1], relative, before0, before1),
                Products(rows[2], relative, before0, before1),
                Products(rows[3], relative, before0, before1));
            Double4 deltas = Double4.Load(VelocityMultipliers, i) * velocities + Double4.Load(constants, i);
            (Double4.Load(Impulses, i) + deltas).Store(Impulses, i);
            Add(rows[0], deltas.Spread(0), ref linear, ref angular0, ref angular1);
            Add(rows[1], deltas.Spread(1), ref linear, ref angular0, ref angular1);
            Add(rows[2], deltas.Spread(2), ref linear, ref angular0, ref angular1);
            Add(rows[3], deltas.Spread(3), ref linear, ref angular0, ref angular1);
        }

        for (; i < end; i++)
        {
            ref RowVectors row = ref Vectors[i];
            double delta = VelocityMultipliers[i] * Products(row, relative, before0, before1).Sum3 + constants[i];
            Impulses[i] += delta;
            linear += delta * row.Linear;
            angular0 += delta * row.Sqrt0;
            angular1 += delta * row.Sqrt1;
        }

        Apply(linear, angular0, angular1, block.Mass, ref body0, ref body1);
        bodies[block.Moved0] = body0;
        bodies[block.Moved1] = body1;
    }

    /// <summary>What adds up to Cdot.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static Double4 Products(in RowVectors row, Double4 relative, Double4 angular0, Double4 angular1) =>
        relative * row.Linear + angular0 * row.Sqrt0 - angular1 * row.Sqrt1;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void Add(in RowVectors row, Double4 delta, ref Double4 linear, ref Double4 angular0, ref Double4 angular1)
    {
        linear += delta * row.Linear;
        angular0 += delta * row.Sqrt0;
        angular1 += delta * row.Sqrt1;
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void Apply(Double4 linear, Double4 angular0, Double4 angular1, in PairMass mass, ref BodyDelta body0, ref BodyDelta body1)
    {
        body0.Linear += linear * mass.InverseMass0;
        body1.Linear -= linear * mass.InverseMass1;
        body0.Angular += angular0 * mass.InertiaScale0;
        body1.Angular -= angular1 * mass.InertiaScale1;
    }
}
