using System.Globalization;
using UnityEditor;
using UnityEditor.EditorTools;
using UnityEngine;

namespace KinefabUnity.Editing
{
    /// <summary>A slider for each freedom, in the editor with Undo and while the game plays.</summary>
    [CustomEditor(typeof(KinefabMechanism))]
    internal sealed class KinefabMechanismEditor : Editor
    {
        private const int MostSliders = 200;

        private bool _showsEvents;

        /// <inheritdoc/>
        public override void OnInspectorGUI()
        {
            var mechanism = (KinefabMechanism)target;
            if (mechanism.Problem.Length > 0)
            {
                EditorGUILayout.HelpBox(mechanism.Problem, MessageType.Info);
            }

            using (new EditorGUI.DisabledScope(EditorUtility.IsPersistent(mechanism)))
            {
                Sliders(mechanism);
                Mover(mechanism);
            }

            Stop(mechanism);
            EditorGUILayout.LabelField("Shown in the scene view", EditorStyles.boldLabel);
            foreach (MechanismGizmos.Choice choice in new[] { MechanismGizmos.Joints, MechanismGizmos.Closures, MechanismGizmos.Couplings, MechanismGizmos.Islands })
            {
                bool isOn = EditorGUILayout.Toggle(choice.Label, choice.IsOn);
                if (isOn != choice.IsOn)
                {
                    choice.IsOn = isOn;
                    SceneView.RepaintAll();
                }
            }

            Events();
        }

        /// <summary>Moves a freedom as a slider does: so that it can be undone.</summary>
        internal static void Slide(KinefabMechanism mechanism, int freedom, double value)
        {
            MechanismUndo.Record(mechanism, "Move " + mechanism.Freedoms[freedom].Name);
            mechanism.Drive(freedom, value);
            MechanismUndo.Note(mechanism);
        }

        private static void Sliders(KinefabMechanism mechanism)
        {
            for (int i = 0; i < mechanism.Freedoms.Count && i < MostSliders; i++)
            {
                KinefabFreedom freedom = mechanism.Freedoms[i];
                var label = new GUIContent(freedom.Name + " [" + (freedom.IsAngle ? "°" : "m") + "]", freedom.FullName + Range(freedom));
                float value = (float)mechanism.Value(i);

                // An angle that may go round is shown within one turn of the slider, and counted over all.
                float low = Mathf.Min((float)freedom.Low, value), high = Mathf.Max((float)freedom.High, value);
                Color before = GUI.color;
                GUI.color = Color.Lerp(before, MechanismGizmos.OfIsland(freedom.Island), 0.35f);
                EditorGUI.BeginChangeCheck();
                float set = EditorGUILayout.Slider(label, value, low, high);
                bool isSet = EditorGUI.EndChangeCheck();
                GUI.color = before;
                if (isSet)
                {
                    Slide(mechanism, i, set);
                }
            }

            if (mechanism.Freedoms.Count > MostSliders)
            {
                EditorGUILayout.HelpBox((mechanism.Freedoms.Count - MostSliders) + " more freedoms: move them by Drive, or drag their parts.", MessageType.Info);
            }

            if (mechanism.Freedoms.Count > 0)
            {
                using (new EditorGUILayout.HorizontalScope())
                {
                    if (GUILayout.Button("Exported pose"))
                    {
                        MechanismUndo.Record(mechanism, "Exported pose");
                        mechanism.GoHome();
                        MechanismUndo.Note(mechanism);
                    }

                    if (GUILayout.Button("Drag in the scene view"))
                    {
                        ToolManager.SetActiveTool<MechanismDragTool>();
                    }
                }
            }
        }

        private static string Range(KinefabFreedom freedom)
        {
            string End(double value, bool isOpen) => isOpen ? "open" : value.ToString("0.######", CultureInfo.InvariantCulture) + " " + freedom.Unit;
            return ": " + End(freedom.Low, freedom.IsOpenBelow) + " to " + End(freedom.High, freedom.IsOpenAbove);
        }

        private static void Mover(KinefabMechanism mechanism)
        {
            var chosen = (KinefabMover)EditorGUILayout.EnumPopup(new GUIContent("Moved in play by", "In the editor it is always the solver."), mechanism.Mover);
            if (chosen != mechanism.Mover)
            {
                Undo.RecordObject(mechanism, "Mover");
                mechanism.Mover = chosen;
                EditorUtility.SetDirty(mechanism);
                if (PrefabUtility.IsPartOfPrefabInstance(mechanism))
                {
                    PrefabUtility.RecordPrefabInstancePropertyModifications(mechanism);
                }
            }
        }

        private static void Stop(KinefabMechanism mechanism)
        {
            KinefabResult last = mechanism.Last;
            if (last.Stop != KinefabStop.None && last.Stop != KinefabStop.NoMechanism)
            {
                EditorGUILayout.HelpBox(last.ToString(), last.Stop == KinefabStop.NotClosed ? MessageType.Warning : MessageType.Info);
            }
        }

        private void Events()
        {
            _showsEvents = EditorGUILayout.Foldout(_showsEvents, "Events", true);
            if (!_showsEvents)
            {
                return;
            }

            serializedObject.Update();
            foreach (string field in new[] { "onLimit", "onDeadPoint", "onBranch" })
            {
                EditorGUILayout.PropertyField(serializedObject.FindProperty(field));
            }

            serializedObject.ApplyModifiedProperties();
        }
    }
}
