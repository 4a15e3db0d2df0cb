using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Mechanisms;
using Coupling = Kinefab.Document.Coupling;
using Joint = Kinefab.Joints.JointModel;
using JointCoordinate = Kinefab.Document.JointCoordinate;

namespace Kinefab.Kinematics;

/// <summary>Finds the coordinates of a scene's joints: the unlocked ones, then locked ones that couplings name.</summary>
internal static class MechanismCoordinates
{
    /// <summary>In order of joint and axis.</summary>
    public static MechanismCoordinate[] Of(MechanismDefinition definition, JointModel[] joints, bool[] holdsNothing, IReadOnlyList<Coupling> couplings)
    {
        var coordinates = new List<MechanismCoordinate>();
        for (int j = 0; j < definition.Joints.Count; j++)
        {
            JointDefinition source = definition.Joints[j];
            int locked = MotionSubspace.LockedAxes(joints[j]);
            if (holdsNothing[j])
            {
                continue; // it stands for no joint of the source: nobody asks how far it is
            }

            for (int axis = 0; axis < 6; axis++)
            {
                if ((locked & (1 << axis)) != 0)
                {
                    continue;
                }

                coordinates.Add(Make(source, joints[j], j, axis, isLocked: false));
            }
        }

        // Several couplings may name one.
        var added = new HashSet<(int Joint, int Axis)>();
        foreach (Coupling coupling in couplings)
        {
            foreach (CouplingTerm term in coupling.Followed)
            {
                AddLocked(term.Coordinate);
            }

            AddLocked(coupling.B);
        }

        return coordinates.ToArray();

        void AddLocked(JointCoordinate place)
        {
            int axis = place.Coordinate == Coordinate.Angle ? (int)CoordinateAxis.AngularX : place.Coordinate - Coordinate.X;
            int j = definition.IndexOf(place.GameObject, place.Component);
            if (j >= 0 && (MotionSubspace.LockedAxes(joints[j]) & (1 << axis)) != 0 && added.Add((j, axis)))
            {
                coordinates.Add(Make(definition.Joints[j], joints[j], j, axis, isLocked: true));
            }
        }
    }

    // The rows measure actor 1 against actor 0, Unity the own body against the connected one.
    private static MechanismCoordinate Make(JointDefinition source, JointModel joint, int index, int axis, bool isLocked)
    {
        Coordinate name = source.Source is HingeJoint ? Coordinate.Angle : Coordinate.X + axis;
        CoordinateAxisMap rows = new Joints.CoordinateAxisMap(joint, (CoordinateAxis)axis, UnityJoints.CoordinateSign(source.Source));
        return new MechanismCoordinate(source.GameObject, source.Component, name, index, rows, isLocked, CadReading.Of(source.Source, name));
    }
}
