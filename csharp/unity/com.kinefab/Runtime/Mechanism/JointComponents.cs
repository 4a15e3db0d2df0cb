using Kinefab.Kinematics;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>Which of Unity's joints and links have a mechanism's coordinates.</summary>
    internal static class JointComponents
    {
        /// <summary>The joint or the link that a coordinate is of; null: it is gone, or was never made.</summary>
        /// <param name="mechanism">Whose coordinate it is.</param>
        /// <param name="coordinate">One of its.</param>
        /// <param name="parts">In the order of the file.</param>
        public static Component Of(Mechanism mechanism, MechanismCoordinate coordinate, Transform[] parts)
        {
            Transform part = coordinate.GameObject < parts.Length ? parts[coordinate.GameObject] : null;
            if (part == null)
            {
                return null;
            }

            Doc.GameObject from = mechanism.Scene.Document.GameObjects[coordinate.GameObject];
            ArticulationBody link = part.GetComponent<ArticulationBody>();
            if (from.Components[coordinate.Component] is Doc.ArticulationBody && link != null)
            {
                return link;
            }

            // A link that was imported as a joint has it in its own place; a joint that is switched off has none.
            bool isLinkJoint = link == null && !mechanism.Scene.IsRootLink(coordinate.GameObject);
            int number = 0;
            for (int i = 0; i < coordinate.Component; i++)
            {
                number += from.Components[i] is Doc.Joint { Enabled: true } || (isLinkJoint && from.Components[i] is Doc.ArticulationBody) ? 1 : 0;
            }

            Joint[] joints = part.GetComponents<Joint>();
            return number < joints.Length ? joints[number] : null;
        }
    }
}
