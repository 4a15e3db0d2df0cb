// A slide that stands 40 mm from where its anchors meet, as one does whose range is not symmetric: its coordinate is zero there.
using System;
using Kinefab;
using UnityEngine;

public static partial class GearPair
{
    private static class Slide
    {
        private const double Start = 0.04, Ratio = 0.0005, Offset = 0.007;

        // Millimetres, or degrees where the slide leads, that the driven body is off.
        public static double Run(string how)
        {
            var frame = Body("Frame", true);
            var wheel = Body("Wheel", how == "from slide");
            var rack = Body("Rack", how == "moved slide");
            var turning = Hinge(wheel, frame, new Vector3(0, 1, 0), new Vector3(0.1f, 0.2f, 0.3f));
            var sliding = Sliding(rack, frame, how == "swapped slide");
            bool leads = how == "from slide";
            var coupling = (leads ? wheel : rack).AddComponent<KinefabCoupling>();
            coupling.driven = leads ? turning : (Joint)sliding;
            coupling.drivenCoordinate = leads ? KinefabCoupling.Coordinate.Angle : KinefabCoupling.Coordinate.Y;
            var leading = leads ? KinefabCoupling.Coordinate.Y : KinefabCoupling.Coordinate.Angle;
            double ratio = leads ? 1 / Ratio : Ratio, offset = leads ? -Offset / Ratio : Offset;
            coupling.terms = new[] { new KinefabCoupling.Term { joint = leads ? sliding : (Joint)turning, coordinate = leading, ratio = (float)ratio } };
            coupling.offset = (float)offset;
            Call(coupling, "Start");
            double worst = 0;
            for (int i = 1; i <= 1000; i++)
            {
                double q = 0.3 * i, s = Ratio * q + Offset;
                frame.transform.rotation = Turn(new double[] { 0, 0.6, 0.8 }, 0.3 * i);
                frame.transform.position = new Vector3(0.001f * i, 0, -0.002f * i);
                if (leads)
                {
                    Place(rack, frame, s);
                    Call(coupling, "FixedUpdate");
                    double off = Angle(frame.transform.rotation, wheel.transform.rotation) - q;
                    worst = Math.Max(worst, Math.Abs(off - 360 * Math.Round(off / 360)));
                    continue;
                }

                Follow(wheel, frame, Turn(new double[] { 0, 1, 0 }, q), turning);
                Place(rack, frame, 0);
                Call(coupling, "FixedUpdate");
                if (how != "moved slide")
                {
                    double goal = sliding.targetPosition.y; // of the connected anchor in the own frame, the other way round when swapped
                    if (sliding.yDrive.positionSpring <= 0 || sliding.yDrive.maximumForce <= 0)
                    {
                        throw new InvalidOperationException("not driven");
                    }

                    Place(rack, frame, (how == "swapped slide" ? goal : -goal) - Start);
                }

                worst = Math.Max(worst, 1000 * Off(rack, frame, s));
            }

            return worst;
        }

        // A nut that somebody turns and nobody pushes, whose axis passes its origin by: millimetres and degrees that it is off.
        public static double Screw()
        {
            const double Pitch = 0.002 / 360;
            var frame = Body("Frame", true);
            var nut = Body("Nut", true);
            var joint = Sliding(nut, frame, false);
            var coupling = nut.AddComponent<KinefabCoupling>();
            coupling.driven = joint;
            coupling.drivenCoordinate = KinefabCoupling.Coordinate.Y;
            coupling.terms = new[] { new KinefabCoupling.Term { joint = joint, coordinate = KinefabCoupling.Coordinate.AngularY, ratio = (float)Pitch } };
            Call(coupling, "Start");
            double worst = 0;
            for (int i = 1; i <= 1000; i++)
            {
                double q = 1.1 * i;
                frame.transform.rotation = Turn(new double[] { 0, 0.6, 0.8 }, 0.3 * i);
                frame.transform.position = new Vector3(0.001f * i, 0, -0.002f * i);
                nut.transform.rotation = Times(frame.transform.rotation, Turn(new double[] { 0, 0, 1 }, q));
                Call(coupling, "FixedUpdate");
                double[] there = Point(frame.transform.rotation, new Vector3(-0.09f, 0.22f, (float)(0.33 + Pitch * q)));
                double[] here = Point(nut.transform.rotation, joint.anchor);
                Vector3 p = nut.transform.position, o = frame.transform.position;
                double apart = Math.Abs(p.x + here[0] - o.x - there[0]) + Math.Abs(p.y + here[1] - o.y - there[1]) + Math.Abs(p.z + here[2] - o.z - there[2]);
                double[] turned = Point(nut.transform.rotation, new Vector3(1, 0, 0)), wanted = Point(Times(frame.transform.rotation, Turn(new double[] { 0, 0, 1 }, q)), new Vector3(1, 0, 0));
                worst = Math.Max(worst, 1000 * apart);
                worst = Math.Max(worst, 50 * (Math.Abs(turned[0] - wanted[0]) + Math.Abs(turned[1] - wanted[1]) + Math.Abs(turned[2] - wanted[2])));
            }

            return worst;
        }

        // Along +Z of both: y of a joint whose x is +Y.
        private static ConfigurableJoint Sliding(GameObject own, GameObject frame, bool swapped)
        {
            Place(own, frame, 0);
            var joint = own.AddComponent<ConfigurableJoint>();
            joint.autoConfigureConnectedAnchor = false;
            joint.connectedBody = frame.GetComponent<Rigidbody>();
            joint.axis = new Vector3(0, 1, 0);
            joint.secondaryAxis = new Vector3(0, 0, 1);
            joint.anchor = new Vector3(0.01f, 0.02f, 0.03f);
            joint.connectedAnchor = new Vector3(-0.09f, 0.22f, 0.33f - (float)Start);
            joint.swapBodies = swapped;
            return joint;
        }

        private static void Place(GameObject own, GameObject frame, double slid)
        {
            double[] at = Point(frame.transform.rotation, new Vector3(-0.1f, 0.2f, (float)(0.3 + slid)));
            Vector3 o = frame.transform.position;
            own.transform.rotation = frame.transform.rotation;
            own.transform.position = new Vector3((float)(o.x + at[0]), (float)(o.y + at[1]), (float)(o.z + at[2]));
        }

        private static double Off(GameObject own, GameObject frame, double slid)
        {
            double[] at = Point(frame.transform.rotation, new Vector3(-0.1f, 0.2f, (float)(0.3 + slid)));
            Vector3 p = own.transform.position, o = frame.transform.position;
            return Math.Abs(p.x - o.x - at[0]) + Math.Abs(p.y - o.y - at[1]) + Math.Abs(p.z - o.z - at[2]);
        }
    }
}
