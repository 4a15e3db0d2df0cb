using System;
using System.Collections.Generic;

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
        /// <summary>Its Transform was set after the body was there: PhysX made it at another place.</summary>
        internal bool MovedAfterMade { get; set; }

        /// <summary>Where PhysX has it; null: it is switched off.</summary>
        internal (Vector3 Position, Quaternion Rotation)? InPhysics { get; private set; }

        internal void Sync()
        {
            if (!IsDestroyed)
            {
                InPhysics = gameObject.activeInHierarchy ? ((Vector3, Quaternion)?)(transform.position, transform.rotation) : null;
            }
        }

        private Vector3 _inertiaTensor = new Vector3(1, 1, 1);

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

        public Vector3 inertiaTensor
        {
            get => _inertiaTensor;
            set => _inertiaTensor = value.x > 0 && value.y > 0 && value.z > 0 ? value : throw new ArgumentException("Unity refuses moments that are not above zero.");
        }

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

#if UNITY_6000_3_OR_NEWER
    public struct IntegrationInfo
    {
        public string name { get; internal set; }

        public bool isFallback { get; internal set; }
    }
#endif

    public static partial class Physics
    {
#if UNITY_6000_3_OR_NEWER
        internal static IntegrationInfo Integration = new IntegrationInfo { name = "PhysX" };

        public static IntegrationInfo GetCurrentIntegrationInfo() => Integration;

#endif
        /// <summary>Bodies whose Transforms were put elsewhere since PhysX was last told.</summary>
        internal static readonly HashSet<Rigidbody> Unsynced = new HashSet<Rigidbody>();

        public static void SyncTransforms()
        {
            foreach (Rigidbody body in Unsynced)
            {
                body.Sync();
            }

            Unsynced.Clear();
        }

        public static Vector3 gravity { get; set; } = new Vector3(0, -9.81f, 0);

        public static float bounceThreshold { get; set; } = 2;

        public static int defaultSolverIterations { get; set; } = 6;

        public static int defaultSolverVelocityIterations { get; set; } = 1;

        public static float defaultMaxAngularSpeed { get; set; } = 50;
    }

#if UNITY_6000_0_OR_NEWER
    public enum PhysicsMaterialCombine
#else
    public enum PhysicMaterialCombine
#endif
    {
        Average = 0,
        Multiply = 1,
        Minimum = 2,
        Maximum = 3,
    }

#if UNITY_6000_0_OR_NEWER
    public sealed class PhysicsMaterial : Object
    {
        public PhysicsMaterial(string name) => this.name = name;

        public PhysicsMaterialCombine frictionCombine { get; set; }

        public PhysicsMaterialCombine bounceCombine { get; set; }
#else
    public sealed class PhysicMaterial : Object
    {
        public PhysicMaterial(string name) => this.name = name;

        public PhysicMaterialCombine frictionCombine { get; set; }

        public PhysicMaterialCombine bounceCombine { get; set; }
#endif

        public float dynamicFriction { get; set; } = 0.6f;

        public float staticFriction { get; set; } = 0.6f;

        public float bounciness { get; set; }
    }

    public partial class Collider : Component
    {
#if UNITY_6000_0_OR_NEWER
        public PhysicsMaterial sharedMaterial { get; set; }
#else
        public PhysicMaterial sharedMaterial { get; set; }
#endif

        public bool enabled { get; set; } = true;

        public bool isTrigger { get; set; }
    }

    public sealed class BoxCollider : Collider
    {
        public Vector3 center { get; set; }

        public Vector3 size { get; set; } = new Vector3(1, 1, 1);
    }

    public sealed class SphereCollider : Collider
    {
        public Vector3 center { get; set; }

        public float radius { get; set; } = 0.5f;
    }

    public sealed class CapsuleCollider : Collider
    {
        public Vector3 center { get; set; }

        public float radius { get; set; } = 0.5f;

        public float height { get; set; } = 1;

        public int direction { get; set; } = 1;
    }

    [Flags]
    public enum MeshColliderCookingOptions
    {
        None = 0,
        CookForFasterSimulation = 2,
        EnableMeshCleaning = 4,
        WeldColocatedVertices = 8,
        UseFastMidphase = 16,
    }

    public sealed class MeshCollider : Collider
    {
        private bool _convex;

        public Mesh sharedMesh { get; set; }

        public MeshColliderCookingOptions cookingOptions { get; set; } = (MeshColliderCookingOptions)30;

        public bool convex
        {
            get => _convex;
            set => _convex = sharedMesh == null ? value : throw new InvalidOperationException("Unity has cooked the other shape already.");
        }
    }
}
