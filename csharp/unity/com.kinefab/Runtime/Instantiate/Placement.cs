using System.Collections.Generic;
using UnityEngine;

namespace KinefabUnity
{
    /// <summary>
    /// Where a mechanism is made, for what Unity does not carry along with a parent: anchors in the world, and lengths that it does not multiply by
    /// scale (limits, targets, centres of mass, moments of inertia at the same mass).
    /// </summary>
    internal sealed class Placement
    {
        // Of the sides of a scale, relative.
        private const float Even = 1e-4f;
        private readonly Transform frame;

        /// <param name="frame">Takes the scene's frame into the world; null: they are one.</param>
        /// <param name="findings">Gets what cannot be.</param>
        internal Placement(Transform frame, List<KinefabFinding> findings)
        {
            this.frame = frame;
            Vector3 scale = frame == null ? Vector3.one : frame.lossyScale;
            Scale = scale.x;
            if (!(scale.x > 0) || System.Math.Abs(scale.y - scale.x) > Even * scale.x || System.Math.Abs(scale.z - scale.x) > Even * scale.x)
            {
                findings.Add(KinefabFinding.Of("UNITY_SCALE_UNEVEN", "", ("object", frame.name), ("scale", System.FormattableString.Invariant($"{scale.x}, {scale.y}, {scale.z}"))));
                Scale = 1;
            }
        }

        /// <summary>Of the world's lengths to the file's.</summary>
        internal float Scale { get; }

        internal Vector3 Point(Vector3 p) => frame == null ? p : frame.TransformPoint(p);

        internal Vector3 Direction(Vector3 v) => frame == null ? v : frame.rotation * v;
    }
}
