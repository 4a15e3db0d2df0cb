using System;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>A rotation as q = swing * twist, twist about X and swing about an axis at right angles to X.</summary>
internal readonly struct SwingTwist
{
    private const double LeastCosine = 1e-6;

    /// <summary>Keeps forces that a weight divides finite, and 0 / 0 out where there is no twist.</summary>
    public const double LeastWeight = 1e-9;

    public readonly Quaterniond Swing;
    public readonly Quaterniond Twist;

    /// <summary>Source: PsMathUtils.h, separateSwingTwist.</summary>
    public SwingTwist(Quaterniond q)
    {
        Twist = q.X != 0 ? new Quaterniond(q.X, 0, 0, q.W).Normalized() : Quaterniond.Identity;
        Swing = q * Twist.Conjugate();
    }

    /// <summary>
    /// Angle of a rotation's twist about X, radians: in (-pi, pi] when w is not negative, else out to -2 pi or 2 pi.
    /// Source: ExtRevoluteJoint.cpp, computePhi (there by acos of a float, which is coarse near 0).
    /// </summary>
    public static double TwistAngle(Quaterniond q) => 2 * Trigonometry.Atan2(q.X, q.W);

    /// <summary>
    /// g of a twist: its rate is g.w for the angular velocity w of frame 1 against frame 0; g = (a0 + a1) / (1 + a0.a1). Where the axis has
    /// been turned round by half a turn there is no twist, and g stays finite.
    /// </summary>
    /// <param name="axis0">The twist's axis in frame 0.</param>
    /// <param name="axis1">The same in frame 1.</param>
    public static Vector3d TwistGradient(Vector3d axis0, Vector3d axis1) => (axis0 + axis1) * (1 / Math.Max(LeastCosine, 1 + Vector3d.Dot(axis0, axis1)));

    /// <summary>
    /// g of what is left of a twist to a goal, weighed by c = cos(swing / 2): c (goal - twist) falls at the rate g.w, w the angular velocity of frame 1
    /// against frame 0. c is the length of (q_x, q_w), about whose origin the twist turns: the rate of a twist grows without end towards a swing of half
    /// a turn, where there is no twist; c times it does not.
    /// </summary>
    /// <param name="axis0">The twist's axis in frame 0.</param>
    /// <param name="axis1">The same in frame 1.</param>
    /// <param name="left">Goal - twist, radians.</param>
    /// <param name="weight">c.</param>
    public static Vector3d WeighedGradient(Vector3d axis0, Vector3d axis1, double left, out double weight)
    {
        Vector3d sum = axis0 + axis1;
        weight = sum.Length / 2;
        double inverse = 1 / Math.Max(LeastWeight, weight);
        return sum * (inverse / 2) - Vector3d.Cross(axis1, axis0) * (left * inverse / 4);
    }

    /// <summary>Of the angles that differ from one by whole turns the one nearest to a reference, radians.</summary>
    public static double Nearest(double angle, double reference) => angle + 2 * Math.PI * Math.Round((reference - angle) / (2 * Math.PI));

    /// <summary>Component of the swing about Y or Z, radians. Source: ExtJoint.h, computeSwingAngle.</summary>
    public static double SwingAngle(double component, double w) => 4 * Trigonometry.Atan2(component, 1 + w);
}
