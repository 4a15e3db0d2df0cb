// A joint of two turns that two couplings drive, and a coupling whose terms change while it runs.
using System;
using Kinefab;
using UnityEngine;

public static partial class GearPair
{
    private static class Several
    {
        // Degrees by which the goal is off: each coordinate of the connected frame is twice the angle of its sine and of w.
        public static double Turns(string how)
        {
            var frame = Body("Frame", true);
            var first = Body("First", false);
            var second = Body("Second", false);
            var source = Hinge(first, frame, new Vector3(0, 0, 1), new Vector3(0.1f, 0.2f, 0.3f));
            var joint = Configurable(second, frame);
            joint.swapBodies = how.StartsWith("swapped", StringComparison.Ordinal);
            KinefabCoupling[] both =
            {
                Added(second, joint, KinefabCoupling.Coordinate.AngularY, source, -0.5),
                Added(second, joint, KinefabCoupling.Coordinate.AngularZ, source, 0.8),
            };
            double worst = 0, sense = joint.swapBodies ? 1 : -1;
            for (int i = 1; i <= 1000; i++)
            {
                double q = 0.2 * i; // up to 100 and 160 degrees
                Follow(first, frame, Turn(new double[] { 0, 0, 1 }, q), source);
                foreach (KinefabCoupling coupling in both)
                {
                    Call(coupling, "FixedUpdate");
                }

                Quaternion goal = joint.targetRotation;
                double length = goal.x * goal.x + goal.y * goal.y + goal.z * goal.z + goal.w * goal.w;
                double y = sense * Math.Atan2(goal.y, goal.w) * 360 / Math.PI, z = sense * Math.Atan2(goal.z, goal.w) * 360 / Math.PI;
                worst = Math.Max(worst, Math.Abs(y + 0.5 * q) + Math.Abs(z - 0.8 * q) + Math.Abs(goal.x) + Math.Abs(length - 1));
            }

            Call(both[0], "OnDisable"); // what it drove stands as the joint has it, and the other goes on
            Call(both[1], "FixedUpdate");
            return worst + Math.Abs(joint.targetRotation.y);
        }

        // Degrees: a term that is added counts from where its joint stands then, those that were there go on, and one may go again.
        public static double Terms()
        {
            var frame = Body("Frame", true);
            var first = Body("First", false);
            var second = Body("Second", true);
            var third = Body("Third", false);
            var source = Hinge(first, frame, new Vector3(0, 0, 1), new Vector3(0.1f, 0.2f, 0.3f));
            var other = Hinge(third, frame, new Vector3(1, 0, 0), new Vector3(0.3f, 0.2f, 0.3f));
            var driven = Hinge(second, frame, new Vector3(0, 1, 0), new Vector3(-0.1f, 0.2f, 0.3f));
            KinefabCoupling coupling = Added(second, driven, KinefabCoupling.Coordinate.Angle, source, Ratio);
            KinefabCoupling.Term kept = coupling.terms[0];
            double worst = 0;
            for (int i = 1; i <= 300; i++)
            {
                double q = 0.9 * i, p = 0.3 * i;
                if (i == 100)
                {
                    coupling.terms = new[] { kept, new KinefabCoupling.Term { joint = other, ratio = 4 } };
                }
                else if (i == 200)
                {
                    coupling.terms = new[] { kept };
                }

                Follow(first, frame, Turn(new double[] { 0, 0, 1 }, q), source);
                Follow(third, frame, Turn(new double[] { 1, 0, 0 }, p), other);
                Call(coupling, "FixedUpdate");
                double wanted = Ratio * q + (i >= 100 && i < 200 ? 4 * (p - 30) : 0);
                double off = Angle(frame.transform.rotation, second.transform.rotation) - wanted;
                worst = Math.Max(worst, Math.Abs(off - 360 * Math.Round(off / 360)));
            }

            return worst;
        }

        // Steps in which the driven body was not woken though it has to move, or was though it stands.
        public static double Wakes()
        {
            var frame = Body("Frame", true);
            var first = Body("First", false);
            var second = Body("Second", false);
            var source = Hinge(first, frame, new Vector3(0, 0, 1), new Vector3(0.1f, 0.2f, 0.3f));
            KinefabCoupling coupling = Added(second, Configurable(second, frame), KinefabCoupling.Coordinate.AngularX, source, Ratio);
            var body = second.GetComponent<Rigidbody>();
            int wrong = 0;
            for (int i = 1; i <= 300; i++)
            {
                bool turns = i <= 100 || i > 200;
                Follow(first, frame, Turn(new double[] { 0, 0, 1 }, 0.9 * (turns ? i : 100)), source);
                int before = body.Woken;
                Call(coupling, "FixedUpdate");
                wrong += body.Woken > before == turns ? 0 : 1;
            }

            return wrong;
        }

        private static KinefabCoupling Added(GameObject own, Joint driven, KinefabCoupling.Coordinate coordinate, Joint source, double ratio)
        {
            var coupling = own.AddComponent<KinefabCoupling>();
            coupling.driven = driven;
            coupling.drivenCoordinate = coordinate;
            coupling.terms = new[] { new KinefabCoupling.Term { joint = source, ratio = (float)ratio } };
            Call(coupling, "Start");
            return coupling;
        }
    }
}
