using System.Collections.Generic;
using Kinefab.Numerics;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>
    /// Sets every field of Unity's joints. The bodies stand at the exported pose while this runs: Unity measures all angles and
    /// ways from the pose at which the joint is made.
    /// </summary>
    internal sealed class JointFields
    {
        private readonly GameObject[] objects;
        private readonly Placement placement;
        private readonly List<KinefabFinding> findings;

        /// <param name="objects">In the order of the file; all have their bodies.</param>
        /// <param name="placement">Where they are made.</param>
        /// <param name="findings">Gets what this editor has no field for.</param>
        internal JointFields(GameObject[] objects, Placement placement, List<KinefabFinding> findings)
        {
            this.objects = objects;
            this.placement = placement;
            this.findings = findings;
        }

        internal void Set(HingeJoint to, Doc.HingeJoint from)
        {
            SetAnchored(to, from);
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
                TooOld("extendedLimits and useAcceleration", to);
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

        internal void Set(ConfigurableJoint to, Doc.ConfigurableJoint from)
        {
            // First what decides how axes and targets are read.
            to.configuredInWorldSpace = from.ConfiguredInWorldSpace;
            to.swapBodies = from.SwapBodies;
            SetAnchored(to, from);
            to.secondaryAxis = Direction(from.SecondaryAxis, from.ConfiguredInWorldSpace);
            to.xMotion = (ConfigurableJointMotion)from.XMotion;
            to.yMotion = (ConfigurableJointMotion)from.YMotion;
            to.zMotion = (ConfigurableJointMotion)from.ZMotion;
            to.angularXMotion = (ConfigurableJointMotion)from.AngularXMotion;
            to.angularYMotion = (ConfigurableJointMotion)from.AngularYMotion;
            to.angularZMotion = (ConfigurableJointMotion)from.AngularZMotion;
            to.linearLimitSpring = Spring(from.LinearLimitSpring);
            to.linearLimit = Limit(from.LinearLimit, placement.Scale);
            to.angularXLimitSpring = Spring(from.AngularXLimitSpring);
            to.lowAngularXLimit = Limit(from.LowAngularXLimit);
            to.highAngularXLimit = Limit(from.HighAngularXLimit);
            to.angularYZLimitSpring = Spring(from.AngularYZLimitSpring);
            to.angularYLimit = Limit(from.AngularYLimit);
            to.angularZLimit = Limit(from.AngularZLimit);
            to.targetPosition = Numbers.Vector(from.TargetPosition) * placement.Scale;
            to.targetVelocity = Numbers.Vector(from.TargetVelocity) * placement.Scale;
            to.xDrive = Drive(from.XDrive, to);
            to.yDrive = Drive(from.YDrive, to);
            to.zDrive = Drive(from.ZDrive, to);
            to.targetRotation = Numbers.Rotation(from.TargetRotation);
            to.targetAngularVelocity = Numbers.Vector(from.TargetAngularVelocity);
            to.rotationDriveMode = (RotationDriveMode)from.RotationDriveMode;
            to.angularXDrive = Drive(from.AngularXDrive, to);
            to.angularYZDrive = Drive(from.AngularYZDrive, to);
            to.slerpDrive = Drive(from.SlerpDrive, to);
            to.projectionMode = (JointProjectionMode)from.ProjectionMode;
            to.projectionDistance = (float)from.ProjectionDistance * placement.Scale;
            to.projectionAngle = (float)from.ProjectionAngle;
        }

        // A FixedJoint has no anchor of its own: it holds the pose at which it is made.
        internal void Set(FixedJoint to, Doc.FixedJoint from)
        {
            Connect(to, from);
            SetCommon(to, from);
        }

        private void SetAnchored(Joint to, Doc.AnchoredJoint from)
        {
            // A new joint has this on, and then Unity works connectedAnchor out anew whenever the connected body or the anchor is
            // set, and the file's own would be lost. Where the file has it on, it comes on last, and Unity works out the same.
            to.autoConfigureConnectedAnchor = false;
            Connect(to, from);
            to.anchor = Numbers.Vector(from.Anchor);
            to.axis = Direction(from.Axis, from is Doc.ConfigurableJoint joint && joint.ConfiguredInWorldSpace);
            Vector3 connected = Numbers.Vector(from.ConnectedAnchor);
            to.connectedAnchor = from.ConnectedBody == null ? placement.Point(connected) : connected;
            to.autoConfigureConnectedAnchor = from.AutoConfigureConnectedAnchor;
            SetCommon(to, from);
        }

        // A joint's other side is a body or a link of an articulation.
        private void Connect(Joint to, Doc.Joint from)
        {
            if (from.ConnectedBody is int index)
            {
                to.connectedBody = objects[index].GetComponent<Rigidbody>();
                to.connectedArticulationBody = objects[index].GetComponent<ArticulationBody>();
            }
        }

        private static void SetCommon(Joint to, Doc.Joint from)
        {
            to.breakForce = (float)from.BreakForce;
            to.breakTorque = (float)from.BreakTorque;
            to.enableCollision = from.EnableCollision;
            to.enablePreprocessing = from.EnablePreprocessing;
            to.massScale = (float)from.MassScale;
            to.connectedMassScale = (float)from.ConnectedMassScale;
        }

        private Vector3 Direction(Vector3d from, bool isOfWorld) => isOfWorld ? placement.Direction(Numbers.Vector(from)) : Numbers.Vector(from);

        // lengths: of a limit in metres.
        private static SoftJointLimit Limit(Doc.SoftJointLimit from, float lengths = 1) => new SoftJointLimit
        {
            limit = (float)from.Limit * lengths,
            bounciness = (float)from.Bounciness,
            contactDistance = (float)from.ContactDistance * lengths,
        };

        private static SoftJointLimitSpring Spring(Doc.SoftJointLimitSpring from) => new SoftJointLimitSpring
        {
            spring = (float)from.Spring,
            damper = (float)from.Damper,
        };

        // A JointDrive made by new has a largest force of 0, which is no drive at all, so that every field is set.
        private JointDrive Drive(Doc.JointDrive from, Joint joint)
        {
            var drive = new JointDrive
            {
                positionSpring = (float)from.PositionSpring,
                positionDamper = (float)from.PositionDamper,
                maximumForce = Numbers.Force(from.MaximumForce),
            };
#if UNITY_2022_2_OR_NEWER
            drive.useAcceleration = from.UseAcceleration;
#else
            if (from.UseAcceleration)
            {
                TooOld("useAcceleration of a drive", joint);
            }
#endif
            return drive;
        }

#if !UNITY_2022_2_OR_NEWER
        private void TooOld(string field, Joint joint) =>
            findings.Add(KinefabFinding.Of("UNITY_FIELD_NEWER", "", ("field", field), ("object", joint.name), ("editor", "2022.2")));
#endif
    }
}
