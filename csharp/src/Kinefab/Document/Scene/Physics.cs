using Kinefab.Numerics;

namespace Kinefab.Document;

/// <summary>Unity project settings that the mechanism was made for.</summary>
public sealed partial record Physics : DocumentObject
{
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
