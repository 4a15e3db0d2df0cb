using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <content>
/// Coupled angles of joints that turn about other axes too, <see cref="CoordinateCoupling.AngleAmongOthers"/>. Where such a one is driven, its coupling takes
/// the value that it is driven to for its own: the rows are the same at that value, and the angle need not have one on the way.
/// </content>
internal sealed partial class PositionEquations
{
    // c = |(q_i, q_w)| below which a rotation does not tell the angle: it is what drives and couplings say.
    private const double NoAngle = 1e-6;

    // c times the angle that is left, radians: C' is 0 a whole turn off, too.
    private const double MostOpen = 1;

    private CoordinateCoupling.AngleAmongOthers _angle;

    /// <summary>Says what a coordinate is being driven to; NaN: it is not.</summary>
    public void Hold(int coordinate, double target) => _held[coordinate] = target;

    private bool IsHeldAmongOthers(int coordinate) => _linkage.IsCoupledAmongOthers[coordinate] && !double.IsNaN(_held[coordinate]);

    // What follows, then the terms of a coupling.
    private static int Coordinate(PositionCoupling coupling, int place) => place == 0 ? coupling.Driven : coupling.Terms[place - 1];

    private static double Factor(PositionCoupling coupling, int place) => place == 0 ? 1 : -coupling.Ratios[place - 1];

    // Of those that are not driven the one nearest to where it has no value; -1: there is none.
    private int AngleAmongOthers(PositionCoupling coupling, Pose[] poses)
    {
        int nearest = -1;
        double least = double.PositiveInfinity;
        for (int i = 0; i <= coupling.Terms.Length; i++)
        {
            int coordinate = Coordinate(coupling, i);
            if (_linkage.IsCoupledAmongOthers[coordinate] && !IsHeldAmongOthers(coordinate) && SquareOf(coordinate, poses) is double square && square < least)
            {
                (least, nearest) = (square, i);
            }
        }

        return nearest;
    }

    private double CouplingError(PositionCoupling coupling, Pose[] poses, double[] values)
    {
        double c = 0;
        for (int i = 0; i <= coupling.Terms.Length; i++)
        {
            int coordinate = Coordinate(coupling, i);
            c += Factor(coupling, i) * (IsHeldAmongOthers(coordinate) ? _held[coordinate] : Evaluate(coordinate, poses, values, out _coupled[i]));
        }

        return c - coupling.Offset;
    }

    // C' for an angle that has to be a target, and its row; null where it is so far off that the angle itself has to tell.
    private double? AngleError(int coordinate, double target, double factor, Pose[] poses, double[] values, out ConstraintRow row, out double weight)
    {
        MechanismCoordinate source = _linkage.Coordinates[coordinate];
        double angle = SwingTwist.Nearest(Evaluate(coordinate, poses, values, out row), target);
        FramesOf(coordinate, poses, out JointFrames f);
        double square = CoordinateCoupling.AngleAmongOthers.SquareOf(f, source.AngleAxis);
        weight = 1;
        if (!(Math.Sqrt(square) * Math.Abs(angle - target) < MostOpen))
        {
            return null;
        }

        values[coordinate] = square < NoAngle * NoAngle ? target : angle;
        double error = _angle.Evaluate(f, source.AngleAxis, source.Sign * target, source.Sign * factor, isBuilt: true);
        row.Angular0 = row.Angular1 = -_angle.Gradient;
        weight = _angle.Weight;
        return error;
    }

    private double SquareOf(int coordinate, Pose[] poses)
    {
        FramesOf(coordinate, poses, out JointFrames f);
        return CoordinateCoupling.AngleAmongOthers.SquareOf(f, _linkage.Coordinates[coordinate].AngleAxis);
    }

    private void FramesOf(int coordinate, Pose[] poses, out JointFrames f)
    {
        JointModel joint = _linkage.Coordinates[coordinate].JointRows;
        joint.FramesAt(Linkage.PoseOf(joint.Body0, poses), Linkage.PoseOf(joint.Body1, poses), out f);
    }
}
