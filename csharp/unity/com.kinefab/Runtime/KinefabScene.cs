using Kinefab.Diagnostics;
using Kinefab.Validation;
using UnityEngine;

namespace KinefabUnity
{
    /// <summary>A mechanism from a <c>.kinefab</c> file, made while the game runs.</summary>
    public static class KinefabScene
    {
        /// <summary>Makes the objects of a file; what is wrong with it goes to the Console.</summary>
        /// <param name="path">A file NAME.kinefab, its buffers beside it.</param>
        /// <param name="parent">Where the mechanism goes; null: to the top of the hierarchy.</param>
        /// <returns>The root, which holds all objects; null where the file has errors.</returns>
        public static GameObject Instantiate(string path, Transform parent = null)
        {
            try
            {
                return Make(ValidScene.Load(path), parent);
            }
            catch (SceneFormatException fault)
            {
                Debug.LogWarning(fault.Message);
                return null;
            }
        }

        private static GameObject Make(ValidScene scene, Transform parent)
        {
            var root = new GameObject("Kinefab");
            root.transform.SetParent(parent, worldPositionStays: false);
            SceneObjects.Import(scene, parent: root.transform);
            return root;
        }
    }
}
