using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>
/// A linear relation between joint coordinates, for gears, belts, racks, screws and what follows several joints. PhysX 4.1 and Unity
/// have no such joint: here it is one rigid row over the bodies of all its joints, so that reactions act where they should.
/// C = sum of Factor_i q_i - Offset; Cdot = sum of Factor_i row_i.
/// </summary>
internal sealed class CoordinateCoupling
{
    /// <summary>Those that are followed, then the one that follows.</summary>
    public readonly CoordinateAxisMap[] Coordinates;

    /// <summary>For each coordinate: 1 for the one that follows, of the others less its unit for each unit of theirs, radians and metres.</summary>
    public readonly double[] Factors;

    /// <summary>Unit of the coordinate that follows.</summary>
    public readonly double Offset;

    /// <summary>Coordinates at the last finished step; angles are unwrapped against them.</summary>
    public readonly double[] Last;

    /// <summary>The rows of the coordinates where they were evaluated last.</summary>
    public readonly ConstraintRow[] Rows;

    public CoordinateCoupling(CoordinateAxisMap driven, IReadOnlyList<(CoordinateAxisMap Coordinate, double Ratio)> terms, double offset)
    {
        Coordinates = new CoordinateAxisMap[terms.Count + 1];
        Factors = new double[Coordinates.Length];
        for (int i = 0; i < terms.Count; i++)
        {
            Coordinates[i] = terms[i].Coordinate;
            Factors[i] = -terms[i].Ratio;
        }

        Coordinates[^1] = driven;
        Factors[^1] = 1;
        Offset = offset;
        Last = new double[Coordinates.Length];
        Rows = new ConstraintRow[Coordinates.Length];
    }

    /// <summary>Whether none of its joints has broken.</summary>
    public bool IsWhole
    {
        get
        {
            foreach (CoordinateAxisMap coordinate in Coordinates)
            {
                if (coordinate.Joint.IsBroken)
                {
                    return false;
                }
            }

            return true;
        }
    }

    /// <summary>Factor times coordinate at the poses of its joint's bodies; its row is noted in <see cref="Rows"/>.</summary>
    public double Evaluate(int coordinate, in Pose body0, in Pose body1) =>
        Factors[coordinate] * Coordinates[coordinate].Evaluate(body0, body1, Last[coordinate], out Rows[coordinate]);
}
