using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>A spring-damper of a rest length between two points, which benchmarks need and Unity's joints do not offer.</summary>
internal sealed class DistanceSpring : JointModel
{
    public double Length;
    public double Stiffness;
    public double Damping;

    /// <summary>C = Length - |p1 - p0|, J along the line; the force pushes the points apart where C is positive.</summary>
    public override int Prepare(in Pose body0, in Pose body1, Span<ConstraintRow> rows)
    {
        Vector3d p0 = (body0 * Frame0).Position;
        Vector3d p1 = (body1 * Frame1).Position;
        double distance = (p1 - p0).Length;
        Vector3d along = distance > 0 ? (p1 - p0) * (1 / distance) : Vector3d.UnitX;
        rows[0] = new ConstraintRow
        {
            Linear0 = along,
            Angular0 = Vector3d.Cross(p0 - body0.Position, along),
            Angular1 = Vector3d.Cross(p1 - body1.Position, along),
            GeometricError = Length - distance,
            Minimum = double.NegativeInfinity,
            Maximum = double.PositiveInfinity,
            Stiffness = Stiffness,
            Damping = Damping,
            Flags = RowFlags.Spring | RowFlags.Drive,
        };
        return 1;
    }
}
