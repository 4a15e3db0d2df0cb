using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace UnityEditor
{
    /// <summary>Keeps what was recorded, so that a test can take it back: poses of Transforms, and other objects as Unity stores them.</summary>
    public static class Undo
    {
        internal static readonly List<(string Name, Object[] Objects)> Recorded = new List<(string, Object[])>();

        public static void RecordObject(Object objectToUndo, string name) => RecordObjects(new[] { objectToUndo }, name);

        public static void RecordObjects(Object[] objectsToUndo, string name) => Recorded.Add((name, objectsToUndo.ToArray()));
    }

    public sealed partial class EditorUtility
    {
        internal static readonly HashSet<Object> Dirty = new HashSet<Object>();

        public static void SetDirty(Object target) => Dirty.Add(target);

        public static bool IsPersistent(Object target) => false;
    }

    public static partial class PrefabUtility
    {
        public static bool IsPartOfPrefabInstance(Object componentOrGameObject) => false;

        public static void RecordPrefabInstancePropertyModifications(Object targetObject)
        {
        }
    }
}
