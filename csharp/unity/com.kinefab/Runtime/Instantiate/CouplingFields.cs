using System.Collections.Generic;
using Kinefab.Validation;
using UnityEngine;
using Doc = Kinefab.Document;

namespace KinefabUnity
{
    /// <summary>
    /// Leaves a <see cref="KinefabCoupling"/> for each coupling of the file, as prefabs by --scripts have them: they keep gears and mimics where
    /// physics moves the parts, and rest where the solver does.
    /// </summary>
    internal sealed class CouplingFields
    {
        private readonly ValidScene scene;
        private readonly GameObject[] objects;
        private readonly IReadOnlyDictionary<(int Object, int Component), Component> made;
        private readonly float scale;
        private readonly List<KinefabFinding> findings;

        /// <param name="scene">Whose couplings they are.</param>
        /// <param name="objects">In the order of the file.</param>
        /// <param name="made">Joints and links by their places in the file.</param>
        /// <param name="scale">Of the world's lengths to the file's.</param>
        /// <param name="findings">Gets what physics cannot keep.</param>
        internal CouplingFields(ValidScene scene, GameObject[] objects, IReadOnlyDictionary<(int Object, int Component), Component> made, float scale, List<KinefabFinding> findings)
        {
            this.scene = scene;
            this.objects = objects;
            this.made = made;
            this.scale = scale;
            this.findings = findings;
        }

        internal void Make()
        {
            foreach (Doc.Coupling from in scene.Document.Couplings)
            {
                string name = from.Id ?? objects[from.B.GameObject].name;
                bool isKept = IsKept(from.B);
                Doc.JointCoordinate off = IsOff(from.B) ? from.B : null;
                foreach (Doc.CouplingTerm term in from.Followed)
                {
                    isKept &= IsKept(term.Coordinate);
                    off = IsOff(term.Coordinate) ? term.Coordinate : off;
                }

                if (isKept)
                {
                    Set(objects[from.B.GameObject].AddComponent<KinefabCoupling>(), from);
                }
                else if (off != null)
                {
                    findings.Add(KinefabFinding.Of("COUPLING_WITHOUT_JOINT", name, ("coupling", name), ("joint", scene.Joint(off).Id ?? objects[off.GameObject].name)));
                }
                else
                {
                    findings.Add(KinefabFinding.Of("UNITY_COUPLING_NOT_IN_PHYSICS", name, ("coupling", name)));
                }
            }
        }

        private void Set(KinefabCoupling to, Doc.Coupling from)
        {
            to.driven = made[Place(from.B)] as Joint;
            to.drivenArticulationBody = made[Place(from.B)] as ArticulationBody;
            to.drivenCoordinate = (KinefabCoupling.Coordinate)from.B.Coordinate;
            to.offset = (float)from.Offset * Length(from.B);
            to.terms = new KinefabCoupling.Term[from.Followed.Count];
            for (int i = 0; i < to.terms.Length; i++)
            {
                Doc.CouplingTerm term = from.Followed[i];
                to.terms[i] = new KinefabCoupling.Term
                {
                    joint = made[Place(term.Coordinate)] as Joint,
                    articulationBody = made[Place(term.Coordinate)] as ArticulationBody,
                    coordinate = (KinefabCoupling.Coordinate)term.Coordinate.Coordinate,
                    ratio = (float)term.Ratio * Length(from.B) / Length(term.Coordinate),
                };
            }
        }

        // The script reads and drives joints, and of links those with one axis.
        private bool IsKept(Doc.JointCoordinate at) =>
            made.TryGetValue(Place(at), out Component found)
            && (!(found is ArticulationBody link) || link.jointType == ArticulationJointType.RevoluteJoint || link.jointType == ArticulationJointType.PrismaticJoint);

        private bool IsOff(Doc.JointCoordinate at) => !scene.Joint(at).Enabled;

        // It counts in the world's metres.
        private float Length(Doc.JointCoordinate at) => at.Coordinate >= Doc.Coordinate.X && at.Coordinate <= Doc.Coordinate.Z ? scale : 1;

        private static (int Object, int Component) Place(Doc.JointCoordinate at) => (at.GameObject, at.Component);
    }
}
