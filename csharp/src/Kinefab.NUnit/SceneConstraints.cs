namespace Kinefab.NUnit;

/// <summary>What <c>Is.ValidScene</c> and <c>Has.Mobility</c> are called where the language has no extension members (before C# 14).</summary>
public static class SceneConstraints
{
    /// <summary>A scene without errors. What is tested is the path of its file, or what <see cref="Document.SceneFile"/> read.</summary>
    public static ValidSceneConstraint Valid => new();

    /// <summary>Freedoms of finite motion, counted from the joints.</summary>
    /// <param name="freedoms">0 or more.</param>
    /// <returns>The constraint.</returns>
    public static MobilityConstraint Mobility(int freedoms) => new(freedoms);
}
