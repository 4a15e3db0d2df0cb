using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Spaces of twists, each by orthonormal vectors of six.</summary>
internal static class TwistSpan
{
    /// <summary>An orthonormal basis of what twists span.</summary>
    /// <param name="twists">Any number of them.</param>
    /// <param name="least">Singular value, absolute, up to which one counts as none.</param>
    public static List<double[]> Of(List<double[]> twists, double least)
    {
        SingularValues values = Decomposed(twists);
        return Vectors(values, 0, values.Rank(least));
    }

    /// <summary>
    /// As Of, of what one body does in motions of several: entries that are none are left out of the span's directions, not of the twists,
    /// whose entries depend on the motions that the span was told by.
    /// </summary>
    /// <param name="twists">Any number of them.</param>
    /// <param name="least">Singular value, absolute, up to which one counts as none, and entry of a direction as long as its singular value.</param>
    public static List<double[]> Moving(List<double[]> twists, double least)
    {
        SingularValues values = Decomposed(twists);
        List<double[]> directions = Vectors(values, 0, values.Rank(least));
        for (int k = 0; k < directions.Count; k++)
        {
            directions[k] = Array.ConvertAll(directions[k], entry => Math.Abs(entry) * values.Values[k] > least ? entry : 0);
        }

        return directions;
    }

    /// <summary>What rows leave free.</summary>
    /// <param name="rows">Of unit length.</param>
    public static List<double[]> LeftBy(List<double[]> rows)
    {
        SingularValues values = Decomposed(rows);
        return Vectors(values, VelocitySpace.Rank(values.Values, 1), 6);
    }

    /// <summary>What of a space lies in another one too.</summary>
    /// <param name="a">Which.</param>
    /// <param name="b">The other one.</param>
    /// <param name="shared">How far the cosine, squared, may be from 1.</param>
    public static List<double[]> Common(List<double[]> a, List<double[]> b, double shared)
    {
        var cosines = new double[b.Count, a.Count];
        for (int i = 0; i < b.Count; i++)
        {
            for (int j = 0; j < a.Count; j++)
            {
                cosines[i, j] = DenseVector.Dot(b[i], a[j]);
            }
        }

        var values = new SingularValues(cosines);
        int count = Array.FindAll(values.Values, cosine => cosine * cosine > 1 - shared).Length;
        return Mixtures(a, values, 0, count);
    }

    /// <summary>Mixtures of twists by the right singular vectors of a matrix with a column for each.</summary>
    /// <param name="twists">Orthonormal.</param>
    /// <param name="values">Of the matrix.</param>
    /// <param name="first">The first vector that counts.</param>
    /// <param name="end">The first behind it that does not; null: all do.</param>
    public static List<double[]> Mixtures(List<double[]> twists, SingularValues values, int first, int? end = null)
    {
        var mixtures = new List<double[]>();
        for (int k = first; k < (end ?? twists.Count); k++)
        {
            var twist = new double[6];
            for (int j = 0; j < twists.Count; j++)
            {
                for (int i = 0; i < 6; i++)
                {
                    twist[i] += twists[j][i] * values.Vector(j, k);
                }
            }

            mixtures.Add(twist);
        }

        return mixtures;
    }

    private static SingularValues Decomposed(List<double[]> rows)
    {
        var matrix = new double[rows.Count, 6];
        for (int r = 0; r < rows.Count; r++)
        {
            for (int i = 0; i < 6; i++)
            {
                matrix[r, i] = rows[r][i];
            }
        }

        return new SingularValues(matrix);
    }

    private static List<double[]> Vectors(SingularValues values, int first, int end)
    {
        var vectors = new List<double[]>();
        for (int k = first; k < end; k++)
        {
            var twist = new double[6];
            for (int i = 0; i < 6; i++)
            {
                twist[i] = values.Vector(i, k);
            }

            vectors.Add(twist);
        }

        return vectors;
    }
}
