// No newer than C# 7: the test of the script that prefabs carry compiles it by Mono, too.
using System;

namespace UnityEngine
{
    public enum ArticulationJointType
    {
        FixedJoint = 0,
        PrismaticJoint = 1,
        RevoluteJoint = 2,
        SphericalJoint = 3,
    }

    public enum ArticulationDofLock
    {
        LockedMotion = 0,
        LimitedMotion = 1,
        FreeMotion = 2,
    }

#if UNITY_2022_2_OR_NEWER
    public enum ArticulationDriveType
    {
        Force = 0,
        Acceleration = 1,
        Target = 2,
        Velocity = 3,
    }

    public enum ArticulationDriveAxis
    {
        X = 0,
        Y = 1,
        Z = 2,
    }
#endif

    public struct ArticulationDrive
    {
        public float lowerLimit, upperLimit, stiffness, damping, forceLimit, target, targetVelocity;

#if UNITY_2022_2_OR_NEWER
        public ArticulationDriveType driveType;
#endif
    }

    public struct ArticulationReducedSpace
    {
        public int dofCount;
        private float _first, _second, _third;

        public ArticulationReducedSpace(float a)
        {
            dofCount = 1;
            _first = a;
            _second = _third = 0;
        }

        public float this[int i]
        {
            get => Has(i) && i == 0 ? _first : i == 1 ? _second : _third;
            set
            {
                float kept = Has(i) ? value : 0;
                _first = i == 0 ? kept : _first;
                _second = i == 1 ? kept : _second;
                _third = i == 2 ? kept : _third;
            }
        }

        private bool Has(int i) => i >= 0 && i < dofCount ? true : throw new IndexOutOfRangeException();
    }

    public sealed class ArticulationBody : Component
    {
        public ArticulationJointType jointType { get; set; }

        public Vector3 anchorPosition { get; set; }

        public Quaternion anchorRotation { get; set; } = new Quaternion(0, 0, 0, 1);

        public Vector3 parentAnchorPosition { get; set; }

        public Quaternion parentAnchorRotation { get; set; } = new Quaternion(0, 0, 0, 1);

        public bool matchAnchors { get; set; } = true;

        public ArticulationDofLock linearLockX { get; set; }

        public ArticulationDofLock linearLockY { get; set; }

        public ArticulationDofLock linearLockZ { get; set; }

        public ArticulationDofLock swingYLock { get; set; }

        public ArticulationDofLock swingZLock { get; set; }

        public ArticulationDofLock twistLock { get; set; }

        public ArticulationDrive xDrive { get; set; } = new ArticulationDrive { forceLimit = float.MaxValue };

        public ArticulationDrive yDrive { get; set; } = new ArticulationDrive { forceLimit = float.MaxValue };

        public ArticulationDrive zDrive { get; set; } = new ArticulationDrive { forceLimit = float.MaxValue };

        public float mass { get; set; } = 1;

        public float linearDamping { get; set; } = 0.05f;

        public float angularDamping { get; set; } = 0.05f;

        public float jointFriction { get; set; } = 0.05f;

        public float maxJointVelocity { get; set; } = 100;

        public Vector3 centerOfMass { get; set; }

        public Vector3 inertiaTensor { get; set; } = new Vector3(1, 1, 1);

        public Quaternion inertiaTensorRotation { get; set; } = new Quaternion(0, 0, 0, 1);

#if UNITY_2022_2_OR_NEWER
        public bool automaticCenterOfMass { get; set; } = true;

        public bool automaticInertiaTensor { get; set; } = true;
#endif

        public bool immovable { get; set; }

        public bool useGravity { get; set; } = true;

        public CollisionDetectionMode collisionDetectionMode { get; set; }

        public int solverIterations { get; set; } = 6;

        public int solverVelocityIterations { get; set; } = 1;

        /// <summary>Radians or metres; the stand-in's owner moves it.</summary>
        public ArticulationReducedSpace jointPosition { get; set; }

        public ArticulationReducedSpace jointVelocity { get; set; }

        public int Woken { get; private set; }

        public void WakeUp() => Woken++;

#if UNITY_2022_2_OR_NEWER
        public void SetDriveTarget(ArticulationDriveAxis axis, float value)
        {
            ArticulationDrive drive = axis == ArticulationDriveAxis.X ? xDrive : axis == ArticulationDriveAxis.Y ? yDrive : zDrive;
            drive.target = value;
            switch (axis)
            {
                case ArticulationDriveAxis.X:
                    xDrive = drive;
                    break;
                case ArticulationDriveAxis.Y:
                    yDrive = drive;
                    break;
                default:
                    zDrive = drive;
                    break;
            }
        }
#endif
    }
}
