using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Rigidbody with its own centre of mass and inertia: Unity's automatic ones depend on colliders.</summary>
public sealed partial record Rigidbody : Component
{
    /// <summary>kg.</summary>
    public double Mass { get; init; } = 1;

    /// <summary>1/s; <c>drag</c> before Unity 6.</summary>
    public double LinearDamping { get; init; }

    /// <summary>1/s; <c>angularDrag</c> before Unity 6.</summary>
    public double AngularDamping { get; init; } = 0.05;

    /// <summary>Local, metres.</summary>
    public Vector3d CenterOfMass { get; init; }

    /// <summary>Principal moments about the centre of mass, kg m^2.</summary>
    public Vector3d InertiaTensor { get; init; } = new(1, 1, 1);

    /// <summary>Local frame from principal axes.</summary>
    public Quaterniond InertiaTensorRotation { get; init; } = Quaterniond.Identity;

    /// <summary>Whether Physics.gravity acts.</summary>
    public bool UseGravity { get; init; } = true;

    /// <summary>Moved by scripts and animations only: infinite mass to the solver.</summary>
    public bool IsKinematic { get; init; }

    /// <summary>Smoothing between steps.</summary>
    public RigidbodyInterpolation Interpolation { get; init; }

    /// <summary>Frozen motions.</summary>
    public RigidbodyConstraints Constraints { get; init; }

    /// <summary>Against passing through other bodies.</summary>
    public CollisionDetectionMode CollisionDetectionMode { get; init; }

    /// <summary>rad/s; null: <see cref="Physics.DefaultMaxAngularSpeed"/>.</summary>
    public double? MaxAngularVelocity { get; init; }

    /// <summary>Null: <see cref="Physics.SolverIterations"/>.</summary>
    public int? SolverIterations { get; init; }

    /// <summary>Null: <see cref="Physics.SolverVelocityIterations"/>.</summary>
    public int? SolverVelocityIterations { get; init; }

    private protected override string Describe() => Line($"Rigidbody {Mass} kg{(IsKinematic ? ", kinematic" : "")}{(UseGravity ? "" : ", without gravity")}{(Constraints == RigidbodyConstraints.None ? "" : $", {Constraints}")}");
}
