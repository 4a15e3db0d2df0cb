using System;
using UnityEngine;

namespace KinefabUnity
{
    /// <summary>What becomes of the file's bodies and joints.</summary>
    public enum KinefabPhysics
    {
        /// <summary>As the file has them: Rigidbodies with joints, or ArticulationBodies (kinefab export --physics articulation).</summary>
        AsExported = 0,

        /// <summary>None: parts are moved by KinefabMechanism alone.</summary>
        None = 1,

        /// <summary>Rigidbodies with joints; of links of an articulation a ConfigurableJoint each.</summary>
        Joints = 2,

        /// <summary>
        /// ArticulationBodies: the tree of the joints becomes the hierarchy, what closes a loop stays a joint. As kinefab export --physics articulation makes
        /// them.
        /// </summary>
        Articulation = 3,
    }

    /// <summary>How a <c>.kinefab</c> file becomes objects. There is no scale: the file is in metres, as Unity is.</summary>
    [Serializable]
    public sealed class KinefabSettings
    {
        /// <summary>What becomes of bodies and joints.</summary>
        [Tooltip("As the file has them; none: KinefabMechanism alone moves the parts; joints also in the place of an articulation; articulation also in the place of joints, parts then stand below each other.")]
        public KinefabPhysics physics = KinefabPhysics.AsExported;

        /// <summary>Name or id of a part that stands still; empty: those that the file says.</summary>
        [Tooltip("Name or id of a part that stands still, beside those that the file says.")]
        public string ground = "";

        /// <summary>Whether colliders are made.</summary>
        public bool colliders = true;

        /// <summary>Whether scripts may read the meshes; meshes of colliders stay readable.</summary>
        [Tooltip("Whether scripts may read the meshes; costs their memory twice.")]
        public bool readWrite = true;

        /// <summary>Whether meshes get a second set of texture coordinates for light maps; in the editor only.</summary>
        public bool lightmapUVs;

        /// <summary>Lit material that all surfaces are copies of; null: that of the project's render pipeline.</summary>
        [Tooltip("Lit material that all surfaces are copies of; none: that of the project's render pipeline.")]
        public Material material;
    }
}
