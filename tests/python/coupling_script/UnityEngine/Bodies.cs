using System;

namespace UnityEngine
{
    [Flags]
    public enum RigidbodyConstraints
    {
        None = 0,
        FreezePositionX = 2,
        FreezePositionY = 4,
        FreezePositionZ = 8,
        FreezePosition = 14,
        FreezeRotationX = 16,
        FreezeRotationY = 32,
        FreezeRotationZ = 64,
        FreezeRotation = 112,
        FreezeAll = 126,
    }

    public enum RigidbodyInterpolation
    {
        None = 0,
        Interpolate = 1,
        Extrapolate = 2,
    }

    public enum CollisionDetectionMode
    {
        Discrete = 0,
        Continuous = 1,
        ContinuousDynamic = 2,
        ContinuousSpeculative = 3,
    }

    public sealed partial class Rigidbody : Component
    {
        public float mass { get; set; } = 1;

#if UNITY_6000_0_OR_NEWER
        public float linearDamping { get; set; }

        public float angularDamping { get; set; } = 0.05f;
#else
        public float drag { get; set; }

        public float angularDrag { get; set; } = 0.05f;
#endif

#if UNITY_2022_2_OR_NEWER
        public bool automaticCenterOfMass { get; set; } = true;

        public bool automaticInertiaTensor { get; set; } = true;
#endif

        public Vector3 centerOfMass { get; set; }

        public Vector3 inertiaTensor { get; set; } = new Vector3(1, 1, 1);

        public Quaternion inertiaTensorRotation { get; set; } = new Quaternion(0, 0, 0, 1);

        public bool useGravity { get; set; } = true;

        public bool isKinematic { get; set; }

        public RigidbodyInterpolation interpolation { get; set; }

        public RigidbodyConstraints constraints { get; set; }

        public CollisionDetectionMode collisionDetectionMode { get; set; }

        public float maxAngularVelocity { get; set; } = 7;

        public int solverIterations { get; set; } = 6;

        public int solverVelocityIterations { get; set; } = 1;
    }

    public static class Physics
    {
        public static Vector3 gravity { get; set; } = new Vector3(0, -9.81f, 0);

        public static float bounceThreshold { get; set; } = 2;

        public static int defaultSolverIterations { get; set; } = 6;

        public static int defaultSolverVelocityIterations { get; set; } = 1;

        public static float defaultMaxAngularSpeed { get; set; } = 50;
    }
}
