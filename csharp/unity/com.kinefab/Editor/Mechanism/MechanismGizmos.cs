using System.Runtime.CompilerServices;
using Kinefab.Numerics;
using UnityEditor;
using UnityEngine;

namespace KinefabUnity.Editing
{
    /// <summary>Draws the joints, couplings and islands of a selected mechanism in the scene view.</summary>
    internal static class MechanismGizmos
    {
        public static readonly Choice Joints = new Choice("Joints", true);
        public static readonly Choice Closures = new Choice("Closing joints", true);
        public static readonly Choice Couplings = new Choice("Couplings", true);
        public static readonly Choice Islands = new Choice("Islands", false);

        private const float Dots = 4;

        private static readonly ConditionalWeakTable<MotionState, JointFigures> Known = new ConditionalWeakTable<MotionState, JointFigures>();

        public static Color Colour(int rgb) => new Color((rgb >> 16 & 255) / 255f, (rgb >> 8 & 255) / 255f, (rgb & 255) / 255f, 1);

        public static Color OfIsland(int island) =>
            island < 0 ? new Color(0.54f, 0.57f, 0.61f, 1) : Colour(JointFigures.Islands[island % JointFigures.Islands.Length]);

        [DrawGizmo(GizmoType.InSelectionHierarchy | GizmoType.Active)]
        internal static void Draw(KinefabMechanism mechanism, GizmoType type)
        {
            MotionState motion = mechanism.Motion;
            if (motion == null)
            {
                return;
            }

            if (!Known.TryGetValue(motion, out JointFigures figures))
            {
                figures = new JointFigures(motion.Mechanism);
                Known.Add(motion, figures);
            }

            Transform root = mechanism.transform;
            foreach (FigureLine line in figures.Lines)
            {
                if (!(line.Kind == FigureKind.Joint ? Joints : line.Kind == FigureKind.Closure ? Closures : Couplings).IsOn)
                {
                    continue;
                }

                JointFigures.At(motion.State, line, out Vector3d a, out Vector3d b);
                Vector3 from = root.TransformPoint(Numbers.Vector(a)), to = root.TransformPoint(Numbers.Vector(b));
                Handles.color = Colour(line.Colour);
                if (line.Kind == FigureKind.Joint)
                {
                    Handles.DrawLine(from, to);
                }
                else
                {
                    Handles.DrawDottedLine(from, to, Dots);
                }
            }

            if (Islands.IsOn)
            {
                DrawIslands(mechanism);
            }
        }

        private static void DrawIslands(KinefabMechanism mechanism)
        {
            foreach (Renderer renderer in mechanism.GetComponentsInChildren<Renderer>())
            {
                Bounds bounds = renderer.bounds;
                Handles.color = OfIsland(mechanism.IslandOf(renderer.transform));
                Handles.DrawWireCube(bounds.center, bounds.size);
            }
        }

        /// <summary>A switch of the user's, kept by the editor.</summary>
        internal sealed class Choice
        {
            private readonly bool _default;

            public Choice(string label, bool isOn)
            {
                Label = label;
                _default = isOn;
            }

            public string Label { get; }

            public bool IsOn
            {
                get => EditorPrefs.GetBool("Kinefab.Show." + Label, _default);
                set => EditorPrefs.SetBool("Kinefab.Show." + Label, value);
            }
        }
    }
}
