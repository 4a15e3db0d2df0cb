using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Rigidbody with its own centre of mass and inertia: Unity's automatic ones depend on colliders.</summary>
public sealed record Rigidbody : Component
{
    internal static readonly FieldNames Fields = new(
        ["type"],
        "mass", "linearDamping", "angularDamping", "centerOfMass", "inertiaTensor", "inertiaTensorRotation",
        "useGravity", "isKinematic", "interpolation", "constraints", "collisionDetectionMode",
        "maxAngularVelocity", "solverIterations", "solverVelocityIterations", "extras");

    /// <summary>Unity's defaults.</summary>
    public Rigidbody()
    {
    }

    internal Rigidbody(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "mass":
                    Mass = json.Number();
                    break;
                case "linearDamping":
                    LinearDamping = json.Number();
                    break;
                case "angularDamping":
                    AngularDamping = json.Number();
                    break;
                case "centerOfMass":
                    CenterOfMass = json.Vector3();
                    break;
                case "inertiaTensor":
                    InertiaTensor = json.Vector3();
                    break;
                case "inertiaTensorRotation":
                    InertiaTensorRotation = json.Quaternion();
                    break;
                case "useGravity":
                    UseGravity = json.Boolean();
                    break;
                case "isKinematic":
                    IsKinematic = json.Boolean();
                    break;
                case "interpolation":
                    Interpolation = json.Word(RigidbodyInterpolationWords.Table);
                    break;
                case "constraints":
                    Constraints = ReadConstraints(ref json);
                    break;
                case "collisionDetectionMode":
                    CollisionDetectionMode = json.Word(CollisionDetectionModeWords.Table);
                    break;
                case "maxAngularVelocity":
                    MaxAngularVelocity = json.Number();
                    break;
                case "solverIterations":
                    SolverIterations = json.Int();
                    break;
                case "solverVelocityIterations":
                    SolverVelocityIterations = json.Int();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

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

    private static RigidbodyConstraints ReadConstraints(ref JsonCursor json)
    {
        var all = RigidbodyConstraints.None;
        foreach (RigidbodyConstraints flag in json.WordSet(RigidbodyConstraintsWords.Table))
            all |= flag;
        return all;
    }

    private protected override string Describe() => Line($"Rigidbody {Mass} kg{(IsKinematic ? ", kinematic" : "")}{(UseGravity ? "" : ", without gravity")}{(Constraints == RigidbodyConstraints.None ? "" : $", {Constraints}")}");
}
