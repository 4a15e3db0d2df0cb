using System;
using Kinefab.Joints;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Preparation of one joint's rows for PGS: sorted by solve hint, then made mass-orthogonal, so that solving one rigid
/// row leaves the others of its joint alone. Source: DyConstraintSetup.cpp, preprocessRows and orthogonalize.
/// </summary>
internal sealed class Preprocessing
{
    private const int MaxEqualities = 6;

    private const double LeastShare = 1e-12;

    // Kept, so that no call has to clear them.
    private readonly double[] _factor = new double[Joint.MaxRows * MaxEqualities];
    private readonly double[] _inverse = new double[MaxEqualities];

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
    /// of its error, target and velocity; inequalities are not freed from each other. Done as G = L D L^T of the rows' products,
    /// whose D are the responses of the new rows and whose inverse L makes them: the products then do not wait for each other.
    /// A row that the ones before it leave next to nothing of gets the response 0 and so does nothing, where PhysX would divide by its rounding.
    /// </summary>
    /// <param name="rows">The joint's rigid rows, equalities first.</param>
    /// <param name="equalities">How many of them are equalities.</param>
    /// <param name="mass">Mass properties of the pair.</param>
    public void Orthogonalize(Span<PgsRow> rows, int equalities, in PairMass mass)
    {
        Span<double> factor = _factor;
        Span<double> inverse = _inverse;
        Products(rows, equalities, mass, factor);
        for (int i = 0; i < rows.Length; i++)
        {
            Span<double> l = factor.Slice(i * MaxEqualities, MaxEqualities);
            double response = rows[i].Response;
            double least = response * LeastShare;
            int count = Math.Min(i, equalities);
            for (int j = 0; j < count; j++)
            {
                Span<double> other = factor.Slice(j * MaxEqualities, MaxEqualities);
                double product = l[j];
                for (int k = 0; k < j; k++)
                {
                    product -= l[k] * other[k] * rows[k].Response;
                }

                l[j] = product * inverse[j];
                response -= product * l[j];
            }

            rows[i].Response = response > least ? response : 0;
            if (i < equalities)
            {
                inverse[i] = rows[i].Response > 0 ? 1 / rows[i].Response : 0;
            }

            for (int j = 0; j < count; j++)
            {
                rows[i].Subtract(rows[j], l[j]);
            }
        }
    }

    // The lower half of G, with the equalities alone as columns.
    private static void Products(Span<PgsRow> rows, int equalities, in PairMass mass, Span<double> products)
    {
        double inverseMass = mass.InverseMass0 + mass.InverseMass1;
        for (int i = 0; i < rows.Length; i++)
        {
            Double4 linear = rows[i].Linear * inverseMass;
            Double4 sqrt0 = rows[i].Sqrt0 * mass.InertiaScale0;
            Double4 sqrt1 = rows[i].Sqrt1 * mass.InertiaScale1;
            int count = Math.Min(i, equalities);
            for (int j = 0; j < count; j++)
            {
                ref PgsRow other = ref rows[j];
                products[i * MaxEqualities + j] = (linear * other.Linear + sqrt0 * other.Sqrt0 + sqrt1 * other.Sqrt1).Sum3;
            }
        }
    }
}
