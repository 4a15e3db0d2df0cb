using Kinefab.Numerics;
using Kinefab.Validation;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>
    /// Makes Unity objects of a Kinefab scene: hierarchy, bodies, joints, colliders, meshes and materials. The numbers go over as
    /// they are, since the file is in Unity's frame and units already. Couplings and animations are not made: Unity has no
    /// component for the first.
    /// </summary>
    /// <remarks>
    /// Call it when the game starts. Unity stores neither solver iterations nor largest speeds in scenes and prefabs, before
    /// 2022.2 neither centres of mass nor inertias, and a joint's zero is the pose at which the joint is made.
    /// </remarks>
    internal static class SceneObjects
    {
        // As Unity's Inspector has it: PhysX refuses a drive whose largest force is infinite.
        private const float Unlimited = 3.4028233e38f;

        /// <summary>Makes the objects of a scene.</summary>
        /// <param name="scene">From ValidScene.Load(path).</param>
        /// <param name="material">Lit material of the project's render pipeline, copied for each surface; null: the Standard shader's.</param>
        /// <param name="parent">Where the scene's roots go; null: to the top of the hierarchy. Its scale should be one.</param>
        /// <returns>The objects in the order of the file, so that the file's indices hold.</returns>
        /// <exception cref="System.NotSupportedException">The scene has ArticulationBodies.</exception>
        public static GameObject[] Import(ValidScene scene, Material material = null, Transform parent = null)
        {
            Doc.SceneDocument document = scene.Document;
            RefuseLinks(document);
            var objects = new GameObject[document.GameObjects.Count];

            // Every pose comes before any body: PhysX takes a body's pose when the body is made.
            for (int i = 0; i < objects.Length; i++)
            {
                Doc.GameObject from = document.GameObjects[i];
                objects[i] = new GameObject(from.Name);
                Place(objects[i].transform, from.Parent is int above ? objects[above].transform : parent, from.Transform);
            }

            // Every body comes before any joint: a joint's connected body may stand further down.
            for (int i = 0; i < objects.Length; i++)
            {
                if (scene.Body(i) is Doc.Rigidbody body)
                {
                    Set(objects[i].AddComponent<Rigidbody>(), body, document.Physics);
                }
            }

            var surfaces = new Surfaces(scene, material);
            for (int i = 0; i < objects.Length; i++)
            {
                foreach (Doc.Component component in document.GameObjects[i].Components)
                {
                    Add(component, objects[i], objects, surfaces);
                }
            }

            // Last, when all joints know their bodies.
            for (int i = 0; i < objects.Length; i++)
            {
                objects[i].SetActive(document.GameObjects[i].Active);
            }

            if (document.Couplings.Count > 0)
            {
                Debug.LogWarning($"{document.Couplings.Count} couplings (gears, belts, racks, screws) have no component in Unity and are left out.");
            }

            return objects;
        }

        /// <summary>Sets the project to what the mechanism was made for: gravity, time step, solver.</summary>
        public static void ApplyProjectSettings(ValidScene scene)
        {
            Doc.Physics from = scene.Document.Physics;
            Physics.gravity = Vector(from.Gravity);
            Physics.bounceThreshold = (float)from.BounceThreshold;
            Physics.defaultSolverIterations = from.SolverIterations;
            Physics.defaultSolverVelocityIterations = from.SolverVelocityIterations;
            Physics.defaultMaxAngularSpeed = (float)from.DefaultMaxAngularSpeed;
            Time.fixedDeltaTime = (float)from.FixedTimestep;
        }

        private static void Place(Transform to, Transform parent, Doc.Transform from)
        {
            to.SetParent(parent, worldPositionStays: false);
            to.localPosition = Vector(from.LocalPosition);
            to.localRotation = Rotation(from.LocalRotation);
            to.localScale = Vector(from.LocalScale);
        }

        // As Rigidbodies links would fall apart.
        private static void RefuseLinks(Doc.SceneDocument document)
        {
            foreach (Doc.GameObject from in document.GameObjects)
            {
                foreach (Doc.Component component in from.Components)
                {
                    if (component is Doc.ArticulationBody)
                    {
                        throw new System.NotSupportedException($"{from.Id} is a link: articulations come into Unity by a prefab, kinefab export -o NAME.prefab --physics articulation.");
                    }
                }
            }
        }

        private static void Set(Rigidbody to, Doc.Rigidbody from, Doc.Physics project)
        {
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
            to.centerOfMass = Vector(from.CenterOfMass);
            to.inertiaTensor = Vector(from.InertiaTensor);
            to.inertiaTensorRotation = Rotation(from.InertiaTensorRotation);
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
        }

        private static void Add(Doc.Component component, GameObject to, GameObject[] objects, Surfaces surfaces)
        {
            switch (component)
            {
                case Doc.HingeJoint hinge:
                    JointFields.Set(to.AddComponent<HingeJoint>(), hinge, objects);
                    break;
                case Doc.ConfigurableJoint configurable:
                    JointFields.Set(to.AddComponent<ConfigurableJoint>(), configurable, objects);
                    break;
                case Doc.FixedJoint rigid:
                    JointFields.Set(to.AddComponent<FixedJoint>(), rigid, objects);
                    break;
                case Doc.BoxCollider box:
                    Set(to.AddComponent<BoxCollider>(), box);
                    break;
                case Doc.SphereCollider sphere:
                    Set(to.AddComponent<SphereCollider>(), sphere);
                    break;
                case Doc.CapsuleCollider capsule:
                    Set(to.AddComponent<CapsuleCollider>(), capsule);
                    break;
                case Doc.MeshCollider mesh:
                    Set(to.AddComponent<MeshCollider>(), mesh, surfaces);
                    break;
                case Doc.MeshFilter filter:
                    to.AddComponent<MeshFilter>().sharedMesh = surfaces.Mesh(filter.Mesh);
                    break;
                case Doc.MeshRenderer renderer:
                    Set(to.AddComponent<MeshRenderer>(), renderer, surfaces);
                    break;
            }
        }

        private static void Set(BoxCollider to, Doc.BoxCollider from)
        {
            to.center = Vector(from.Center);
            to.size = Vector(from.Size);
            Common(to, from);
        }

        private static void Set(SphereCollider to, Doc.SphereCollider from)
        {
            to.center = Vector(from.Center);
            to.radius = (float)from.Radius;
            Common(to, from);
        }

        private static void Set(CapsuleCollider to, Doc.CapsuleCollider from)
        {
            to.center = Vector(from.Center);
            to.radius = (float)from.Radius;
            to.height = (float)from.Height;
            to.direction = (int)from.Direction;
            Common(to, from);
        }

        private static void Set(MeshCollider to, Doc.MeshCollider from, Surfaces surfaces)
        {
            // Before the mesh, as a body that moves takes no other; and a trigger has to be convex.
            to.convex = from.Convex;
            to.sharedMesh = surfaces.Mesh(from.Mesh);
            Common(to, from);
        }

        private static void Common(Collider to, Doc.Collider from)
        {
            to.isTrigger = from.IsTrigger;
            to.enabled = from.Enabled;
        }

        private static void Set(MeshRenderer to, Doc.MeshRenderer from, Surfaces surfaces)
        {
            var materials = new Material[from.Materials.Count];
            for (int i = 0; i < materials.Length; i++)
            {
                materials[i] = surfaces.Material(from.Materials[i]);
            }

            to.sharedMaterials = materials;
            to.enabled = from.Enabled;
        }

        internal static Vector3 Vector(Vector3d v) => new Vector3((float)v.X, (float)v.Y, (float)v.Z);

        // The file's quaternions may be off unit length by 1e-4, which Unity says is no rotation.
        internal static Quaternion Rotation(Quaterniond q)
        {
            Quaterniond unit = q.Normalized();
            return new Quaternion((float)unit.X, (float)unit.Y, (float)unit.Z, (float)unit.W);
        }

        internal static float Force(double value) => value > Unlimited ? Unlimited : (float)value;
    }
}
