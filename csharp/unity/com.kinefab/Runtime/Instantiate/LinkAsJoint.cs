using System;
using System.Collections.Generic;
using Kinefab.Validation;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>What keeps a link on the one above it, as a joint component, and what that holds less of than the link did.</summary>
    internal static class LinkAsJoint
    {
        // As the export has it of a joint: a ConfigurableJoint counts its turns within half a turn to either side.
        private const double HalfTurn = 180;

        private const double Alike = 1e-6;

        /// <summary>A joint without the ranges that it cannot hold, each of which is told.</summary>
        internal static Doc.Joint Of(ValidScene scene, int gameObject, int component, List<KinefabFinding> findings)
        {
            Doc.GameObject owner = scene.Document.GameObjects[gameObject];
            var link = (Doc.ArticulationBody)owner.Components[component];
            Doc.Joint held = scene.Joint(new Doc.JointCoordinate { GameObject = gameObject, Component = component });
            if (!(held is Doc.ConfigurableJoint joint) || link.JointType == Doc.ArticulationJointType.Prismatic)
            {
                return held;
            }

            if (IsLimited(joint.AngularXMotion) && (link.XDrive.LowerLimit < -HalfTurn || link.XDrive.UpperLimit > HalfTurn))
            {
                Tell(link.XDrive, "");
                joint = joint with { AngularXMotion = Doc.ConfigurableJointMotion.Free };
            }

            if (IsLimited(joint.AngularYMotion) && Swing(link.YDrive, "angularY"))
            {
                joint = joint with { AngularYMotion = Doc.ConfigurableJointMotion.Free };
            }

            if (IsLimited(joint.AngularZMotion) && Swing(link.ZDrive, "angularZ"))
            {
                joint = joint with { AngularZMotion = Doc.ConfigurableJointMotion.Free };
            }

            return joint;

            // Whether a swing goes too far for a limit; one that is not alike on both sides gets the larger one.
            bool Swing(Doc.ArticulationDrive range, string freedom)
            {
                bool isTooFar = Math.Max(-range.LowerLimit, range.UpperLimit) >= HalfTurn;
                if (isTooFar || Math.Abs(range.LowerLimit + range.UpperLimit) > Alike)
                {
                    Tell(range, isTooFar ? "" : freedom);
                }

                return isTooFar;
            }

            void Tell(Doc.ArticulationDrive range, string freedom)
            {
                (string, string)[] values =
                {
                    ("joint", joint.Name ?? owner.Id), ("low", Text(range.LowerLimit)), ("high", Text(range.UpperLimit)),
                    ("freedom", freedom), ("half", Text(Math.Max(-range.LowerLimit, range.UpperLimit))),
                };
                findings.Add(KinefabFinding.Of(freedom.Length == 0 ? "JOINT_LIMIT_BEYOND_TURN" : "JOINT_LIMIT_ASYMMETRIC", owner.Id, values));
            }
        }

        private static bool IsLimited(Doc.ConfigurableJointMotion motion) => motion == Doc.ConfigurableJointMotion.Limited;

        private static string Text(double degrees) => degrees.ToString("G6", System.Globalization.CultureInfo.InvariantCulture);
    }
}
