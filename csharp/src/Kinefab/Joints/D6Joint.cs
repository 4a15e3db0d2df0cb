using System;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>
/// PxD6Joint, the joint under Unity's ConfigurableJoint: six axes, each locked, limited or free, with drives. Linear axes,
/// cone and single swing limits turn with actor 0; twist and swing drives act about actor 1's axes.
/// </summary>
internal sealed class D6Joint : JointModel
{
    // Below this distance the direction of a disc or ball limit is undefined (PhysX: 1e-6 of the length scale).
    private const double LeastLimitedDistance = 1e-6;

    // Half angle of a cone without width, radians, with room for rounding.
    private const double NoConeAngle = 1.0001 * ConeLimit.LeastAngle;

    /// <summary>
    /// What a coupling says of an angle of a joint all of whose coordinates are angles of that joint too, by the others, where none of them is as near to
    /// where it has no value. Its gradient and that of the angle itself differ by a multiple of the coupling's own: they ask for the same motion.
    /// </summary>
    /// <param name="axis">0, 1 or 2.</param>
    /// <param name="f">The joint's frames.</param>
    /// <param name="angle">Of frame 1 against frame 0, radians, with its whole turns.</param>
    /// <param name="gradient">Its gradient for the angular velocity of frame 1 against frame 0, in the world.</param>
    /// <returns>False where it says nothing by them.</returns>
    public delegate bool AngleByOthers(int axis, in JointFrames f, out double angle, out Vector3d gradient);

    /// <summary>Motions in PxD6Axis's order: X, Y, Z, twist, swing about Y, swing about Z. All locked at first.</summary>
    public AxisMotion X, Y, Z, Twist, Swing1, Swing2;

    public LinearLimit LinearLimit;

    // For each angle what the coupling says that holds it, so that it has weight at any swing; null without any.
    private AngleByOthers?[]? _couplings;

    public AngularLimit TwistLimit;
    public ConeLimit SwingLimit;

    public DriveModel DriveX, DriveY, DriveZ;

    /// <summary>About actor 1's X.</summary>
    public DriveModel DriveTwist;

    /// <summary>About actor 1's Y and Z: PhysX has one drive for both, a program may drive either by itself.</summary>
    public DriveModel DriveSwing1, DriveSwing2;

    /// <summary>Along the shortest arc; replaces twist and swing drives, and needs all three angles unlocked.</summary>
    public DriveModel DriveSlerp;

    /// <summary>Both swings' drive, as PhysX has it.</summary>
    public DriveModel DriveSwing
    {
        set => DriveSwing1 = DriveSwing2 = value;
    }

    /// <summary>Goal of frame 1 in frame 0.</summary>
    public Pose DrivePose = Pose.Identity;

    /// <summary>
    /// Goal of the twist drive as an angle with its whole turns, radians: it pulls by the angle that is left, as the drive of an articulation's hinge
    /// does; NaN: by twice the sine of its half to <see cref="DrivePose"/>, as PhysX's D6.
    /// </summary>
    public double DriveTwistAngle = double.NaN;

    /// <summary>Goal of the velocity of frame 1 against frame 0, in frame 0's axes, m/s.</summary>
    public Vector3d DriveLinearVelocity;

    /// <summary>Goal of the angular velocity, rad/s: of actor 0 against actor 1 with twist and swing drives, of actor 1
    /// against actor 0 with the slerp drive (PhysX's own inconsistency).</summary>
    public Vector3d DriveAngularVelocity;

    /// <inheritdoc/>
    public override void TakeOver(JointModel copy)
    {
        base.TakeOver(copy);
        var d6 = (D6Joint)copy;
        (X, Y, Z, Twist, Swing1, Swing2) = (d6.X, d6.Y, d6.Z, d6.Twist, d6.Swing1, d6.Swing2);
        LinearLimit = d6.LinearLimit;
        _couplings = d6._couplings;
        TwistLimit = d6.TwistLimit;
        SwingLimit = d6.SwingLimit;
        (DriveX, DriveY, DriveZ) = (d6.DriveX, d6.DriveY, d6.DriveZ);
        (DriveTwist, DriveSwing1, DriveSwing2, DriveSlerp) = (d6.DriveTwist, d6.DriveSwing1, d6.DriveSwing2, d6.DriveSlerp);
        DrivePose = d6.DrivePose;
        DriveTwistAngle = d6.DriveTwistAngle;
        DriveLinearVelocity = d6.DriveLinearVelocity;
        DriveAngularVelocity = d6.DriveAngularVelocity;
    }

    /// <inheritdoc/>
    public override int Prepare(in Pose body0, in Pose body1, Span<ConstraintRow> rows) => Prepare(body0, body1, rows, true);

    /// <inheritdoc/>
    public override int PrepareForces(in Pose body0, in Pose body1, Span<ConstraintRow> rows) => Prepare(body0, body1, rows, false);

    /// <inheritdoc/>
    public override int PrepareLocked(in Pose body0, in Pose body1, Span<ConstraintRow> rows, out JointFrames frames)
    {
        FramesAt(body0, body1, out frames);
        frames.Axes1(out Vector3d x1, out _, out _);
        var writer = new RowWriter(rows, frames.P1, body0.Position, body1.Position, LimitsFromAfar);
        LockedAxes(ref writer, frames, x1);
        return writer.Count;
    }

    /// <summary>
    /// The motion of X, Y or Z. Where the rows of all limits are asked for, Limited to a hard radius of nothing is Locked:
    /// the direction of so small a distance would come and go, and with it the limit's row, which PhysX lets happen. To a soft one it is Free and
    /// has a spring of its own, which together are the same spring, with a direction everywhere.
    /// </summary>
    public AxisMotion Linear(AxisMotion motion) =>
        !LimitsFromAfar || motion != AxisMotion.Limited || LinearLimit.Value > LeastLimitedDistance ? motion
        : LinearLimit.Response.IsSoft ? AxisMotion.Free
        : AxisMotion.Locked;

    private bool IsSprung(AxisMotion motion) => motion == AxisMotion.Limited && Linear(motion) == AxisMotion.Free;

    /// <summary>The motion of either swing, Locked likewise where both are Limited to a hard cone without width.</summary>
    public AxisMotion Swing(AxisMotion motion) =>
        LimitsFromAfar && Swing1 == AxisMotion.Limited && Swing2 == AxisMotion.Limited && !SwingLimit.Response.IsSoft
            && Math.Max(SwingLimit.Y, SwingLimit.Z) <= NoConeAngle
            ? AxisMotion.Locked
            : motion;

    /// <inheritdoc/>
    public override RowLayout Layout()
    {
        AxisMotion x = Linear(X), y = Linear(Y), z = Linear(Z), swing1 = Swing(Swing1), swing2 = Swing(Swing2);
        int locked = Bits(AxisMotion.Locked), limited = Bits(AxisMotion.Limited);
        int linear = Count(DriveX.IsActive && x != AxisMotion.Locked) + Count(DriveY.IsActive && y != AxisMotion.Locked) + Count(DriveZ.IsActive && z != AxisMotion.Locked)
            + Count(IsSprung(X)) + Count(IsSprung(Y)) + Count(IsSprung(Z));
        bool slerp = DriveSlerp.IsActive && Twist != AxisMotion.Locked && swing1 != AxisMotion.Locked && swing2 != AxisMotion.Locked;
        int angular = slerp ? 3
            : Count(DriveTwist.IsActive && Twist != AxisMotion.Locked) + Count(DriveSwing1.IsActive && swing1 != AxisMotion.Locked)
                + Count(DriveSwing2.IsActive && swing2 != AxisMotion.Locked);
        return new RowLayout(locked, limited, linear, angular, slerp);

        int Bits(AxisMotion motion) =>
            Count(x == motion) | (Count(y == motion) << 1) | (Count(z == motion) << 2) | (Count(Twist == motion) << 3) | (Count(swing1 == motion) << 4)
            | (Count(swing2 == motion) << 5);

        static int Count(bool isOne) => isOne ? 1 : 0;
    }

    private int Prepare(in Pose body0, in Pose body1, Span<ConstraintRow> rows, bool hasLockedAxes)
    {
        FramesAt(body0, body1, out JointFrames f);
        f.Axes1(out Vector3d x1, out Vector3d y1, out Vector3d z1);
        var writer = new RowWriter(rows, f.P1, body0.Position, body1.Position, LimitsFromAfar);

        LinearDrives(ref writer, f);
        AngularDrives(ref writer, f, x1, y1, z1);
        AngularLimits(ref writer, f, x1);
        LinearLimits(ref writer, f);
        if (hasLockedAxes)
        {
            LockedAxes(ref writer, f, x1);
        }

        return writer.Count;
    }

    // Spring-damper per axis a of frame 0: C = (target - c.p).a, Cdot = a.(velocity of 0 - velocity of 1).
    // Source: ExtD6Joint.cpp, D6JointSolverPrep (the velocity is actor 1's against 0, hence its sign).
    private void LinearDrives(ref RowWriter writer, in JointFrames f)
    {
        Vector3d error = DrivePose.Position - f.Relative.Position;
        if (DriveX.IsActive && Linear(X) != AxisMotion.Locked)
        {
            writer.LinearDrive(f.Axis0(0), -DriveLinearVelocity.X, error.X, DriveX);
        }

        if (DriveY.IsActive && Linear(Y) != AxisMotion.Locked)
        {
            writer.LinearDrive(f.Axis0(1), -DriveLinearVelocity.Y, error.Y, DriveY);
        }

        if (DriveZ.IsActive && Linear(Z) != AxisMotion.Locked)
        {
            writer.LinearDrive(f.Axis0(2), -DriveLinearVelocity.Z, error.Z, DriveZ);
        }

        Vector3d p = f.Relative.Position;
        if (IsSprung(X))
        {
            writer.Spring(f.Axis0(0), -p.X, LinearLimit.Response);
        }

        if (IsSprung(Y))
        {
            writer.Spring(f.Axis0(1), -p.Y, LinearLimit.Response);
        }

        if (IsSprung(Z))
        {
            writer.Spring(f.Axis0(2), -p.Z, LinearLimit.Response);
        }
    }

    // With delta = conj(target) * c, target on c's side of the double cover:
    // slerp, three rows: C_i = -delta_i, J_i = row i of 1/2 L R (world axes while there is no stiffness);
    // twist about X1: C = -2 delta_x, or the angle to its goal; swing about Y1 and Z1: C = the sine of the angle that brings X1 to its goal.
    // Source: ExtD6Joint.cpp, D6JointSolverPrep; prepareData for which drives count.
    private void AngularDrives(ref RowWriter writer, in JointFrames f, Vector3d x1, Vector3d y1, Vector3d z1)
    {
        bool isSwing1Free = Swing(Swing1) != AxisMotion.Locked;
        bool isSwing2Free = Swing(Swing2) != AxisMotion.Locked;
        bool slerp = DriveSlerp.IsActive && Twist != AxisMotion.Locked && isSwing1Free && isSwing2Free;
        bool twist = DriveTwist.IsActive && Twist != AxisMotion.Locked;
        bool swing1 = DriveSwing1.IsActive && isSwing1Free;
        bool swing2 = DriveSwing2.IsActive && isSwing2Free;
        if (!slerp && !twist && !swing1 && !swing2)
        {
            return;
        }

        Quaterniond goal = DrivePose.Rotation;
        if (JointFrames.Dot(f.Relative.Rotation, goal) <= 0)
        {
            goal = JointFrames.Negate(goal);
        }

        Quaterniond delta = goal.Conjugate() * f.Relative.Rotation;
        if (slerp)
        {
            Vector3d velocity = f.Q0 * -DriveAngularVelocity;
            Vector3d a0 = Vector3d.UnitX;
            Vector3d a1 = Vector3d.UnitY;
            Vector3d a2 = Vector3d.UnitZ;
            if (DriveSlerp.Stiffness != 0)
            {
                JointFrames.QuaternionAxes(f.Q0 * goal, f.Q1, out a0, out a1, out a2);
            }

            writer.AngularDrive(a0, Vector3d.Dot(a0, velocity), -delta.X, DriveSlerp, SolveHint.SlerpSpring);
            writer.AngularDrive(a1, Vector3d.Dot(a1, velocity), -delta.Y, DriveSlerp, SolveHint.SlerpSpring);
            writer.AngularDrive(a2, Vector3d.Dot(a2, velocity), -delta.Z, DriveSlerp, SolveHint.SlerpSpring);
            return;
        }

        if (twist && writer.Prescribed(DriveTwist) == Prescribed.Position)
        {
            AngularMotion(ref writer, f, 0, x1, DriveTwist);
        }
        else if (twist)
        {
            double error = double.IsNaN(DriveTwistAngle) ? -2 * delta.X : DriveTwistAngle - Followed(SwingTwist.TwistAngle(f.Relative.Rotation));
            writer.AngularDrive(x1, DriveAngularVelocity.X, error, DriveTwist);
        }

        Vector3d x = delta * Vector3d.UnitX;
        if (swing1 && writer.Prescribed(DriveSwing1) == Prescribed.Position)
        {
            AngularMotion(ref writer, f, 1, y1, DriveSwing1);
        }
        else if (swing1)
        {
            writer.AngularDrive(y1, DriveAngularVelocity.Y, x.Z, DriveSwing1);
        }

        if (swing2 && writer.Prescribed(DriveSwing2) == Prescribed.Position)
        {
            AngularMotion(ref writer, f, 2, z1, DriveSwing2);
        }
        else if (swing2)
        {
            writer.AngularDrive(z1, DriveAngularVelocity.Z, -x.Y, DriveSwing2);
        }
    }

    /// <summary>Whether a coupling holds one of its angles that turns about other axes too, see <see cref="Couple"/>.</summary>
    public bool IsCoupledAmongOthers => _couplings != null;

    /// <summary>Notes that a coupling holds an angle.</summary>
    /// <param name="axis">0, 1 or 2.</param>
    /// <param name="coupling">What it says of the angle.</param>
    public void Couple(int axis, AngleByOthers coupling) => (_couplings ??= new AngleByOthers?[3])[axis] = coupling;

    // C = c times the angle about an axis that is left to the goal, by the shorter way, c as of a limit; what is left falls as prescribed at whatever swing.
    // J is c times the gradient of the angle, not that of C: C falls as c does too, and a drive whose force has no end, held by a limit of the angle, would
    // turn its joint over, to a swing of half a turn. The torque, of J times it, keeps its limit. An angle that a coupling holds has weight there too; where
    // the coupling is one of the joint's own angles it says the angle by the others, which have a value where this one has none.
    private void AngularMotion(ref RowWriter writer, in JointFrames f, int axis, Vector3d axis1, in DriveModel drive)
    {
        Quaterniond at = f.Relative.Rotation;
        Quaterniond to = DrivePose.Rotation;
        bool isCounted = axis == 0 && !double.IsNaN(DriveTwistAngle);
        double goal = isCounted ? DriveTwistAngle : 2 * Trigonometry.Atan2(to.Vector[axis], to.W), near = isCounted ? LastTwist : goal;
        AngleByOthers? coupling = _couplings?[axis];
        if (coupling != null && coupling(axis, f, out double followed, out Vector3d others))
        {
            writer.AngularDrive(others, 0, goal - SwingTwist.Nearest(followed, near), drive);
            return;
        }

        double angle = SwingTwist.Nearest(2 * Trigonometry.Atan2(at.Vector[axis], at.W), near);
        Vector3d gradient = SwingTwist.WeighedGradient(f.Axis0(axis), axis1, 0, out double weight);
        double inverse = 1 / Math.Max(SwingTwist.LeastWeight, weight);
        if (coupling != null)
        {
            writer.AngularDrive(gradient * inverse, 0, goal - angle, drive);
            return;
        }

        DriveModel weighed = drive;
        weighed.ForceLimit /= Math.Max(SwingTwist.LeastWeight, weight);
        writer.AngularDrive(gradient, 0, weight * (goal - angle), weighed, weight: weight);
    }

    // Both swings limited: one row on the elliptic cone, error the sine of the distance. One limited, the other locked:
    // C = the swing angle against +-limit about frame 0's axis. One limited, the other free: C = the elevation of X1
    // against +-limit. Twist: C = the twist angle against its limits about X1, in the exact solver weighed.
    // Source: ExtD6Joint.cpp, D6JointSolverPrep and setup*SwingLimit(s).
    private void AngularLimits(ref RowWriter writer, in JointFrames f, Vector3d x1)
    {
        bool twist = Twist == AxisMotion.Limited;
        bool swing1 = Swing(Swing1) == AxisMotion.Limited;
        bool swing2 = Swing(Swing2) == AxisMotion.Limited;
        if (!twist && !swing1 && !swing2)
        {
            return;
        }

        var parts = new SwingTwist(f.Relative.Rotation);
        ref LimitResponse response = ref SwingLimit.Response;
        if (swing1 && swing2)
        {
            // In the cone's middle its nearest line has no direction: half of it is far enough.
            double every = Math.Min(SwingLimit.Y, SwingLimit.Z) / 2;
            double padding = LimitsFromAfar ? every : response.IsSoft ? 0 : response.ContactDistance;
            if (ConeLimitError.Find(SwingLimit, padding, parts.Swing, LimitsFromAfar, out Vector3d axis, out double error))
            {
                writer.ConeLimit(f.Q0 * axis, error, response);
            }
        }
        else if (swing1)
        {
            if (Swing2 == AxisMotion.Locked)
            {
                double angle = SwingTwist.SwingAngle(parts.Swing.Y, parts.Swing.W);
                writer.AngleLimits(f.Axis0(1), angle, -SwingLimit.Y, SwingLimit.Y, response);
            }
            else
            {
                Elevation(ref writer, Vector3d.Cross(f.Axis0(2), x1), -Vector3d.Dot(f.Axis0(2), x1), SwingLimit.Y, response);
            }
        }
        else if (swing2)
        {
            if (Swing1 == AxisMotion.Locked)
            {
                double angle = SwingTwist.SwingAngle(parts.Swing.Z, parts.Swing.W);
                writer.AngleLimits(f.Axis0(2), angle, -SwingLimit.Z, SwingLimit.Z, response);
            }
            else
            {
                Elevation(ref writer, -Vector3d.Cross(f.Axis0(1), x1), Vector3d.Dot(f.Axis0(1), x1), SwingLimit.Z, response);
            }
        }

        if (twist)
        {
            double angle = Followed(Twisted(f));
            if (LimitsFromAfar && !HasCardanTwist)
            {
                writer.WeighedTwistLimits(f.Axis0(0), x1, angle, TwistLimit);
            }
            else
            {
                // PhysX's row is not the gradient of its angle while the joint swings: what holds by it gives energy and drifts.
                writer.AngleLimits(HasCardanTwist ? CardanGradient(f) : x1, angle, TwistLimit.Lower, TwistLimit.Upper, TwistLimit.Response);
            }
        }
    }

    // Where one swing is locked and the other is not, frame 1 has turned about its X from the axis that stays square to that X: the same angle as the
    // twist, but known at a swing of half a turn too.
    private bool HasCardanTwist => LimitsFromAfar && (Swing(Swing1) == AxisMotion.Locked) != (Swing(Swing2) == AxisMotion.Locked);

    /// <inheritdoc/>
    private protected override double Twisted(in JointFrames f)
    {
        if (!HasCardanTwist)
        {
            return base.Twisted(f);
        }

        Cardan(f, out _, out _, out double sine, out double cosine);
        return Trigonometry.Atan2(sine, cosine);
    }

    private Vector3d CardanGradient(in JointFrames f)
    {
        Vector3d axis = Cardan(f, out Vector3d sineAxis, out Vector3d cosineAxis, out double sine, out double cosine);
        return Vector3d.Cross(sineAxis * cosine - cosineAxis * sine, axis) * (1 / (sine * sine + cosine * cosine));
    }

    // The axis of frame 0 that stays square to X1, and its components along axes of frame 1.
    private Vector3d Cardan(in JointFrames f, out Vector3d sineAxis, out Vector3d cosineAxis, out double sine, out double cosine)
    {
        f.Axes1(out _, out Vector3d y1, out Vector3d z1);
        bool isZ = Swing(Swing1) == AxisMotion.Locked;
        Vector3d axis = f.Axis0(isZ ? 2 : 1);
        (sineAxis, cosineAxis) = isZ ? (y1, z1) : (-z1, y1);
        sine = Vector3d.Dot(axis, sineAxis);
        cosine = Vector3d.Dot(axis, cosineAxis);
        return axis;
    }

    private static void Elevation(ref RowWriter writer, Vector3d axis, double sine, double limit, in LimitResponse response) =>
        writer.AngleLimits(axis.Normalized(), Trigonometry.Asin(Math.Max(-1, Math.Min(1, sine))), -limit, limit, response);

    // C = limit - |d|, d = c.p along the limited axes only; direction d/|d| in frame 0's axes.
    // Source: ExtD6Joint.cpp, computeLimitedDistance and D6JointSolverPrep (distance limit).
    private void LinearLimits(ref RowWriter writer, in JointFrames f)
    {
        Vector3d p = f.Relative.Position;
        Vector3d d = Vector3d.Zero;
        d += Linear(X) == AxisMotion.Limited ? f.Axis0(0) * p.X : Vector3d.Zero;
        d += Linear(Y) == AxisMotion.Limited ? f.Axis0(1) * p.Y : Vector3d.Zero;
        d += Linear(Z) == AxisMotion.Limited ? f.Axis0(2) * p.Z : Vector3d.Zero;
        double distance = d.Length;
        if (distance > LeastLimitedDistance)
        {
            writer.UpperLimit(d * (1 / distance), distance, LinearLimit.Value, LinearLimit.Response);
        }
    }

    // One swing locked alone: C = -X1.Z0 (swing about Y) or -X1.Y0 (about Z), the Cardan equation; J = X1 x Z0 or X1 x Y0.
    // Otherwise the rows of RowWriter.Locked. Source: ExtD6Joint.cpp, end of D6JointSolverPrep.
    private void LockedAxes(ref RowWriter writer, in JointFrames f, Vector3d x1)
    {
        int linear = Bit(Linear(X), 0) | Bit(Linear(Y), 1) | Bit(Linear(Z), 2);
        int angular = Bit(Twist, 0) | Bit(Swing(Swing1), 1) | Bit(Swing(Swing2), 2);
        if (angular == 2)
        {
            writer.LockedAngle(Vector3d.Cross(x1, f.Axis0(2)), -Vector3d.Dot(x1, f.Axis0(2)));
            angular = 0;
        }
        else if (angular == 4)
        {
            writer.LockedAngle(Vector3d.Cross(x1, f.Axis0(1)), -Vector3d.Dot(x1, f.Axis0(1)));
            angular = 0;
        }

        writer.Locked(f, linear, angular);
    }

    private static int Bit(AxisMotion motion, int bit) => motion == AxisMotion.Locked ? 1 << bit : 0;
}
