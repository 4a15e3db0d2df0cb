using System;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public static partial class EditorGUILayout
    {
        public static Object ObjectField(string label, Object obj, Type objType, bool allowSceneObjects, params GUILayoutOption[] options) => (Object)Answer(label, obj);

        public static bool PropertyField(SerializedProperty property, bool includeChildren, params GUILayoutOption[] options) => PropertyField(property);
    }
}

namespace UnityEditor.AssetImporters
{
    public abstract class AssetImporterEditor : Editor
    {
        internal bool IsClosed { get; private set; }

        protected void ApplyRevertGUI() => IsClosed = true;
    }

    public class ScriptedImporterEditor : AssetImporterEditor
    {
    }
}
