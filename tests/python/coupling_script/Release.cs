// A joint that a coupling drives no longer has the drives that it had before.
using System;
using System.Linq;
using Kinefab;
using UnityEngine;

public static partial class GearPair
{
    private static class Release
    {
        // How many of the joint's settings are not what they were, or what they should be while it is driven.
        public static double Run(string how)
        {
            var frame = Body("Frame", true);
            var first = Body("First", false);
            var second = Body("Second", false);
            var source = Hinge(first, frame, new Vector3(0, 0, 1), new Vector3(0.1f, 0.2f, 0.3f));
            Joint driven = how.Contains("configurable") ? (Joint)Set(Configurable(second, frame)) : Set(Hinge(second, frame, new Vector3(0, 1, 0), new Vector3(-0.1f, 0.2f, 0.3f)));
            object[] before = Settings(driven);
            var coupling = second.AddComponent<KinefabCoupling>();
            coupling.driven = driven;
            coupling.drivenCoordinate = how.Contains("configurable") ? KinefabCoupling.Coordinate.AngularX : KinefabCoupling.Coordinate.Angle;
            coupling.terms = new[] { new KinefabCoupling.Term { joint = source, ratio = (float)Ratio } };
            coupling.offset = (float)Offset;
            Call(coupling, "Start");
            Call(coupling, "FixedUpdate");
            object[] during = Settings(driven);
            int wrong = before.SequenceEqual(during) ? 1 : 0;
            if (driven is ConfigurableJoint standing && standing.targetAngularVelocity.x != 0)
            {
                wrong++; // its damper would hold it beyond its target
            }

            if (how.Contains("broken"))
            {
                coupling.terms[0].joint = null;
                Call(coupling, "FixedUpdate");
                Call(coupling, "FixedUpdate");
            }
            else
            {
                Call(coupling, "OnDisable");
            }

            wrong += before.Zip(Settings(driven), (a, b) => a.Equals(b) ? 0 : 1).Sum();
            if (!how.Contains("broken"))
            {
                Call(coupling, "FixedUpdate"); // enabled again
                wrong += during.Zip(Settings(driven), (a, b) => a.Equals(b) ? 0 : 1).Sum();
            }

            return wrong;
        }

        private static HingeJoint Set(HingeJoint joint)
        {
            joint.spring = new JointSpring { spring = 3, damper = 4, targetPosition = 5 };
            joint.useMotor = true;
            return joint;
        }

        private static ConfigurableJoint Set(ConfigurableJoint joint)
        {
            joint.targetPosition = new Vector3(1, 2, 3);
            joint.targetVelocity = new Vector3(4, 5, 6);
            joint.targetAngularVelocity = new Vector3(7, 8, 9);
            joint.targetRotation = new Quaternion(0.6f, 0, 0, 0.8f);
            joint.rotationDriveMode = RotationDriveMode.Slerp;
            joint.xDrive = new JointDrive { positionSpring = 6, positionDamper = 7, maximumForce = 8 };
            joint.angularXDrive = new JointDrive { positionSpring = 9, positionDamper = 10, maximumForce = 11 };
            joint.angularYZDrive = new JointDrive { positionSpring = 12, positionDamper = 13, maximumForce = 14 };
            return joint;
        }

        private static object[] Settings(Joint joint)
        {
            return joint.GetType().GetProperties().Where(p => p.CanRead && p.CanWrite).Select(p => p.GetValue(joint, null)).Where(v => v != null).ToArray();
        }
    }
}
