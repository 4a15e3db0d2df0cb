using UnityEditor;
using UnityEngine;

namespace KinefabUnity.Editing
{
    /// <summary>What a move of a mechanism changes, for Undo and for prefab overrides.</summary>
    internal static class MechanismUndo
    {
        /// <summary>Before a move. Moves of one name in one gesture are undone together.</summary>
        public static void Record(KinefabMechanism mechanism, string name)
        {
            if (!Application.isPlaying)
            {
                Undo.RecordObjects(Changed(mechanism), name);
            }
        }

        /// <summary>After it.</summary>
        public static void Note(KinefabMechanism mechanism)
        {
            if (Application.isPlaying)
            {
                return;
            }

            foreach (Object changed in Changed(mechanism))
            {
                EditorUtility.SetDirty(changed);
                if (PrefabUtility.IsPartOfPrefabInstance(changed))
                {
                    PrefabUtility.RecordPrefabInstancePropertyModifications(changed);
                }
            }
        }

        private static Object[] Changed(KinefabMechanism mechanism)
        {
            var changed = new System.Collections.Generic.List<Object> { mechanism };
            changed.AddRange(mechanism.MovingParts());
            return changed.ToArray();
        }
    }
}
