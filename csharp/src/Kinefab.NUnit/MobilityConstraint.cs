using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using NUnit.Framework.Constraints;
using Constraint = NUnit.Framework.Constraints.Constraint;

namespace Kinefab.NUnit;

/// <summary>Freedoms of finite motion; a failure says which bodies hang together and what each can do.</summary>
public sealed class MobilityConstraint : Constraint
{
    private readonly int _freedoms;

    internal MobilityConstraint(int freedoms) => _freedoms = freedoms;

    /// <inheritdoc/>
    public override string Description => $"mobility {_freedoms}";

    /// <inheritdoc/>
    public override ConstraintResult ApplyTo<TActual>(TActual actual) => FaultyFile.OrResult(this, actual, () => Judge(actual));

    private MechanismResult Judge(object? actual)
    {
        Mechanism mechanism = Tested.Mechanism(actual);
        MobilityReport report = MobilityAnalysis.Of(mechanism);
        bool isSuccess = report.Mobility == _freedoms;
        return new MechanismResult(this, actual, isSuccess, $"mobility {report.Mobility}, {Counted(report.Redundant, "redundant row")}", isSuccess ? null : Lines(mechanism, report));
    }

    private static List<string> Lines(Mechanism mechanism, MobilityReport report)
    {
        IReadOnlyList<GameObject> objects = mechanism.Scene.Document.GameObjects;
        List<string> lines = report.Islands.Select(island =>
            $"mobility {island.Mobility}, {Counted(island.Loops, "loop")}: {string.Join(", ", island.GameObjects.Select(i => objects[i].Id))}").ToList();
        lines.AddRange(report.Bodies.Select(body => $"{objects[body.GameObject].Id}: {Counted(body.Translations, "translation")}, {Counted(body.Rotations, "rotation")}"));
        return lines;
    }

    private static string Counted(int count, string noun) => FormattableString.Invariant($"{count} {noun}{(count == 1 ? "" : "s")}");
}
