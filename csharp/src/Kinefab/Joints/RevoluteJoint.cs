using System;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>
/// PxRevoluteJoint, the joint under Unity's HingeJoint: rotation about the frames' common X, with limits and a motor;
/// and Unity's hinge spring, which PxRevoluteJoint lacks.
/// </summary>
internal sealed class RevoluteJoint : JointModel
{
    public bool LimitEnabled;

    /// <summary>Limits of actor 1's angle against actor 0; lower >= upper locks the joint at 0.</summary>
    public AngularLimit Limit;

    public bool MotorEnabled;

    /// <summary>Target of (w1 - w0).X, rad/s.</summary>
    public double MotorVelocity;

    /// <summary>Largest torque, N m (an impulse when DriveLimitsAreForces is off).</summary>
    public double MotorForceLimit = double.PositiveInfinity;

    /// <summary>The motor never brakes.</summary>
    public bool MotorFreeSpin;

    /// <summary>Spring towards SpringTarget; inactive while it has no gains or the motor is enabled.</summary>
    public DriveModel Spring;

    /// <summary>Target of actor 1's angle against actor 0, radians.</summary>
    public double SpringTarget;

    /// <inheritdoc/>
    public override void TakeOver(JointModel copy)
    {
        base.TakeOver(copy);
        var hinge = (RevoluteJoint)copy;
        LimitEnabled = hinge.LimitEnabled;
        Limit = hinge.Limit;
        MotorEnabled = hinge.MotorEnabled;
        MotorVelocity = hinge.MotorVelocity;
        MotorForceLimit = hinge.MotorForceLimit;
        MotorFreeSpin = hinge.MotorFreeSpin;
        Spring = hinge.Spring;
        SpringTarget = hinge.SpringTarget;
    }

    /// <summary>Locked in all axes where the limits leave no range; else free about X alone.</summary>
    public override RowLayout Layout()
    {
        bool isLocked = LimitEnabled && Limit.Lower >= Limit.Upper;
        return isLocked
            ? new RowLayout(0b111111, 0, 0, 0, false)
            : new RowLayout(0b110111, LimitEnabled ? 0b001000 : 0, 0, MotorEnabled || Spring.IsActive ? 1 : 0, false);
    }

    /// <inheritdoc/>
    public override int Prepare(in Pose body0, in Pose body1, Span<ConstraintRow> rows) => Prepare(body0, body1, rows, true);

    /// <inheritdoc/>
    public override int PrepareForces(in Pose body0, in Pose body1, Span<ConstraintRow> rows) => Prepare(body0, body1, rows, false);

    /// <inheritdoc/>
    public override int PrepareLocked(in Pose body0, in Pose body1, Span<ConstraintRow> rows, out JointFrames frames)
    {
        FramesAt(body0, body1, out frames);
        var writer = new RowWriter(rows, frames.P1, body0.Position, body1.Position, LimitsFromAfar);
        LockedAxes(ref writer, frames);
        return writer.Count;
    }

    /// <summary>Actor 1's angle against actor 0, radians; see SwingTwist.TwistAngle for its range.</summary>
    public double Angle(in Pose body0, in Pose body1)
    {
        FramesAt(body0, body1, out JointFrames f);
        return Angle(f);
    }

    private int Prepare(in Pose body0, in Pose body1, Span<ConstraintRow> rows, bool hasLockedAxes)
    {
        FramesAt(body0, body1, out JointFrames f);
        var writer = new RowWriter(rows, f.P1, body0.Position, body1.Position, LimitsFromAfar);
        if (hasLockedAxes)
        {
            LockedAxes(ref writer, f);
        }

        if (IsLocked)
        {
            return writer.Count;
        }

        // Cdot = (w1 - w0).X0 = MotorVelocity, torque within the limit; freeSpin takes away the braking side.
        // Source: ExtRevoluteJoint.cpp, RevoluteJointSolverPrep.
        if (MotorEnabled)
        {
            double minimum = MotorFreeSpin && MotorVelocity > 0 ? 0 : -MotorForceLimit;
            double maximum = MotorFreeSpin && MotorVelocity < 0 ? 0 : MotorForceLimit;
            writer.Motor(f.Axis0(0), MotorVelocity, minimum, maximum);
        }
        else if (Spring.IsActive)
        {
            // C = target - phi, Cdot = -(w1 - w0).X0: the angular drive row of a D6 with the angle itself as error.
            writer.AngularDrive(Gradient(f), 0, SpringTarget - Angle(f), Spring);
        }

        if (LimitEnabled)
        {
            writer.AngleLimits(Gradient(f), Angle(f), Limit.Lower, Limit.Upper, Limit.Response);
        }

        return writer.Count;
    }

    private bool IsLocked => LimitEnabled && Limit.Lower >= Limit.Upper;

    private void LockedAxes(ref RowWriter writer, in JointFrames f) => writer.Locked(f, 7, IsLocked ? 7 : 6);

    // The axis, where both axes are one; in an inconsistent loop they are not, and what held by PhysX's row would give energy.
    private Vector3d Gradient(in JointFrames f)
    {
        if (!LimitsFromAfar)
        {
            return f.Axis0(0);
        }

        f.Axes1(out Vector3d x1, out _, out _);
        return SwingTwist.TwistGradient(f.Axis0(0), x1);
    }

    private double Angle(in JointFrames f) => Followed(SwingTwist.TwistAngle(f.Relative.Rotation));
}
