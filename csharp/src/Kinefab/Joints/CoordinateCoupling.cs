using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>
/// A linear relation between two joint coordinates, for gears, belts, racks and screws. PhysX 4.1 and Unity have no such
/// joint: here it is one rigid row over the up to four bodies of both joints, so that reactions act where they should.
/// C = q_B - Ratio q_A - Offset; Cdot = row_B - Ratio row_A.
/// </summary>
internal sealed class CoordinateCoupling
{
    public readonly CoordinateAxisMap A;
    public readonly CoordinateAxisMap B;

    /// <summary>Unit of B for each unit of A, radians and metres.</summary>
    public readonly double Ratio;

    /// <summary>Unit of B.</summary>
    public readonly double Offset;

    /// <summary>Coordinates at the last finished step; angles are unwrapped against them.</summary>
    public double LastA;
    public double LastB;

    public CoordinateCoupling(CoordinateAxisMap a, CoordinateAxisMap b, double ratio, double offset)
    {
        A = a;
        B = b;
        Ratio = ratio;
        Offset = offset;
    }

    /// <summary>C and its two half rows at the poses of both joints' bodies (0 and 1 of A, 0 and 1 of B).</summary>
    public double Prepare(in Pose a0, in Pose a1, in Pose b0, in Pose b1, out ConstraintRow rowA, out ConstraintRow rowB)
    {
        double qA = A.Evaluate(a0, a1, LastA, out rowA);
        double qB = B.Evaluate(b0, b1, LastB, out rowB);
        return qB - Ratio * qA - Offset;
    }
}
