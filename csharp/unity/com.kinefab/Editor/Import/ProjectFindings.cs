using System.Collections.Generic;
using UnityEngine;

namespace KinefabUnity.Editing
{
    /// <summary>What is right in the file and yet not in this project.</summary>
    internal static class ProjectFindings
    {
        internal static void Add(SceneBuilder builder, KinefabSettings settings, List<KinefabFinding> findings)
        {
            if (settings.physics == KinefabPhysics.None)
            {
                return;
            }

            int count = 0;
            string first = "";
            foreach (GameObject made in builder.Objects)
            {
                foreach (Joint joint in made.GetComponents<Joint>())
                {
                    if (joint.connectedBody == null && joint.connectedArticulationBody == null)
                    {
                        first = count == 0 ? made.name : first;
                        count++;
                    }
                }
            }

            if (count > 0)
            {
                findings.Add(KinefabFinding.Of("UNITY_JOINT_OF_WORLD", "", ("count", count.ToString()), ("object", first)));
            }
#if UNITY_6000_3_OR_NEWER
            IntegrationInfo sdk = Physics.GetCurrentIntegrationInfo();
            if (sdk.isFallback)
            {
                findings.Add(KinefabFinding.Of("UNITY_PHYSICS_OFF", "", ("sdk", sdk.name)));
            }
#endif
        }
    }
}
