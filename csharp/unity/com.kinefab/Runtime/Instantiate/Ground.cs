using System;
using System.Collections.Generic;
using Kinefab.Validation;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>A part that the settings name as ground: in the scene itself, so that physics and the solver agree about it.</summary>
    internal static class Ground
    {
        /// <summary>The scene with the part's body kinematic, or its articulation's root immovable; as it was where none answers to the name.</summary>
        /// <param name="scene">The file's.</param>
        /// <param name="ground">Name or id of a part; empty: none.</param>
        /// <param name="findings">Gets that nothing of that name can stand still; null: nobody is told.</param>
        internal static ValidScene Apply(ValidScene scene, string ground, List<KinefabFinding> findings)
        {
            if (string.IsNullOrEmpty(ground))
            {
                return scene;
            }

            Doc.SceneDocument document = scene.Document;
            string[] names = ObjectNames.Of(document);
            var objects = new List<Doc.GameObject>(document.GameObjects);
            bool isFound = false;
            for (int i = 0; i < names.Length; i++)
            {
                if ((document.GameObjects[i].Id == ground || names[i] == ground) && scene.BodyOf(i) is int body)
                {
                    isFound |= Hold(scene, objects, body);
                }
            }

            if (isFound && SceneValidator.Validate(document with { GameObjects = objects }).Scene is ValidScene held)
            {
                return held;
            }

            findings?.Add(KinefabFinding.Of("UNITY_GROUND_UNKNOWN", "", ("ground", ground)));
            return scene;
        }

        private static bool Hold(ValidScene scene, List<Doc.GameObject> objects, int body)
        {
            bool isHeld = false;
            var components = new List<Doc.Component>(objects[body].Components);
            for (int c = 0; c < components.Count; c++)
            {
                if (components[c] is Doc.Rigidbody rigid)
                {
                    components[c] = rigid with { IsKinematic = true };
                    isHeld = true;
                }
                else if (components[c] is Doc.ArticulationBody link && scene.IsRootLink(body))
                {
                    components[c] = link with { Immovable = true }; // of others Unity says that it means nothing
                    isHeld = true;
                }
            }

            objects[body] = objects[body] with { Components = components };
            return isHeld;
        }
    }
}
