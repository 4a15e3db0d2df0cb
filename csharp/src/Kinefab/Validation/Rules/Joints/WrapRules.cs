using System;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;

namespace Kinefab.Validation;

/// <summary>
/// Stops near a half turn of joints whose angle is counted within one: beyond it PhysX reads the angle from the other side, inside the
/// limits again, and turns the bodies on instead of back.
/// </summary>
internal static class WrapRules
{
    private const double HalfTurn = 180;
    private const double Degrees = 180 / Math.PI;

    // Steps that a joint may need to turn back from beyond its stop.
    private const int Steps = 2;

    // rad/s that a joint is taken to meet its stop with where no motor makes it faster; what it falls with only a run can tell.
    private const double Slowest = 1;

    internal static void Hinge(HingeJoint hinge, double step, in Place at)
    {
        if (!hinge.UseLimits || hinge.ExtendedLimits || hinge.Limits.Min >= hinge.Limits.Max)
            return;
        double motor = hinge.UseMotor && hinge.Motor.Force > 0 ? hinge.Motor.TargetVelocity : 0;
        if (Furthest(hinge.Limits.Min, hinge.Limits.Max, motor, step) is double angle)
            at.Report("limits", DiagnosticCodes.HingeLimitsWrap, ("angle", Invariant.Text(angle)));
    }

    internal static void Twist(ConfigurableJoint joint, double step, in Place at)
    {
        double low = joint.LowAngularXLimit.Limit, high = joint.HighAngularXLimit.Limit;
        if (joint.AngularXMotion != ConfigurableJointMotion.Limited || low >= high)
            return;
        JointDrive drive = joint.AngularXDrive;
        bool isDriven = joint.RotationDriveMode == RotationDriveMode.XYAndZ && drive.PositionDamper > 0 && drive.MaximumForce > 0;
        double speed = isDriven ? joint.TargetAngularVelocity.X * Degrees : 0;
        if (Furthest(low, high, speed, step) is double angle)
            at.Report(angle == Math.Abs(high) ? "highAngularXLimit" : "lowAngularXLimit", DiagnosticCodes.AngularLimitWraps, ("angle", Invariant.Text(angle)));
    }

    // The stop that may be passed, degrees; null where none may. One beyond a half turn is another finding's.
    private static double? Furthest(double low, double high, double speed, double step)
    {
        double furthest = Math.Max(Math.Abs(low), Math.Abs(high));
        double fastest = Math.Max(Math.Abs(speed), Slowest * Degrees);
        return furthest <= HalfTurn && furthest + Steps * step * fastest > HalfTurn ? furthest : null;
    }
}
