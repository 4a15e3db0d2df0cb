using Kinefab.Numerics;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>Sets every field of Unity's bodies. They are made after all poses are: PhysX takes a body's pose when it is made.</summary>
    internal static class BodyFields
    {
        // kg m^2: Unity refuses moments that are not above zero.
        private const double LeastInertia = 1e-9;
        private const float UnlimitedForce = 3.4028235e38f;

        internal static void Set(Rigidbody to, Doc.Rigidbody from, Doc.Physics project, Placement placement)
        {
            (float, int, int) ofNew = KinefabBody.Unsaved(to);
            to.mass = (float)from.Mass;
#if UNITY_6000_0_OR_NEWER
            to.linearDamping = (float)from.LinearDamping;
            to.angularDamping = (float)from.AngularDamping;
#else
            to.drag = (float)from.LinearDamping;
            to.angularDrag = (float)from.AngularDamping;
#endif
#if UNITY_2022_2_OR_NEWER
            to.automaticCenterOfMass = false;
            to.automaticInertiaTensor = false;
#endif
            // Set once, Unity no longer works them out from the colliders.
            to.centerOfMass = Numbers.Vector(from.CenterOfMass) * placement.Scale;
            to.inertiaTensor = Inertia(from.InertiaTensor * (placement.Scale * (double)placement.Scale));
            to.inertiaTensorRotation = Numbers.Rotation(from.InertiaTensorRotation);
            to.useGravity = from.UseGravity;
            to.isKinematic = from.IsKinematic;
            to.interpolation = (RigidbodyInterpolation)from.Interpolation;
            to.collisionDetectionMode = (CollisionDetectionMode)from.CollisionDetectionMode;

            // The file leaves a number out where it is the project's; that of this project may be another.
            to.maxAngularVelocity = (float)(from.MaxAngularVelocity ?? project.DefaultMaxAngularSpeed);
            to.solverIterations = from.SolverIterations ?? project.SolverIterations;
            to.solverVelocityIterations = from.SolverVelocityIterations ?? project.SolverVelocityIterations;

            // After the inertia, since Unity freezes a rotation by changing it.
            to.constraints = (RigidbodyConstraints)from.Constraints;
            KinefabBody.Keep(to, ofNew);
        }

        internal static void Set(ArticulationBody to, Doc.ArticulationBody from, Doc.Physics project, Placement placement, bool isRoot)
        {
            (float, int, int) ofNew = KinefabBody.Unsaved(to);
            to.mass = (float)from.Mass;
            to.jointType = (ArticulationJointType)from.JointType;

            // Off while the anchors are set, or Unity works the parent's out anew.
            to.matchAnchors = false;
            to.anchorPosition = Numbers.Vector(from.AnchorPosition);
            to.anchorRotation = Numbers.Rotation(from.AnchorRotation);
            to.parentAnchorPosition = Numbers.Vector(from.ParentAnchorPosition);
            to.parentAnchorRotation = Numbers.Rotation(from.ParentAnchorRotation);
            to.matchAnchors = true;
            to.linearLockX = (ArticulationDofLock)from.LinearLock;
            to.linearLockY = ArticulationDofLock.LockedMotion;
            to.linearLockZ = ArticulationDofLock.LockedMotion;
            to.twistLock = (ArticulationDofLock)from.TwistLock;
            to.swingYLock = (ArticulationDofLock)from.SwingYLock;
            to.swingZLock = (ArticulationDofLock)from.SwingZLock;
            bool isSlide = from.JointType == Doc.ArticulationJointType.Prismatic;
            ArticulationDrive along = Drive(from.XDrive, isSlide ? placement.Scale : 1);
            if (isSlide && RunsSlidesBackwards(Application.unityVersion))
            {
                along.targetVelocity = -along.targetVelocity;
            }

            to.xDrive = along;
            to.yDrive = Drive(from.YDrive, 1);
            to.zDrive = Drive(from.ZDrive, 1);
            to.linearDamping = (float)from.LinearDamping;
            to.angularDamping = (float)from.AngularDamping;
            to.jointFriction = (float)from.JointFriction;
            if (from.MaxJointVelocity is double most)
            {
                to.maxJointVelocity = (float)most;
            }
#if UNITY_2022_2_OR_NEWER
            to.automaticCenterOfMass = false;
            to.automaticInertiaTensor = false;
#endif
            to.centerOfMass = Numbers.Vector(from.CenterOfMass) * placement.Scale;
            to.inertiaTensor = Inertia(from.InertiaTensor * (placement.Scale * (double)placement.Scale));
            to.inertiaTensorRotation = Numbers.Rotation(from.InertiaTensorRotation);
            if (isRoot)
            {
                to.immovable = from.Immovable; // of others Unity says that it means nothing
            }

            to.useGravity = from.UseGravity;
            to.collisionDetectionMode = (CollisionDetectionMode)from.CollisionDetectionMode;
            to.solverIterations = from.SolverIterations ?? project.SolverIterations;
            to.solverVelocityIterations = from.SolverVelocityIterations ?? project.SolverVelocityIterations;
            KinefabBody.Keep(to, ofNew);
        }

        /// <summary>
        /// Whether an editor runs slides against their drive's target velocity, as PhysX 4.1 does. Mended with 6000.0.68, 6000.3.9 and
        /// 6000.4 (Unity's UUM-113920); what others do is taken from there, not tried.
        /// </summary>
        internal static bool RunsSlidesBackwards(string editor)
        {
            string[] parts = editor.Split('.');
            int digits = 0;
            while (parts.Length > 2 && digits < parts[2].Length && char.IsDigit(parts[2][digits]))
            {
                digits++;
            }

            if (digits == 0 || !int.TryParse(parts[0], out int year) || !int.TryParse(parts[1], out int stream))
            {
                return false;
            }

            int patch = int.Parse(parts[2].Substring(0, digits), System.Globalization.CultureInfo.InvariantCulture);
            return year < 6000 || (year == 6000 && (stream == 0 ? patch < 68 : stream == 3 ? patch < 9 : stream < 3));
        }

        // lengths: of a slide, whose targets are metres.
        private static ArticulationDrive Drive(Doc.ArticulationDrive from, float lengths)
        {
            var drive = new ArticulationDrive
            {
                lowerLimit = (float)from.LowerLimit * lengths,
                upperLimit = (float)from.UpperLimit * lengths,
                stiffness = (float)from.Stiffness,
                damping = (float)from.Damping,
                forceLimit = from.ForceLimit >= UnlimitedForce ? UnlimitedForce : (float)from.ForceLimit,
                target = (float)from.Target * lengths,
                targetVelocity = (float)from.TargetVelocity * lengths,
            };
#if UNITY_2022_2_OR_NEWER
            drive.driveType = (ArticulationDriveType)from.DriveType;
#endif
            return drive;
        }

        private static Vector3 Inertia(Vector3d moments) =>
            new Vector3(Moment(moments.X), Moment(moments.Y), Moment(moments.Z));

        private static float Moment(double moment) => (float)(moment > 0 ? moment : LeastInertia);
    }
}
