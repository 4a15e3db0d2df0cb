using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Mechanisms;
using Kinefab.Validation;

namespace KinefabUnity
{
    /// <summary>Links in the place of a file's bodies and joints, where the settings ask for them: in the scene itself, so that physics and the solver have the same.</summary>
    internal static class Articulation
    {
        /// <summary>The scene with links; as it was where it has some, where none are asked for, or where no articulation holds its joints, which is told.</summary>
        /// <param name="scene">The file's.</param>
        /// <param name="asked">Of the settings.</param>
        /// <param name="findings">Gets what links do not hold; null: nobody is told.</param>
        internal static ValidScene Apply(ValidScene scene, KinefabPhysics asked, List<KinefabFinding> findings)
        {
            if (asked != KinefabPhysics.Articulation)
            {
                return scene;
            }

            ValidScene made = ArticulatedScene.Of(scene, out Report report);
            if (findings != null)
            {
                KinefabFinding.Add(report, findings);
                if (made == null)
                {
                    findings.Add(KinefabFinding.Of("UNITY_PHYSICS_AS_EXPORTED", "", ("has", PhysicsOfFile.Describe(scene.Document))));
                }
            }

            return made ?? scene;
        }
    }
}
