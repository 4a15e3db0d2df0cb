using System;
using System.Collections.Generic;
using UnityEngine;

namespace KinefabUnity
{
    /// <summary>What of the mechanisms a ray meets first: by the drawn triangles, so that no collider is needed.</summary>
    internal sealed class PartPicker
    {
        private readonly List<MeshFilter> _filters = new List<MeshFilter>();
        private readonly List<Vector3> _vertices = new List<Vector3>();
        private readonly List<int> _triangles = new List<int>();

        /// <summary>The nearest hit among all mechanisms that are switched on, also of parts that cannot move: they hide what is behind them.</summary>
        /// <param name="ray">In the world.</param>
        /// <param name="mechanism">Whose part is met; null: none.</param>
        /// <param name="part">The object that is met.</param>
        /// <param name="distance">Along the ray.</param>
        public bool Pick(Ray ray, out KinefabMechanism mechanism, out Transform part, out float distance)
        {
            mechanism = null;
            part = null;
            distance = float.PositiveInfinity;
            for (int i = 0; i < KinefabMechanism.All.Count; i++)
            {
                KinefabMechanism one = KinefabMechanism.All[i];
                if (TryPick(ray, one, ref part, ref distance))
                {
                    mechanism = one;
                }
            }

            return mechanism != null;
        }

        /// <summary>The nearest hit of one mechanism, if it is nearer than the one before.</summary>
        public bool TryPick(Ray ray, KinefabMechanism mechanism, ref Transform part, ref float distance)
        {
            bool isFound = false;
            mechanism.GetComponentsInChildren(_filters);
            foreach (MeshFilter filter in _filters)
            {
                Renderer renderer = filter.GetComponent<Renderer>();
                if (renderer == null || !renderer.enabled || filter.sharedMesh == null || !renderer.bounds.IntersectRay(ray, out float near))
                {
                    continue;
                }

                if (near < distance && Hit(ray, filter.transform, filter.sharedMesh, near, out float hit) && hit < distance)
                {
                    distance = hit;
                    part = filter.transform;
                    isFound = true;
                }
            }

            return isFound;
        }

        private bool Hit(Ray ray, Transform at, Mesh mesh, float near, out float distance)
        {
            distance = near;
            if (!mesh.isReadable)
            {
                return true; // its box has to do
            }

            // In the mesh's own frame the ray's parameter stays that of the world, as long as the direction is not made a unit again.
            Vector3 origin = at.InverseTransformPoint(ray.origin);
            Vector3 direction = at.InverseTransformVector(ray.direction);
            mesh.GetVertices(_vertices);
            double least = double.PositiveInfinity;
            for (int submesh = 0; submesh < mesh.subMeshCount; submesh++)
            {
                mesh.GetTriangles(_triangles, submesh);
                for (int i = 0; i + 2 < _triangles.Count; i += 3)
                {
                    double hit = Hit(origin, direction, _vertices[_triangles[i]], _vertices[_triangles[i + 1]], _vertices[_triangles[i + 2]]);
                    least = Math.Min(least, hit);
                }
            }

            distance = (float)least;
            return !double.IsPositiveInfinity(least);
        }

        // Moeller and Trumbore 1997, both sides.
        private static double Hit(Vector3 origin, Vector3 direction, Vector3 a, Vector3 b, Vector3 c)
        {
            Vector3 first = b - a, second = c - a, across = Vector3.Cross(direction, second);
            double determinant = Vector3.Dot(first, across);
            if (determinant == 0)
            {
                return double.PositiveInfinity;
            }

            Vector3 from = origin - a, normal = Vector3.Cross(from, first);
            double u = Vector3.Dot(from, across) / determinant;
            double v = Vector3.Dot(direction, normal) / determinant;
            double distance = Vector3.Dot(second, normal) / determinant;
            return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? distance : double.PositiveInfinity;
        }
    }
}
