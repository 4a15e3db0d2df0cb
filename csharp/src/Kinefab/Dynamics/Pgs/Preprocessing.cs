using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Preparation of one joint's rows for PGS: sorted by solve hint, then made mass-orthogonal, so that solving one rigid
/// row leaves the others of its joint alone. Source: DyConstraintSetup.cpp, preprocessRows and orthogonalize.
/// </summary>
internal static class Preprocessing
{
    private const double LeastShare = 1e-12;

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
    /// Gram-Schmidt in the product J M^-1 J^T: each rigid row loses its part along the equalities before it, together with that part
    /// of its error, target and velocity; inequalities are not freed from each other.
    /// A row that the ones before it leave next to nothing of gets the response 0 and so does nothing, where PhysX would divide by its rounding.
    /// </summary>
    /// <param name="rows">All rows.</param>
    /// <param name="block">Which of them; its factors are written.</param>
    /// <param name="responses">Of the rigid rows.</param>
    /// <param name="least">As many places to work in.</param>
    /// <returns>The number of factors.</returns>
    public static int Orthogonalize(SweepRows rows, in JointBlock block, Span<double> responses, Span<double> least)
    {
        Span<RowVectors> vectors = rows.Vectors.AsSpan(block.Equalities, block.End - block.Equalities);
        PairMass mass = block.Mass;
        double inverseMass = mass.InverseMass0 + mass.InverseMass1;
        int equalities = block.Inequalities - block.Equalities;
        int factors = block.Factors;
        for (int i = 0; i < vectors.Length; i++)
        {
            least[i] = responses[i] * LeastShare;
        }

        for (int j = 0; j < vectors.Length; j++)
        {
            double response = responses[j] > least[j] ? responses[j] : 0;
            responses[j] = response;
            if (j >= equalities)
            {
                continue;
            }

            double inverse = response > 0 ? 1 / response : 0;
            Double4 linear = vectors[j].Linear;
            Double4 sqrt0 = vectors[j].Sqrt0;
            Double4 sqrt1 = vectors[j].Sqrt1;
            Double4 byMass = linear * inverseMass;
            Double4 byInertia0 = sqrt0 * mass.InertiaScale0;
            Double4 byInertia1 = sqrt1 * mass.InertiaScale1;
            for (int i = j + 1; i < vectors.Length; i++)
            {
                ref RowVectors row = ref vectors[i];
                double product = (byMass * row.Linear + byInertia0 * row.Sqrt0 + byInertia1 * row.Sqrt1).Sum3;
                double factor = product * inverse;
                row.Linear -= linear * factor;
                row.Sqrt0 -= sqrt0 * factor;
                row.Sqrt1 -= sqrt1 * factor;
                responses[i] -= product * factor;
                rows.Factors[factors++] = factor;
            }
        }

        return factors - block.Factors;
    }

    /// <summary>Takes the rigid rows' other vectors from each other by the same factors.</summary>
    public static void Repeat(SweepRows rows, in JointBlock block, Span<Vector3d> vectors)
    {
        int factors = block.Factors;
        for (int j = 0; j < block.Inequalities - block.Equalities; j++)
        {
            for (int i = j + 1; i < vectors.Length; i++)
            {
                vectors[i] -= vectors[j] * rows.Factors[factors++];
            }
        }
    }
}
