using System.IO;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Validation;
using NUnit.Framework.Constraints;
using Constraint = NUnit.Framework.Constraints.Constraint;

namespace Kinefab.NUnit;

/// <summary>A scene without errors; a failure lists every finding with its place and remedy.</summary>
public sealed class ValidSceneConstraint : Constraint
{
    internal ValidSceneConstraint()
    {
    }

    /// <inheritdoc/>
    public override string Description => "a scene without errors";

    /// <inheritdoc/>
    public override ConstraintResult ApplyTo<TActual>(TActual actual) => FaultyFile.Errors(this, actual, ReportOf(actual));

    private static Report ReportOf(object? actual) => actual switch
    {
        string path => ReportOf(SceneFile.Load(path)),
        FileInfo file => ReportOf(SceneFile.Load(file.FullName)),
        SceneReading { Document: null } reading => reading.Report,
        SceneReading { Document: SceneDocument document } => SceneValidator.Validate(document).Report,
        SceneDocument document => SceneValidator.Validate(document).Report,
        SceneValidation validation => validation.Report,
        _ => SceneValidator.Validate(Tested.Scene(actual).Document).Report,
    };
}
