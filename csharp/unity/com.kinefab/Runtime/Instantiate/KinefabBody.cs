using System;
using UnityEngine;

namespace KinefabUnity
{
    /// <summary>
    /// Numbers of the body beside it that Unity takes from scripts only and saves in no scene and no prefab: the fastest it may turn, the
    /// solver's iterations, and before 2022.2 its centre of mass and inertia. Set anew whenever the object comes on.
    /// </summary>
    [AddComponentMenu(""), DisallowMultipleComponent]
    public sealed class KinefabBody : MonoBehaviour
    {
        // maxAngularVelocity of a Rigidbody, maxJointVelocity of a link.
        [SerializeField] private float fastest;
        [SerializeField] private int solverIterations;
        [SerializeField] private int solverVelocityIterations;
#if !UNITY_2022_2_OR_NEWER
        [SerializeField] private Vector3 centerOfMass;
        [SerializeField] private Vector3 inertiaTensor;
        [SerializeField] private Quaternion inertiaTensorRotation;
#endif

        /// <summary>What no scene and no prefab holds in any version: the fastest turn (rad/s), iterations for positions and for velocities.</summary>
        internal static (float, int, int) Unsaved(Rigidbody of) => (of.maxAngularVelocity, of.solverIterations, of.solverVelocityIterations);

        /// <inheritdoc cref="Unsaved(Rigidbody)"/>
        internal static (float, int, int) Unsaved(ArticulationBody of) => (of.maxJointVelocity, of.solverIterations, of.solverVelocityIterations);

        /// <summary>Leaves the component beside a body where a number of it would be lost.</summary>
        /// <param name="body">Set.</param>
        /// <param name="ofNew">What was <see cref="Unsaved(Rigidbody)"/> of it before it was set.</param>
        internal static void Keep(Rigidbody body, (float, int, int) ofNew)
        {
            if (!body.isKinematic && IsLost(Unsaved(body), ofNew))
            {
                Leave(body, Unsaved(body), body.centerOfMass, body.inertiaTensor, body.inertiaTensorRotation);
            }
        }

        /// <inheritdoc cref="Keep(Rigidbody, ValueTuple{float, int, int})"/>
        internal static void Keep(ArticulationBody link, (float, int, int) ofNew)
        {
            if (IsLost(Unsaved(link), ofNew))
            {
                Leave(link, Unsaved(link), link.centerOfMass, link.inertiaTensor, link.inertiaTensorRotation);
            }
        }

#if UNITY_2022_2_OR_NEWER
        private static bool IsLost((float, int, int) unsaved, (float, int, int) ofNew) => !unsaved.Equals(ofNew);
#else
        // Nor is the inertia saved.
        private static bool IsLost((float, int, int) unsaved, (float, int, int) ofNew) => true;
#endif

        private static void Leave(Component beside, (float, int, int) unsaved, Vector3 center, Vector3 inertia, Quaternion principal)
        {
            KinefabBody made = beside.gameObject.AddComponent<KinefabBody>();
            (made.fastest, made.solverIterations, made.solverVelocityIterations) = unsaved;
#if !UNITY_2022_2_OR_NEWER
            (made.centerOfMass, made.inertiaTensor, made.inertiaTensorRotation) = (center, inertia, principal);
#endif
        }

        private void OnEnable()
        {
            if (TryGetComponent(out Rigidbody body))
            {
                body.maxAngularVelocity = fastest;
                body.solverIterations = solverIterations;
                body.solverVelocityIterations = solverVelocityIterations;
#if !UNITY_2022_2_OR_NEWER
                body.centerOfMass = centerOfMass;
                body.inertiaTensor = inertiaTensor;
                body.inertiaTensorRotation = inertiaTensorRotation;
#endif
            }
            else if (TryGetComponent(out ArticulationBody link))
            {
                link.maxJointVelocity = fastest;
                link.solverIterations = solverIterations;
                link.solverVelocityIterations = solverVelocityIterations;
#if !UNITY_2022_2_OR_NEWER
                link.centerOfMass = centerOfMass;
                link.inertiaTensor = inertiaTensor;
                link.inertiaTensorRotation = inertiaTensorRotation;
#endif
            }
        }
    }
}
