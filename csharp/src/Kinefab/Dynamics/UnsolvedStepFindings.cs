using System;
using System.Collections.Generic;
using System.Globalization;
using Kinefab.Diagnostics;
using Kinefab.Joints;

namespace Kinefab.Dynamics;

/// <summary>Names the steps that the exact solver could not solve: each joint once, and no more than <see cref="Most"/> in all.</summary>
internal sealed class UnsolvedStepFindings
{
    /// <summary>Findings of a run; more of them say no more.</summary>
    public const int Most = 10;

    private readonly HashSet<string> _places = new();

    /// <summary>What there is to say of the last step that was not said yet.</summary>
    /// <param name="mechanism">After the step.</param>
    /// <param name="bodies">The world's.</param>
    /// <param name="joints">The world's.</param>
    /// <param name="time">At the start of the step, s.</param>
    public List<Diagnostic> Of(MultibodySystem mechanism, IReadOnlyList<WorldBody> bodies, IReadOnlyList<WorldJoint> joints, double time)
    {
        var found = new List<Diagnostic>();
        foreach (UnsolvedStep step in mechanism.Unsolved)
        {
            // Behind the scene's joints stand those that freeze positions: there the body is what can be named.
            int joint = step.Joint == null ? -1 : Array.IndexOf(mechanism.Joints, step.Joint);
            bool isJoint = joint >= 0 && joint < joints.Count;
            string id = isJoint ? joints[joint].Id : bodies[step.Body].Id;
            string pointer = isJoint
                ? $"/gameObjects/{Text(joints[joint].GameObject)}/components/{Text(joints[joint].Component)}"
                : $"/gameObjects/{Text(bodies[step.Body].GameObject)}";
            if (_places.Count < Most && _places.Add(pointer))
            {
                found.Add(Finding(id, pointer, Reason(step), time));
            }
        }

        return found;
    }

    private static string Reason(in UnsolvedStep step) =>
        step.Joint == null ? "its energy would grow from nothing"
        : double.IsInfinity(step.Error) ? "it comes apart beyond all numbers"
        : FormattableString.Invariant($"it stays open by {step.Error:0.0e+0} {(step.IsAngular ? "rad" : "m")}");

    private static Diagnostic Finding(string id, string pointer, string reason, double time)
    {
        const string code = DiagnosticCodes.StepUnsolved;
        (string Name, string Value)[] values = { ("object", id), ("reason", reason), ("time", time.ToString("0.######", CultureInfo.InvariantCulture)) };
        DiagnosticTable.Entry entry = DiagnosticTable.Entries[code];
        return new Diagnostic(code, entry.Severity, DiagnosticTable.Fill(entry.Message, values), entry.Remedy, pointer, null, null);
    }

    private static string Text(int number) => number.ToString(CultureInfo.InvariantCulture);
}
