using System.Diagnostics;
using Kinefab.Diagnostics;

namespace Kinefab.Validation;

/// <summary>What came of validating a scene.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class SceneValidation
{
    internal SceneValidation(ValidScene? scene, Report report)
    {
        Scene = scene;
        Report = report;
    }

    /// <summary>The scene; null when the report has errors.</summary>
    public ValidScene? Scene { get; }

    /// <summary>What was found.</summary>
    public Report Report { get; }

    /// <summary>Whether the scene is valid, and the findings.</summary>
    public override string ToString() => $"{(Scene is null ? "not valid" : "valid")}; {Report}";
}
