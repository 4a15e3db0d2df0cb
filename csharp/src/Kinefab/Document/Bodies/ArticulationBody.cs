using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>
/// A link of a tree in reduced coordinates, held to the nearest ArticulationBody above it in the hierarchy; without one it is the root.
/// Zero of its coordinates is the pose in the file.
/// </summary>
[Since(1)]
public sealed partial record ArticulationBody : Component
{
    /// <summary>kg.</summary>
    public double Mass { get; init; } = 1;

    /// <summary>The joint's frame, seen from the link above; metres.</summary>
    public Vector3d ParentAnchorPosition { get; init; }

    /// <summary>The joint's frame, seen from the link above.</summary>
    public Quaterniond ParentAnchorRotation { get; init; } = Quaterniond.Identity;

    /// <summary>The joint's frame in the own one; metres, multiplied by the GameObject's world scale.</summary>
    public Vector3d AnchorPosition { get; init; }

    /// <summary>The joint's frame in the own one.</summary>
    public Quaterniond AnchorRotation { get; init; } = Quaterniond.Identity;

    /// <summary>How it may move against the link above.</summary>
    public ArticulationJointType JointType { get; init; }

    /// <summary>Of a prismatic joint, along X: free unless Limited.</summary>
    public ConfigurableJointMotion LinearLock { get; init; }

    /// <summary>About X, of a revolute or spherical joint; a revolute one is free unless Limited.</summary>
    public ConfigurableJointMotion TwistLock { get; init; }

    /// <summary>About Y, of a spherical joint.</summary>
    public ConfigurableJointMotion SwingYLock { get; init; }

    /// <summary>About Z, of a spherical joint.</summary>
    public ConfigurableJointMotion SwingZLock { get; init; }

    /// <summary>Along X, or about it.</summary>
    public ArticulationDrive XDrive { get; init; } = ArticulationDrive.Default;

    /// <summary>About Y, of a spherical joint.</summary>
    public ArticulationDrive YDrive { get; init; } = ArticulationDrive.Default;

    /// <summary>About Z, of a spherical joint.</summary>
    public ArticulationDrive ZDrive { get; init; } = ArticulationDrive.Default;

    /// <summary>1/s.</summary>
    public double LinearDamping { get; init; }

    /// <summary>1/s.</summary>
    public double AngularDamping { get; init; } = 0.05;

    /// <summary>Share of what the joint transmits that resists its motion.</summary>
    public double JointFriction { get; init; }

    /// <summary>Of each axis, m/s or rad/s; null: PhysX's own 100.</summary>
    public double? MaxJointVelocity { get; init; }

    /// <summary>Local, metres.</summary>
    public Vector3d CenterOfMass { get; init; }

    /// <summary>Principal moments about the centre of mass, kg m^2.</summary>
    public Vector3d InertiaTensor { get; init; } = new(1, 1, 1);

    /// <summary>Local frame from principal axes.</summary>
    public Quaterniond InertiaTensorRotation { get; init; } = Quaterniond.Identity;

    /// <summary>A root that stands still.</summary>
    public bool Immovable { get; init; }

    /// <summary>Whether Physics.gravity acts.</summary>
    public bool UseGravity { get; init; } = true;

    /// <summary>Against passing through other bodies.</summary>
    public CollisionDetectionMode CollisionDetectionMode { get; init; }

    /// <summary>Null: <see cref="Physics.SolverIterations"/>.</summary>
    public int? SolverIterations { get; init; }

    /// <summary>Null: <see cref="Physics.SolverVelocityIterations"/>.</summary>
    public int? SolverVelocityIterations { get; init; }

    /// <summary>Source constraints or joints that its joint comes from.</summary>
    public IReadOnlyList<string> Because { get; init; } = Array.Empty<string>();

    /// <summary>The link as a body by itself.</summary>
    internal Rigidbody AsRigidbody => new()
    {
        Mass = Mass,
        LinearDamping = LinearDamping,
        AngularDamping = AngularDamping,
        CenterOfMass = CenterOfMass,
        InertiaTensor = InertiaTensor,
        InertiaTensorRotation = InertiaTensorRotation,
        UseGravity = UseGravity,
        IsKinematic = Immovable,
        CollisionDetectionMode = CollisionDetectionMode,
        SolverIterations = SolverIterations,
        SolverVelocityIterations = SolverVelocityIterations,
    };

    private protected override string Describe() => Line($"ArticulationBody {Mass} kg, {JointType}{(Immovable ? ", immovable" : "")}{(UseGravity ? "" : ", without gravity")}");
}
