// Links of an articulation in a coupling: as what leads, as what follows, and with a joint on the other side.
using System;
using Kinefab;
using UnityEngine;

public static partial class GearPair
{
    private static class Links
    {
        public static double Run(string how)
        {
            bool slides = how.EndsWith("slides");
            var frame = Body("Frame", true);
            var first = Body("First", false);
            var second = Body("Second", false);
            var lead = Link("Lead", slides);
            var follower = Link("Follower", slides);
            var hinge = Hinge(first, frame, new Vector3(0, 0, 1), new Vector3(0.1f, 0.2f, 0.3f));
            var other = Hinge(second, frame, new Vector3(0, 1, 0), new Vector3(-0.1f, 0.2f, 0.3f));
            bool byJoint = how == "link by a joint", ofJoint = how == "joint by a link";
            ArticulationDrive before = follower.xDrive;
            var coupling = (ofJoint ? second : follower.gameObject).AddComponent<KinefabCoupling>();
            var coordinate = slides ? KinefabCoupling.Coordinate.X : KinefabCoupling.Coordinate.AngularX;
            coupling.driven = ofJoint ? other : null;
            coupling.drivenArticulationBody = ofJoint ? null : follower;
            coupling.drivenCoordinate = ofJoint ? KinefabCoupling.Coordinate.Angle : coordinate;
            coupling.terms = new[]
            {
                new KinefabCoupling.Term
                {
                    joint = byJoint ? hinge : null,
                    articulationBody = byJoint ? null : lead,
                    coordinate = byJoint ? KinefabCoupling.Coordinate.Angle : coordinate,
                    ratio = (float)Ratio,
                },
            };
            double offset = slides ? 0.017 : Offset;
            coupling.offset = (float)offset;
            Call(coupling, "Awake");
            Call(coupling, "OnEnable");
            Call(coupling, "Start");
            Call(coupling, "FixedUpdate"); // no link has a position yet
            double worst = 0;
            for (int i = 1; i <= 1000; i++)
            {
                if (i == 500 && how.EndsWith("recompiled"))
                {
                    Recompiled.Run(coupling);
                }

                double q = slides ? 0.0001 * i : 0.9 * i;
                Follow(first, frame, Turn(new double[] { 0, 0, 1 }, byJoint ? q : 0), hinge);
                Place(lead, byJoint ? 0 : q, slides);
                int woken = follower.Woken;
                Call(coupling, "FixedUpdate");
                double wanted = Ratio * q + offset;
                if (ofJoint)
                {
                    double off = other.spring.targetPosition - wanted;
                    worst = Math.Max(worst, Math.Abs(off - 360 * Math.Round(off / 360)));
                    continue;
                }

                ArticulationDrive drive = follower.xDrive;
                if (drive.stiffness <= 0 || drive.damping <= 0 || drive.forceLimit < 1e38 || drive.targetVelocity != 0)
                {
                    throw new InvalidOperationException("not driven");
                }

                if (follower.Woken == woken)
                {
                    throw new InvalidOperationException("asleep");
                }

                // PhysX's drive knows nothing of turns: it pulls from the position to the target.
                double at = Position(follower, slides);
                double moves = drive.target - at;
                worst = Math.Max(worst, i > 1 && Math.Abs(moves) > 170 ? 1 : 0);
                Place(follower, Unwound(follower, slides) + moves, slides);
                worst = Math.Max(worst, Math.Abs(Unwound(follower, slides) - wanted) * (slides ? 1000 : 1));
            }

            if (how == "links awake")
            {
                int woken = follower.Woken;
                Call(coupling, "FixedUpdate");
                worst = Math.Max(worst, follower.Woken - woken); // nothing moves: it may sleep
            }

            if (!how.StartsWith("links free"))
            {
                return worst;
            }

            ArticulationDrive limited = follower.xDrive;
            limited.upperLimit = 33;
            follower.xDrive = limited;
            if (how.EndsWith("broken"))
            {
                coupling.terms[0].articulationBody = null;
                Call(coupling, "FixedUpdate");
                Call(coupling, "FixedUpdate");
            }
            else
            {
                Call(coupling, "OnDisable");
            }

            before.upperLimit = 33;
            return worst + (before.Equals(follower.xDrive) ? 0 : 1);
        }

        private static ArticulationBody Link(string name, bool slides)
        {
            var link = new GameObject(name).AddComponent<ArticulationBody>();
            link.jointType = slides ? ArticulationJointType.PrismaticJoint : ArticulationJointType.RevoluteJoint;
            link.xDrive = new ArticulationDrive { lowerLimit = -40, upperLimit = 60, stiffness = 3, damping = 0.5f, forceLimit = 12, target = 7, targetVelocity = 9 };
            return link;
        }

        private static readonly System.Collections.Generic.Dictionary<ArticulationBody, double> Turned = new System.Collections.Generic.Dictionary<ArticulationBody, double>();

        private static double Unwound(ArticulationBody link, bool slides) => Turned.TryGetValue(link, out double found) ? found : 0;

        private static double Position(ArticulationBody link, bool slides)
        {
            return link.jointPosition.dofCount == 0 ? 0 : link.jointPosition[0] * (slides ? 1 : 180 / Math.PI);
        }

        // As PhysX 4.1 keeps it: a turn's position within two turns, beyond which it goes on from the other side.
        private static void Place(ArticulationBody link, double value, bool slides)
        {
            Turned[link] = value;
            double kept = slides ? value : value - 720 * Math.Round(value / 720);
            link.jointPosition = new ArticulationReducedSpace((float)(slides ? kept : kept * Math.PI / 180));
        }
    }
}
