using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>The drive of a hinge as a row about its axis x, of either kind of joint, where its turn is <see cref="JointModel.LastTwist"/>.</summary>
internal readonly struct HingeDrive
{
    /// <summary>Whether it is a motor or a spring whose C is the turn that is left; else a prescribed motion, or a spring that pulls by a sine.</summary>
    public bool IsLinear { get; private init; }

    public bool IsSpring { get; private init; }

    public DriveModel Gains { get; private init; }

    /// <summary>C of a spring, radians.</summary>
    public double Error { get; private init; }

    /// <summary>Of x.(w0 - w1), rad/s.</summary>
    public double VelocityTarget { get; private init; }

    /// <summary>Bounds of the impulse, or of the torque where the joint's limits are such.</summary>
    public double Minimum { get; private init; }

    public double Maximum { get; private init; }

    /// <summary>That of a joint with one drive, about its turn.</summary>
    public static HingeDrive Of(JointModel joint)
    {
        if (joint is RevoluteJoint hinge)
        {
            return hinge.MotorEnabled ? OfMotor(hinge) : OfSpring(hinge.Spring, hinge.SpringTarget - hinge.LastTwist, 0);
        }

        var d6 = (D6Joint)joint;
        return double.IsNaN(d6.DriveTwistAngle)
            ? OfSpring(d6.DriveTwist, ToGoal(d6), d6.DriveAngularVelocity.X, d6.DriveTwist.Stiffness > 0)
            : OfSpring(d6.DriveTwist, d6.DriveTwistAngle - d6.LastTwist, d6.DriveAngularVelocity.X);
    }

    // RevoluteJoint's row is about -x.
    private static HingeDrive OfMotor(RevoluteJoint hinge) => new()
    {
        IsLinear = true,
        VelocityTarget = -hinge.MotorVelocity,
        Minimum = hinge.MotorFreeSpin && hinge.MotorVelocity < 0 ? 0 : -hinge.MotorForceLimit,
        Maximum = hinge.MotorFreeSpin && hinge.MotorVelocity > 0 ? 0 : hinge.MotorForceLimit,
    };

    private static HingeDrive OfSpring(in DriveModel gains, double error, double velocityTarget, bool isSine = false) => new()
    {
        IsLinear = gains.Prescribes != Prescribed.Position && !(isSine && gains.Prescribes == Prescribed.Nothing),
        IsSpring = gains.Prescribes != Prescribed.Speed,
        Gains = gains,
        Error = error,
        VelocityTarget = velocityTarget,
        Minimum = -gains.ForceLimit,
        Maximum = gains.ForceLimit,
    };

    // -2 delta.X of D6Joint's twist drive, delta = conj(goal) c, with c = (sin, 0, 0, cos) of half the turn.
    private static double ToGoal(D6Joint joint)
    {
        Quaterniond goal = joint.DrivePose.Rotation;
        double sine = Trigonometry.Sin(joint.LastTwist / 2), cosine = Trigonometry.Cos(joint.LastTwist / 2);
        double delta = goal.W * sine - goal.X * cosine;
        return goal.X * sine + goal.W * cosine > 0 ? -2 * delta : 2 * delta;
    }
}
