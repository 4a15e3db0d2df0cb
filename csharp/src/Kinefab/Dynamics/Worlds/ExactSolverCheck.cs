using System.Collections.Generic;
using System.Globalization;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Dynamics;

/// <summary>What a scene asks for that the exact solver has no meaning for.</summary>
internal static class ExactSolverCheck
{
    // One joint that sees other masses than the next has no energy to keep: J M^-1 J^T would not be symmetric across joints.
    public static List<Diagnostic> Of(ValidScene scene)
    {
        var found = new List<Diagnostic>();
        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        for (int i = 0; i < objects.Count; i++)
        {
            for (int c = 0; c < objects[i].Components.Count; c++)
            {
                if (objects[i].Components[c] is Joint joint && (joint.MassScale != 1 || joint.ConnectedMassScale != 1))
                {
                    found.Add(Ignored(joint, $"/gameObjects/{Text(i)}/components/{Text(c)}"));
                }
            }
        }

        return found;
    }

    private static Diagnostic Ignored(Joint joint, string pointer)
    {
        const string code = DiagnosticCodes.MassScaleIgnored;
        (string Name, string Value)[] values = { ("own", Text(joint.MassScale)), ("connected", Text(joint.ConnectedMassScale)) };
        DiagnosticTable.Entry entry = DiagnosticTable.Entries[code];
        return new Diagnostic(code, entry.Severity, DiagnosticTable.Fill(entry.Message, values), DiagnosticTable.Fill(entry.Remedy, values), pointer, null, null);
    }

    private static string Text(double number) => number.ToString(CultureInfo.InvariantCulture);
}
