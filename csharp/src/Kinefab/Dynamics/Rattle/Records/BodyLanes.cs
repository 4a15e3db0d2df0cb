namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Where a body's numbers stand in its record (each number is Width lanes wide). World frame unless said; the body frame
/// is that of the centre of mass and principal axes.
/// </summary>
internal static class BodyLanes
{
    /// <summary>Position of the centre of mass at the start of the step, m.</summary>
    public const int X = 0;

    /// <summary>Velocity of the centre of mass, m/s.</summary>
    public const int V = 3;

    /// <summary>Angular momentum about the centre of mass, kg m^2/s; of moving bodies alone.</summary>
    public const int L = 6;

    /// <summary>Rotation at the start of the step, xyzw.</summary>
    public const int Q = 9;

    /// <summary>Position, m, and rotation, xyzw, at the end of the drift.</summary>
    public const int EndX = 13;
    public const int EndQ = 16;

    /// <summary>
    /// Angular velocity, rad/s: the world's before and after a step; in it the drift's mean where scalar rows need it, and of kinematic bodies theirs
    /// throughout.
    /// </summary>
    public const int W = 20;

    /// <summary>Rotation matrix at the end of the drift, row-major.</summary>
    public const int R = 23;

    /// <summary>Inverse mass, 1/kg.</summary>
    public const int InverseMass = 32;

    /// <summary>Inverse principal moments, 1/(kg m^2); 0 for an infinite one.</summary>
    public const int InverseInertia = 33;

    /// <summary>Inverse inertia at the end of the drift, 1/(kg m^2): xx, yy, zz, xy, xz, yz.</summary>
    public const int WorldInverse = 36;

    /// <summary>Gravity and forces over the mass, m/s^2; torques, N m.</summary>
    public const int Acceleration = 42;
    public const int Torque = 45;

    /// <summary>Geometric stiffness under the last impulses against the inertia, 1/s^2.</summary>
    public const int Stiffness = 48;

    /// <summary>Angular momentum in the body's axes while they turn, kg m^2/s, in the order of its <see cref="RotationSplitting"/>.</summary>
    public const int BodyMomentum = 49;

    /// <summary>Principal moments, kg m^2; 0 for an infinite one.</summary>
    public const int Inertia = 52;

    /// <summary>What damping leaves of the linear and of the angular velocity in the step.</summary>
    public const int DampingFactors = 55;

    /// <summary>Largest angular speed, rad/s.</summary>
    public const int MaxAngularSpeed = 57;

    /// <summary>Least inverse principal moment but for infinite moments', 1/(kg m^2); 0 of a body that does not turn.</summary>
    public const int LeastInverseInertia = 58;

    public const int Count = 59;
}
