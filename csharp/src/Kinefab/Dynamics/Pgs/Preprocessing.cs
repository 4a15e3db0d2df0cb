using System;
using Kinefab.Joints;

namespace Kinefab.Dynamics.Pgs;

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
    /// that part of its error, target and velocity. Inequalities are not freed from each other.
    /// </summary>
    /// <param name="rows">The joint's rigid rows, equalities first.</param>
    /// <param name="equalities">How many of them are equalities.</param>
    /// <param name="mass">Mass properties of the pair.</param>
    public static void Orthogonalize(Span<PgsRow> rows, int equalities, in PairMass mass)
    {
        Span<double> inverseResponse = stackalloc double[Joint.MaxRows];
        for (int i = 0; i < rows.Length; i++)
        {
            ref PgsRow row = ref rows[i];
            int eliminated = Math.Min(i, equalities);
            for (int j = 0; j < eliminated; j++)
            {
                ref PgsRow other = ref rows[j];
                double t = mass.Product(row, other) * inverseResponse[j];
                row.Linear -= other.Linear * t;
                row.Sqrt0 -= other.Sqrt0 * t;
                row.Sqrt1 -= other.Sqrt1 * t;
                row.Angular0 -= other.Angular0 * t;
            }

            if (i < equalities)
            {
                double response = mass.Product(row, row);
                inverseResponse[i] = response > 0 ? 1 / response : 0;
            }
        }
    }
}
