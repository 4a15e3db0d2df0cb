using UnityEngine;

namespace KinefabUnity
{
    /// <summary>One pull at a part, from the press to the release: the grasped point follows the pointer in the plane that faces the eye.</summary>
    internal sealed class PartDrag
    {
        private readonly PartPicker _picker = new PartPicker();
        private KinefabMover _before;
        private Vector3 _point;
        private Vector3 _plane;
        private Vector3 _normal;

        /// <summary>Whose part is pulled; null: none.</summary>
        public KinefabMechanism Mechanism { get; private set; }

        /// <summary>What is pulled.</summary>
        public Transform Part { get; private set; }

        /// <summary>Where the grasped point is now, in the world.</summary>
        public Vector3 Grasp => Part.TransformPoint(_point);

        /// <summary>Where it is pulled to, in the world.</summary>
        public Vector3 Target { get; private set; }

        /// <summary>Takes hold of what a ray meets.</summary>
        /// <param name="ray">From the eye through the pointer.</param>
        /// <param name="forward">Where the eye looks.</param>
        /// <param name="only">Of this mechanism; null: of any.</param>
        /// <returns>False: nothing that moves is there.</returns>
        public bool Begin(Ray ray, Vector3 forward, KinefabMechanism only = null)
        {
            End(); // a release may have gone to another window

            KinefabMechanism found = only;
            Transform part = null;
            float distance = float.PositiveInfinity;
            bool isHit = only == null ? _picker.Pick(ray, out found, out part, out distance) : _picker.TryPick(ray, only, ref part, ref distance);
            if (!isHit || !found.CanDrag(part))
            {
                return false;
            }

            Mechanism = found;
            Part = part;
            _plane = ray.origin + ray.direction * distance;
            _normal = forward;
            _point = part.InverseTransformPoint(_plane);
            Target = _plane;
            _before = found.Mover;
            if (Application.isPlaying && _before == KinefabMover.Physics)
            {
                found.Mover = KinefabMover.Exact;
            }

            return true;
        }

        /// <summary>Pulls to where a ray meets the plane. False: the part is gone, and the pull with it.</summary>
        public bool Move(Ray ray)
        {
            if (Mechanism == null || Part == null || !Mechanism.isActiveAndEnabled)
            {
                End();
                return false;
            }

            float along = Vector3.Dot(ray.direction, _normal);
            if (along * along < 1e-12f)
            {
                return true; // the ray runs along the plane
            }

            float distance = Vector3.Dot(_plane - ray.origin, _normal) / along;
            if (distance > 0)
            {
                Target = ray.origin + ray.direction * distance;
                Mechanism.Drag(Part, _point, Target);
            }

            return true;
        }

        /// <summary>Lets go: physics takes over again where it had the part.</summary>
        public void End()
        {
            if (Mechanism != null && Application.isPlaying)
            {
                Mechanism.Mover = _before;
            }

            Mechanism = null;
            Part = null;
        }
    }
}
