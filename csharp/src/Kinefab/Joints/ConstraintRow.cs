using System;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>What a row is; the solver reads its constants accordingly (Px1DConstraintFlag).</summary>
[Flags]
internal enum RowFlags : ushort
{
    None = 0,

    /// <summary>Stiffness and Damping hold; otherwise the row is rigid.</summary>
    Spring = 1,

    /// <summary>The spring's gains are divided by the row's response.</summary>
    AccelerationSpring = 2,

    /// <summary>Restitution and BounceThreshold hold.</summary>
    Restitution = 4,

    /// <summary>The error stays in the velocity iterations: a limit not reached yet.</summary>
    KeepBias = 8,

    /// <summary>The row's impulse counts for breaking and for the reported joint force.</summary>
    OutputForce = 16,

    /// <summary>Minimum and maximum are a drive's: forces when the joint says so.</summary>
    HasDriveLimit = 32,

    /// <summary>The row has no linear part.</summary>
    Angular = 64,

    /// <summary>The row comes from a limit (hard or soft); not a PhysX flag.</summary>
    Limit = 128,

    /// <summary>The row comes from a drive, motor or hinge spring; not a PhysX flag.</summary>
    Drive = 256,

    /// <summary>The limit is a cone's; not a PhysX flag.</summary>
    Cone = 512,

    /// <summary>C is to fall at Stiffness of itself a second, and VelocityTarget is that speed where the row is; not a PhysX flag.</summary>
    Motion = 1024,
}

/// <summary>
/// Order in which a joint's rows are solved and whether they are made mass-orthogonal to each other
/// (PxConstraintSolveHint; the values decide the order).
/// </summary>
internal enum SolveHint : ushort
{
    None = 0,
    SlerpSpring = 258,
    Equality = 2048,
    Inequality = 2049,
}

/// <summary>
/// One scalar constraint between two bodies, in the world frame, about the bodies' centres of mass (Px1DConstraint).
/// C = GeometricError; Cdot = Linear0.v0 + Angular0.w0 - Linear1.v1 - Angular1.w1.
/// A rigid row drives C to 0 and Cdot to VelocityTarget with an impulse in [Minimum, Maximum] along +J on body 0 and
/// -J on body 1; a spring row has the force -Stiffness * C + Damping * (VelocityTarget - Cdot).
/// </summary>
internal struct ConstraintRow
{
    public Vector3d Linear0;
    public Vector3d Angular0;
    public Vector3d Angular1;

    /// <summary>No joint moves its bodies along different lines.</summary>
    public readonly Vector3d Linear1 => Linear0;

    /// <summary>C, metres or radians (a half or a sine of an angle where the row's comment says so).</summary>
    public double GeometricError;

    /// <summary>Target of Cdot.</summary>
    public double VelocityTarget;

    /// <summary>Least impulse, N s or N m s; a force when HasDriveLimit is set and the joint's limits are forces.</summary>
    public double Minimum;

    /// <summary>Greatest impulse, as Minimum.</summary>
    public double Maximum;

    /// <summary>Not written unless Spring or Motion is set, nor is Damping unless Spring is.</summary>
    public double Stiffness;
    public double Damping;

    /// <summary>What the way that is left to a goal is multiplied by in C. Not written unless Motion is set.</summary>
    public double Weight;

    /// <summary>Not written unless Restitution is set, nor is BounceThreshold.</summary>
    public double Restitution;
    public double BounceThreshold;
    public RowFlags Flags;
    public SolveHint Hint;

    /// <summary>Whether all of the flags are set.</summary>
    public readonly bool Has(RowFlags flags) => (Flags & flags) == flags;

    /// <summary>Whether it comes from a limit that is no spring.</summary>
    public readonly bool IsHardLimit => Has(RowFlags.Limit) && !Has(RowFlags.Spring);

    /// <summary>Whether the row's limit throws back what comes to it at a speed.</summary>
    /// <param name="approach">At which C falls, m/s or rad/s.</param>
    public readonly bool Bounces(double approach) => Has(RowFlags.Restitution) && approach > BounceThreshold;

    /// <summary>Whether the other row has the same J, to the bit.</summary>
    public readonly bool HasJacobianOf(in ConstraintRow other) =>
        Linear0 == other.Linear0 && Angular0 == other.Angular0 && Angular1 == other.Angular1;

    /// <summary>Cdot for the given velocities of the two centres of mass.</summary>
    public readonly double Velocity(Vector3d v0, Vector3d w0, Vector3d v1, Vector3d w1) =>
        Vector3d.Dot(Linear0, v0) + Vector3d.Dot(Angular0, w0) - Vector3d.Dot(Linear1, v1) - Vector3d.Dot(Angular1, w1);
}
