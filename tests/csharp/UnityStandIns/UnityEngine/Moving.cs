using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public sealed partial class Rigidbody
    {
        /// <summary>Where the next step takes the body when it is kinematic; null: it stays.</summary>
        internal (Vector3 Position, Quaternion Rotation)? Sent { get; set; }

        internal int Woken { get; private set; }

        public Vector3 angularVelocity { get; set; }

#if UNITY_6000_0_OR_NEWER
        public Vector3 linearVelocity { get; set; }
#else
        public Vector3 velocity { get; set; }
#endif

        public void MovePosition(Vector3 position) => Sent = (position, Sent?.Rotation ?? transform.rotation);

        public void MoveRotation(Quaternion rot) => Sent = (Sent?.Position ?? transform.position, rot);

        public void WakeUp() => Woken++;

        /// <summary>The physics step of a kinematic body.</summary>
        internal void Arrive()
        {
            if (isKinematic && Sent is (Vector3 position, Quaternion rotation))
            {
                transform.SetPositionAndRotation(position, rotation);
            }

            Sent = null;
        }
    }

    public sealed partial class Mesh
    {
        public void GetVertices(List<Vector3> vertices)
        {
            vertices.Clear();
            vertices.AddRange(this.vertices);
        }

        public void GetTriangles(List<int> triangles, int submesh)
        {
            triangles.Clear();
            triangles.AddRange(Readable(_submeshes[submesh]));
        }
    }

    public partial struct Bounds
    {
        public bool IntersectRay(Ray ray, out float distance)
        {
            float[] low = { min.x, min.y, min.z }, high = { max.x, max.y, max.z };
            float[] at = { ray.origin.x, ray.origin.y, ray.origin.z }, along = { ray.direction.x, ray.direction.y, ray.direction.z };
            float first = 0, last = float.PositiveInfinity;
            for (int i = 0; i < 3; i++)
            {
                if (along[i] == 0 && (at[i] < low[i] || at[i] > high[i]))
                {
                    first = float.PositiveInfinity;
                }
                else if (along[i] != 0)
                {
                    float a = (low[i] - at[i]) / along[i], b = (high[i] - at[i]) / along[i];
                    first = Math.Max(first, Math.Min(a, b));
                    last = Math.Min(last, Math.Max(a, b));
                }
            }

            distance = first;
            return first <= last;
        }
    }
}
