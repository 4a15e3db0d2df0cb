namespace Kinefab.NUnit;

/// <summary>What a motion is held against.</summary>
public static class Matches
{
    /// <summary>A motion that was recorded by <c>dotnet kinefab sweep</c> or <c>simulate</c>, NAME.json.</summary>
    /// <param name="path">The file (schemas/trajectory.schema.json).</param>
    /// <returns>The constraint; its tolerance is 1e-6 unless <see cref="TrajectoryConstraint.Within"/> states another.</returns>
    public static TrajectoryConstraint Trajectory(string path) => new(path);
}
