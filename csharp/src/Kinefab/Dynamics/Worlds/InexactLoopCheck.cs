using System.Collections.Generic;
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

            yield return Diagnostic.Of(DiagnosticCodes.LoopInconsistent, joints[loop.Joints[0]].Pointer, ("joints", string.Join(", ", ids)));
        }
    }
}
