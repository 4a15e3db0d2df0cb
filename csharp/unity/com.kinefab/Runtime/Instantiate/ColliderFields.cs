using System;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>Makes Unity's colliders.</summary>
    internal static class ColliderFields
    {
        /// <summary>Whether it has no size, so that PhysX would make none; one side of a box may be without.</summary>
        internal static bool IsEmpty(Doc.Collider collider)
        {
            switch (collider)
            {
                case Doc.BoxCollider box:
                    double[] sides = { Math.Abs(box.Size.X), Math.Abs(box.Size.Y), Math.Abs(box.Size.Z) };
                    Array.Sort(sides);
                    return sides[1] == 0;
                case Doc.SphereCollider sphere:
                    return sphere.Radius <= 0;
                case Doc.CapsuleCollider capsule:
                    return capsule.Radius <= 0;
                default:
                    return false;
            }
        }

        internal static void Add(Doc.Collider collider, GameObject to, Looks looks)
        {
            switch (collider)
            {
                case Doc.BoxCollider box:
                    Set(to.AddComponent<BoxCollider>(), box, looks);
                    break;
                case Doc.SphereCollider sphere:
                    Set(to.AddComponent<SphereCollider>(), sphere, looks);
                    break;
                case Doc.CapsuleCollider capsule:
                    Set(to.AddComponent<CapsuleCollider>(), capsule, looks);
                    break;
                case Doc.MeshCollider mesh:
                    Set(to.AddComponent<MeshCollider>(), mesh, looks);
                    break;
            }
        }

        private static void Set(BoxCollider to, Doc.BoxCollider from, Looks looks)
        {
            to.center = Numbers.Vector(from.Center);
            to.size = Numbers.Vector(from.Size);
            Common(to, from, looks);
        }

        private static void Set(SphereCollider to, Doc.SphereCollider from, Looks looks)
        {
            to.center = Numbers.Vector(from.Center);
            to.radius = (float)from.Radius;
            Common(to, from, looks);
        }

        private static void Set(CapsuleCollider to, Doc.CapsuleCollider from, Looks looks)
        {
            to.center = Numbers.Vector(from.Center);
            to.radius = (float)from.Radius;
            to.height = (float)from.Height;
            to.direction = (int)from.Direction;
            Common(to, from, looks);
        }

        private static void Set(MeshCollider to, Doc.MeshCollider from, Looks looks)
        {
            // Before the mesh, as a body that moves takes no other; and a trigger has to be convex.
            to.convex = from.Convex;
            to.sharedMesh = looks.Mesh(from.Mesh);
            Common(to, from, looks);
        }

        private static void Common(Collider to, Doc.Collider from, Looks looks)
        {
            to.isTrigger = from.IsTrigger;
            to.enabled = from.Enabled;
            if (from.Material is int material)
            {
                to.sharedMaterial = looks.PhysicsMaterial(material);
            }
        }
    }
}
