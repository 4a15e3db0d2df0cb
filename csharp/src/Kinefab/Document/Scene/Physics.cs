using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Unity project settings that the mechanism was made for.</summary>
public sealed record Physics : DocumentObject
{
    internal static readonly FieldNames Fields = new(
        [],
        "gravity", "fixedTimestep", "solverIterations", "solverVelocityIterations", "bounceThreshold",
        "defaultMaxAngularSpeed", "extras");

    /// <summary>Unity's defaults.</summary>
    public Physics()
    {
    }

    internal Physics(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "gravity":
                    Gravity = json.Vector3();
                    break;
                case "fixedTimestep":
                    FixedTimestep = json.Number();
                    break;
                case "solverIterations":
                    SolverIterations = json.Int();
                    break;
                case "solverVelocityIterations":
                    SolverVelocityIterations = json.Int();
                    break;
                case "bounceThreshold":
                    BounceThreshold = json.Number();
                    break;
                case "defaultMaxAngularSpeed":
                    DefaultMaxAngularSpeed = json.Number();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Unity's defaults.</summary>
    public static Physics Default { get; } = new();

    /// <summary>Physics.gravity, m/s^2.</summary>
    public Vector3d Gravity { get; init; } = new(0, -9.81, 0);

    /// <summary>Time.fixedDeltaTime, s.</summary>
    public double FixedTimestep { get; init; } = 0.02;

    /// <summary>Physics.defaultSolverIterations.</summary>
    public int SolverIterations { get; init; } = 6;

    /// <summary>Physics.defaultSolverVelocityIterations.</summary>
    public int SolverVelocityIterations { get; init; } = 1;

    /// <summary>Physics.bounceThreshold, m/s.</summary>
    public double BounceThreshold { get; init; } = 2;

    /// <summary>Physics.defaultMaxAngularSpeed, rad/s.</summary>
    public double DefaultMaxAngularSpeed { get; init; } = 7;

    private protected override string Describe() => Line($"gravity {Gravity} m/s^2, step {FixedTimestep} s, {SolverIterations} and {SolverVelocityIterations} iterations");
}
