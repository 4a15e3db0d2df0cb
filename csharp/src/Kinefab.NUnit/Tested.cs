using System;
using System.IO;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Validation;

namespace Kinefab.NUnit;

/// <summary>What is tested, as a scene or a mechanism.</summary>
internal static class Tested
{
    /// <summary>The scene.</summary>
    /// <exception cref="Diagnostics.SceneFormatException">The file has errors.</exception>
    /// <exception cref="ArgumentException">It is nothing that holds a scene.</exception>
    public static ValidScene Scene(object? actual) => actual switch
    {
        ValidScene scene => scene,
        Mechanism mechanism => mechanism.Scene,
        string path => ValidScene.Load(path),
        FileInfo file => ValidScene.Load(file.FullName),
        _ => throw Unknown(actual),
    };

    /// <summary>Its mechanism.</summary>
    /// <inheritdoc cref="Scene"/>
    public static Mechanism Mechanism(object? actual) => actual as Mechanism ?? Kinematics.Mechanism.Create(Scene(actual));

    /// <summary>For what holds no scene.</summary>
    public static ArgumentException Unknown(object? actual) => new(
        $"A scene is tested by the path of its file, a ValidScene or a Mechanism, not by {(actual is null ? "null" : actual.GetType().Name)}.", nameof(actual));
}
