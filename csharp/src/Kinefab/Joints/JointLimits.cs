namespace Kinefab.Joints;

/// <summary>How a limit answers (PxJointLimitParameters): hard with a bounce, or soft as a one-sided spring.</summary>
internal struct LimitResponse
{
    /// <summary>N/m or N m/rad. Stiffness or damping above 0 makes the limit soft.</summary>
    public double Stiffness;

    /// <summary>N s/m or N m s/rad.</summary>
    public double Damping;

    /// <summary>Speed after the stop as a share of the speed before it, hard limits only.</summary>
    public double Restitution;

    /// <summary>Approach speed below which nothing bounces, m/s or rad/s.</summary>
    public double BounceThreshold;

    /// <summary>Distance at which a hard limit's row comes into being, m or rad.</summary>
    public double ContactDistance;

    /// <summary>A soft limit acts only once it is passed.</summary>
    public readonly bool IsSoft => Stiffness > 0 || Damping > 0;

    /// <summary>As <see cref="ConstraintRow.Bounces"/> of the row that it makes.</summary>
    /// <param name="approach">Speed towards the stop, m/s or rad/s.</param>
    public readonly bool Bounces(double approach) => Restitution > 0 && approach > BounceThreshold;
}

/// <summary>Largest distance over all limited linear axes together: segment, disc or ball (PxJointLinearLimit).</summary>
internal struct LinearLimit
{
    /// <summary>Radius, metres.</summary>
    public double Value;
    public LimitResponse Response;
}

/// <summary>Range of an angle about the joint's X (PxJointAngularLimitPair), radians.</summary>
internal struct AngularLimit
{
    public double Lower;
    public double Upper;
    public LimitResponse Response;
}

/// <summary>Half angles of the elliptic cone in which actor1's X axis may swing (PxJointLimitCone), radians.</summary>
internal struct ConeLimit
{
    /// <summary>Half angle of the narrowest cone, radians: one without width has no axis to turn about.</summary>
    public const double LeastAngle = 1e-4;

    /// <summary>About the joint's Y.</summary>
    public double Y;

    /// <summary>About the joint's Z.</summary>
    public double Z;
    public LimitResponse Response;
}

/// <summary>What a drive prescribes, by whatever force up to its limit.</summary>
internal enum Prescribed : byte
{
    /// <summary>Nothing: it is a spring-damper.</summary>
    Nothing,

    /// <summary>The gap to its goal, which closes at Stiffness / Damping of itself a second.</summary>
    Position,

    /// <summary>Its speed.</summary>
    Speed,
}

/// <summary>A spring-damper towards a target (PxD6JointDrive).</summary>
internal struct DriveModel
{
    /// <summary>N/m or N m/rad; 1/s^2 in acceleration mode.</summary>
    public double Stiffness;

    /// <summary>N s/m or N m s/rad; 1/s in acceleration mode.</summary>
    public double Damping;

    /// <summary>Largest force or torque, N or N m (an impulse when the joint's DriveLimitsAreForces is off).</summary>
    public double ForceLimit;

    /// <summary>Gains are per unit of effective mass of the body pair.</summary>
    public bool IsAcceleration;

    /// <summary>What stands in for the spring-damper where limits are met exactly, see <see cref="JointModel.LimitsFromAfar"/>.</summary>
    public Prescribed Prescribes;

    /// <summary>A drive without gains has no rows.</summary>
    public readonly bool IsActive => Stiffness != 0 || Damping != 0;
}
