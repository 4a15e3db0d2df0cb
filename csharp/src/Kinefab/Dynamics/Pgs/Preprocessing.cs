using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>Inverse masses of a body pair as one joint sees them.</summary>
internal readonly struct PairMass
{
    public readonly double InverseMass0;
    public readonly double InverseMass1;

    /// <summary>Factors on the sqrt-space products, which already hold the inertias.</summary>
    public readonly double InertiaScale0;
    public readonly double InertiaScale1;

    public PairMass(double inverseMass0, double inverseMass1, double inertiaScale0, double inertiaScale1)
    {
        InverseMass0 = inverseMass0;
        InverseMass1 = inverseMass1;
        InertiaScale0 = inertiaScale0;
        InertiaScale1 = inertiaScale1;
    }
}

/// <summary>
/// Preparation of one joint's rows for PGS: sorted by solve hint, then made mass-orthogonal, so that solving one rigid
/// row leaves the others of its joint alone. Source: DyConstraintSetup.cpp, preprocessRows and orthogonalize.
/// </summary>
internal static class Preprocessing
{
    /// <summary>Stable insertion sort of row indices by hint: drives and soft limits, slerp, equalities, inequalities.</summary>
    public static void Sort(ReadOnlySpan<ConstraintRow> rows, Span<int> order)
    {
        for (int i = 0; i < rows.Length; i++)
        {
            int j = i;
            for (; j > 0 && rows[i].Hint < rows[order[j - 1]].Hint; j--)
            {
                order[j] = order[j - 1];
            }

            order[j] = i;
        }
    }

    /// <summary>
    /// Modified Gram-Schmidt in the product J M^-1 J^T: each rigid row loses its part along the equalities before it, together with
    /// that part of its error and target. Inequalities are not freed from each other.
    /// </summary>
    /// <param name="rows">The joint's rows.</param>
    /// <param name="order">Their order; the rigid rows stand last, equalities first among them.</param>
    /// <param name="s0">I^(-1/2) Angular0 of each row, in the order's sequence; combined along with it.</param>
    /// <param name="s1">The same for body 1.</param>
    /// <param name="mass">Mass properties of the pair.</param>
    public static void Orthogonalize(Span<ConstraintRow> rows, ReadOnlySpan<int> order, Span<Vector3d> s0, Span<Vector3d> s1, in PairMass mass)
    {
        int start = 0;
        while (start < order.Length && rows[order[start]].Hint < SolveHint.Equality)
        {
            start++;
        }

        int equalities = start;
        while (equalities < order.Length && rows[order[equalities]].Hint == SolveHint.Equality)
        {
            equalities++;
        }

        Span<double> inverseResponse = stackalloc double[Joint.MaxRows];
        double inverseMass = mass.InverseMass0 + mass.InverseMass1;
        for (int i = start; i < order.Length; i++)
        {
            ref ConstraintRow row = ref rows[order[i]];
            int eliminated = Math.Min(i, equalities);
            for (int j = start; j < eliminated; j++)
            {
                ref ConstraintRow other = ref rows[order[j]];
                double product = Product(row.Linear0, s0[i], s1[i], other.Linear0, s0[j], s1[j], inverseMass, mass);
                double t = product * inverseResponse[j];
                row.Linear0 -= other.Linear0 * t;
                row.Linear1 = row.Linear0;
                row.Angular0 -= other.Angular0 * t;
                row.Angular1 -= other.Angular1 * t;
                row.GeometricError -= other.GeometricError * t;
                row.VelocityTarget -= other.VelocityTarget * t;
                s0[i] -= s0[j] * t;
                s1[i] -= s1[j] * t;
            }

            if (i < equalities)
            {
                double response = Product(row.Linear0, s0[i], s1[i], row.Linear0, s0[i], s1[i], inverseMass, mass);
                inverseResponse[i] = response > 0 ? 1 / response : 0;
            }
        }
    }

    private static double Product(
        Vector3d linearA, Vector3d s0A, Vector3d s1A, Vector3d linearB, Vector3d s0B, Vector3d s1B, double inverseMass, in PairMass mass) =>
        Vector3d.Dot(linearA, linearB) * inverseMass
        + Vector3d.Dot(s0A, s0B) * mass.InertiaScale0
        + Vector3d.Dot(s1A, s1B) * mass.InertiaScale1;
}
