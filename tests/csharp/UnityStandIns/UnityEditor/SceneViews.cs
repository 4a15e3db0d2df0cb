using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    [Flags]
    public enum GizmoType
    {
        Pickable = 1,
        NotInSelectionHierarchy = 2,
        Selected = 4,
        Active = 8,
        InSelectionHierarchy = 16,
        NonSelected = 32,
    }

    [AttributeUsage(AttributeTargets.Method)]
    public sealed class DrawGizmo : Attribute
    {
        public DrawGizmo(GizmoType gizmo)
        {
        }
    }

    /// <summary>Notes the lines that are drawn.</summary>
    public static class Handles
    {
        internal static readonly List<(Color Colour, Vector3 From, Vector3 To, bool IsDotted)> Drawn = new List<(Color, Vector3, Vector3, bool)>();

        public static Color color { get; set; }

        public static void DrawLine(Vector3 p1, Vector3 p2) => Drawn.Add((color, p1, p2, false));

        public static void DrawDottedLine(Vector3 p1, Vector3 p2, float screenSpaceSize) => Drawn.Add((color, p1, p2, true));

        public static void DrawWireCube(Vector3 center, Vector3 size) => Drawn.Add((color, center, size, false));
    }

    public static class HandleUtility
    {
        public static void AddDefaultControl(int controlId)
        {
        }

        public static Ray GUIPointToWorldRay(Vector2 position) => Camera.current.ScreenPointToRay(new Vector3(position.x, position.y, 0));
    }

    public class EditorWindow : ScriptableObject
    {
    }

    public sealed class SceneView : EditorWindow
    {
        public static void RepaintAll()
        {
        }
    }
}

namespace UnityEditor.EditorTools
{
    [AttributeUsage(AttributeTargets.Class)]
    public sealed class EditorToolAttribute : Attribute
    {
        public EditorToolAttribute(string displayName, Type componentToolTarget)
        {
        }
    }

    public abstract class EditorTool : ScriptableObject
    {
        public Object target { get; internal set; }

        public virtual GUIContent toolbarIcon => null;

        public virtual void OnToolGUI(EditorWindow window)
        {
        }
    }

    public static class ToolManager
    {
        public static void SetActiveTool<T>() where T : EditorTool
        {
        }
    }
}

namespace UnityEngine
{
    public enum FocusType
    {
        Keyboard = 1,
        Passive = 2,
    }

    public enum EventType
    {
        MouseDown = 0,
        MouseUp = 1,
        MouseDrag = 3,
        Repaint = 7,
        Layout = 8,
        Used = 12,
    }

    public static class GUIUtility
    {
        public static int hotControl { get; set; }

        public static int GetControlID(FocusType focus) => 1;
    }

    public sealed class Event
    {
        public static Event current { get; set; }

        public EventType type { get; set; }

        public int button { get; set; }

        public bool alt { get; set; }

        public Vector2 mousePosition { get; set; }

        public EventType GetTypeForControl(int controlID) => type;

        public void Use() => type = EventType.Used;
    }
}
