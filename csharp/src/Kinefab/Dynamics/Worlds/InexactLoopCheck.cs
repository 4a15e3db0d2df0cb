using System.Collections.Generic;
using System.Globalization;
using Kinefab.Diagnostics;
using Kinefab.Dynamics.Rattle;

namespace Kinefab.Dynamics;

/// <summary>Names the loops whose axes are a little off.</summary>
internal static class InexactLoopCheck
{
    /// <param name="loops">See <see cref="LoopConsistencyProbe"/>.</param>
    /// <param name="joints">The world's.</param>
    public static IEnumerable<Diagnostic> Of(IEnumerable<InconsistentLoop> loops, WorldJoint[] joints)
    {
        foreach (InconsistentLoop loop in loops)
        {
            if (loop.Consistency != LoopConsistency.Inconsistent)
            {
                continue;
            }

            // Behind the scene's joints stand those that freeze positions.
            var ids = new List<string>();
            foreach (int joint in loop.Joints)
            {
                if (joint < joints.Length && !ids.Contains(joints[joint].Id))
                {
                    ids.Add(joints[joint].Id);
                }
            }

            const string code = DiagnosticCodes.LoopInconsistent;
            (string Name, string Value)[] values = { ("joints", string.Join(", ", ids)) };
            DiagnosticTable.Entry entry = DiagnosticTable.Entries[code];
            WorldJoint first = joints[loop.Joints[0]];
            string pointer = $"/gameObjects/{Text(first.GameObject)}/components/{Text(first.Component)}";
            yield return new Diagnostic(code, entry.Severity, DiagnosticTable.Fill(entry.Message, values), entry.Remedy, pointer, null, null);
        }
    }

    private static string Text(int number) => number.ToString(CultureInfo.InvariantCulture);
}
