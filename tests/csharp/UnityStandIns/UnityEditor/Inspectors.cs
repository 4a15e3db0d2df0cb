using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public enum MessageType
    {
        None = 0,
        Info = 1,
        Warning = 2,
        Error = 3,
    }

    [AttributeUsage(AttributeTargets.Class)]
    public sealed class CustomEditor : Attribute
    {
        public CustomEditor(Type inspectedType)
        {
        }
    }

    public partial class Editor : ScriptableObject
    {
        public Object target { get; internal set; }

        public SerializedObject serializedObject => new SerializedObject(target);

        public virtual void OnInspectorGUI()
        {
        }
    }

    /// <summary>Notes what an inspector shows; <see cref="Set"/> answers for the user.</summary>
    public static partial class EditorGUILayout
    {
        internal static readonly List<string> Shown = new List<string>();
        internal static Func<string, object, object> Set = (label, value) => value;

        public static void HelpBox(string message, MessageType type) => Shown.Add(type + ": " + message);

        public static void LabelField(string label, GUIStyle style) => Shown.Add(label);

        public static float Slider(GUIContent label, float value, float leftValue, float rightValue, params GUILayoutOption[] options)
        {
            Shown.Add(FormattableString.Invariant($"{label.text}: {value} in {leftValue} to {rightValue}"));
            return (float)Answer(label.text, value);
        }

        public static bool Toggle(string label, bool value, params GUILayoutOption[] options) => (bool)Answer(label, value);

        public static Enum EnumPopup(GUIContent label, Enum selected, params GUILayoutOption[] options) => (Enum)Answer(label.text, selected);

        public static bool Foldout(bool foldout, string content, bool toggleOnLabelClick) => (bool)Answer(content, foldout);

        public static bool PropertyField(SerializedProperty property, params GUILayoutOption[] options)
        {
            Shown.Add(property.name);
            return false;
        }

        private static object Answer(string label, object value)
        {
            object set = Set(label, value);
            EditorGUI.Changed |= !Equals(set, value);
            return set;
        }

        public sealed class HorizontalScope : GUI.Scope
        {
            protected override void CloseScope()
            {
            }
        }
    }

    public static partial class EditorGUI
    {
        internal static bool Changed;

        public static void BeginChangeCheck() => Changed = false;

        public static bool EndChangeCheck() => Changed;

        public sealed class DisabledScope : GUI.Scope
        {
            public DisabledScope(bool disabled)
            {
            }

            protected override void CloseScope()
            {
            }
        }
    }

    public static class EditorStyles
    {
        public static GUIStyle boldLabel { get; } = new GUIStyle();
    }

    public static partial class EditorGUIUtility
    {
        public static GUIContent IconContent(string name) => new GUIContent(name);
    }

    public static class EditorPrefs
    {
        private static readonly Dictionary<string, bool> Kept = new Dictionary<string, bool>();

        public static bool GetBool(string key, bool defaultValue) => Kept.TryGetValue(key, out bool value) ? value : defaultValue;

        public static void SetBool(string key, bool value) => Kept[key] = value;
    }
}

namespace UnityEngine
{
    public sealed class GUIStyle
    {
    }

    public sealed class GUILayoutOption
    {
    }

    public sealed class GUIContent
    {
        public GUIContent(string text) => this.text = text;

        public GUIContent(string text, string tooltip)
        {
            this.text = text;
            this.tooltip = tooltip;
        }

        public GUIContent(Texture image, string tooltip)
        {
            this.image = image;
            this.tooltip = tooltip;
        }

        public string text { get; set; } = "";

        public string tooltip { get; set; } = "";

        public Texture image { get; set; }
    }

    public static class GUI
    {
        public static Color color { get; set; } = new Color(1, 1, 1, 1);

        public abstract class Scope : IDisposable
        {
            public void Dispose() => CloseScope();

            protected abstract void CloseScope();
        }
    }

    public static class GUILayout
    {
        internal static string Pressed;

        public static bool Button(string text, params GUILayoutOption[] options) => text == Pressed;
    }
}

namespace UnityEditor
{
    public class SerializedObject
    {
        internal SerializedObject(Object target) => Target = target;

        internal Object Target { get; }

        public void Update()
        {
        }

        public bool ApplyModifiedProperties() => false;

        public SerializedProperty FindProperty(string propertyPath) => new SerializedProperty { name = propertyPath };
    }

    public class SerializedProperty
    {
        public string name { get; internal set; }
    }
}
