using UnityEditor;
using UnityEditor.EditorTools;
using UnityEngine;

namespace KinefabUnity.Editing
{
    /// <summary>Pulls at parts of the selected mechanism in the scene view; the rest follows. With Undo.</summary>
    [EditorTool("Drag Mechanism", typeof(KinefabMechanism))]
    internal sealed class MechanismDragTool : EditorTool
    {
        private readonly PartDrag _drag = new PartDrag();
        private GUIContent _icon;

        /// <inheritdoc/>
        public override GUIContent toolbarIcon => _icon ?? (_icon = new GUIContent(EditorGUIUtility.IconContent("ViewToolMove").image, "Drag the parts of a mechanism"));

        /// <inheritdoc/>
        public override void OnToolGUI(EditorWindow window)
        {
            Event now = Event.current;
            int control = GUIUtility.GetControlID(FocusType.Passive);
            switch (now.GetTypeForControl(control))
            {
                case EventType.Layout:
                    HandleUtility.AddDefaultControl(control);
                    break;
                case EventType.MouseDown when now.button == 0 && !now.alt:
                    if (Begin(HandleUtility.GUIPointToWorldRay(now.mousePosition), Camera.current.transform.forward))
                    {
                        GUIUtility.hotControl = control;
                        now.Use();
                    }

                    break;
                case EventType.MouseDrag when GUIUtility.hotControl == control:
                    Move(HandleUtility.GUIPointToWorldRay(now.mousePosition));
                    now.Use();
                    break;
                case EventType.MouseUp when GUIUtility.hotControl == control:
                    End();
                    GUIUtility.hotControl = 0;
                    now.Use();
                    break;
                case EventType.Repaint when _drag.Mechanism != null:
                    Handles.color = MechanismGizmos.Colour(JointFigures.Pointer);
                    Handles.DrawDottedLine(_drag.Grasp, _drag.Target, 4);
                    break;
            }
        }

        internal bool Begin(Ray ray, Vector3 forward) => _drag.Begin(ray, forward, (KinefabMechanism)target);

        internal void Move(Ray ray)
        {
            KinefabMechanism mechanism = _drag.Mechanism;
            if (mechanism != null)
            {
                MechanismUndo.Record(mechanism, "Drag " + _drag.Part.name);
                _drag.Move(ray);
                MechanismUndo.Note(mechanism);
            }
        }

        internal void End() => _drag.End();
    }
}
