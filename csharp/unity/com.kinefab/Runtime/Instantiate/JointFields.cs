using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>
    /// Sets every field of Unity's joints. The bodies stand at the exported pose while this runs: Unity measures all angles and
    /// ways from the pose at which the joint is made.
    /// </summary>
    internal static class JointFields
    {
        internal static void Set(HingeJoint to, Doc.HingeJoint from, GameObject[] objects)
        {
            SetAnchored(to, from, objects);
            to.spring = new JointSpring
            {
                spring = (float)from.Spring.Spring,
                damper = (float)from.Spring.Damper,
                targetPosition = (float)from.Spring.TargetPosition,
            };
            to.useSpring = from.UseSpring;
            to.motor = new JointMotor
            {
                targetVelocity = (float)from.Motor.TargetVelocity,
                force = (float)from.Motor.Force,
                freeSpin = from.Motor.FreeSpin,
            };
            to.useMotor = from.UseMotor;
#if UNITY_2022_2_OR_NEWER
            // Before the limits, which Unity holds to 180 degrees without it.
            to.extendedLimits = from.ExtendedLimits;
            to.useAcceleration = from.UseAcceleration;
#else
            if (from.ExtendedLimits || from.UseAcceleration)
            {
                Debug.LogWarning("extendedLimits and useAcceleration of a HingeJoint need Unity 2022.2.", to);
            }
#endif
            to.limits = new JointLimits
            {
                min = (float)from.Limits.Min,
                max = (float)from.Limits.Max,
                bounciness = (float)from.Limits.Bounciness,
                bounceMinVelocity = (float)from.Limits.BounceMinVelocity,
                contactDistance = (float)from.Limits.ContactDistance,
            };
            to.useLimits = from.UseLimits;
        }

        internal static void Set(ConfigurableJoint to, Doc.ConfigurableJoint from, GameObject[] objects)
        {
            // First what decides how axes and targets are read.
            to.configuredInWorldSpace = from.ConfiguredInWorldSpace;
            to.swapBodies = from.SwapBodies;
            SetAnchored(to, from, objects);
            to.secondaryAxis = SceneObjects.Vector(from.SecondaryAxis);
            to.xMotion = (ConfigurableJointMotion)from.XMotion;
            to.yMotion = (ConfigurableJointMotion)from.YMotion;
            to.zMotion = (ConfigurableJointMotion)from.ZMotion;
            to.angularXMotion = (ConfigurableJointMotion)from.AngularXMotion;
            to.angularYMotion = (ConfigurableJointMotion)from.AngularYMotion;
            to.angularZMotion = (ConfigurableJointMotion)from.AngularZMotion;
            to.linearLimitSpring = Spring(from.LinearLimitSpring);
            to.linearLimit = Limit(from.LinearLimit);
            to.angularXLimitSpring = Spring(from.AngularXLimitSpring);
            to.lowAngularXLimit = Limit(from.LowAngularXLimit);
            to.highAngularXLimit = Limit(from.HighAngularXLimit);
            to.angularYZLimitSpring = Spring(from.AngularYZLimitSpring);
            to.angularYLimit = Limit(from.AngularYLimit);
            to.angularZLimit = Limit(from.AngularZLimit);
            to.targetPosition = SceneObjects.Vector(from.TargetPosition);
            to.targetVelocity = SceneObjects.Vector(from.TargetVelocity);
            to.xDrive = Drive(from.XDrive, to);
            to.yDrive = Drive(from.YDrive, to);
            to.zDrive = Drive(from.ZDrive, to);
            to.targetRotation = SceneObjects.Rotation(from.TargetRotation);
            to.targetAngularVelocity = SceneObjects.Vector(from.TargetAngularVelocity);
            to.rotationDriveMode = (RotationDriveMode)from.RotationDriveMode;
            to.angularXDrive = Drive(from.AngularXDrive, to);
            to.angularYZDrive = Drive(from.AngularYZDrive, to);
            to.slerpDrive = Drive(from.SlerpDrive, to);
            to.projectionMode = (JointProjectionMode)from.ProjectionMode;
            to.projectionDistance = (float)from.ProjectionDistance;
            to.projectionAngle = (float)from.ProjectionAngle;
        }

        // A FixedJoint has no anchor of its own: it holds the pose at which it is made.
        internal static void Set(FixedJoint to, Doc.FixedJoint from, GameObject[] objects)
        {
            Connect(to, from, objects);
            SetCommon(to, from);
        }

        private static void SetAnchored(Joint to, Doc.AnchoredJoint from, GameObject[] objects)
        {
            // A new joint has this on, and then Unity works connectedAnchor out anew whenever the connected body or the anchor is
            // set, and the file's own would be lost. Where the file has it on, it comes on last, and Unity works out the same.
            to.autoConfigureConnectedAnchor = false;
            Connect(to, from, objects);
            to.anchor = SceneObjects.Vector(from.Anchor);
            to.axis = SceneObjects.Vector(from.Axis);
            to.connectedAnchor = SceneObjects.Vector(from.ConnectedAnchor);
            to.autoConfigureConnectedAnchor = from.AutoConfigureConnectedAnchor;
            SetCommon(to, from);
        }

        private static void Connect(Joint to, Doc.Joint from, GameObject[] objects) =>
            to.connectedBody = from.ConnectedBody is int index ? objects[index].GetComponent<Rigidbody>() : null;

        private static void SetCommon(Joint to, Doc.Joint from)
        {
            to.breakForce = (float)from.BreakForce;
            to.breakTorque = (float)from.BreakTorque;
            to.enableCollision = from.EnableCollision;
            to.enablePreprocessing = from.EnablePreprocessing;
            to.massScale = (float)from.MassScale;
            to.connectedMassScale = (float)from.ConnectedMassScale;
        }

        private static SoftJointLimit Limit(Doc.SoftJointLimit from) => new SoftJointLimit
        {
            limit = (float)from.Limit,
            bounciness = (float)from.Bounciness,
            contactDistance = (float)from.ContactDistance,
        };

        private static SoftJointLimitSpring Spring(Doc.SoftJointLimitSpring from) => new SoftJointLimitSpring
        {
            spring = (float)from.Spring,
            damper = (float)from.Damper,
        };

        // A JointDrive made by new has a largest force of 0, which is no drive at all, so that every field is set.
        private static JointDrive Drive(Doc.JointDrive from, Joint joint)
        {
            var drive = new JointDrive
            {
                positionSpring = (float)from.PositionSpring,
                positionDamper = (float)from.PositionDamper,
                maximumForce = SceneObjects.Force(from.MaximumForce),
            };
#if UNITY_2022_2_OR_NEWER
            drive.useAcceleration = from.UseAcceleration;
#else
            if (from.UseAcceleration)
            {
                Debug.LogWarning("useAcceleration of a JointDrive needs Unity 2022.2.", joint);
            }
#endif
            return drive;
        }
    }
}
