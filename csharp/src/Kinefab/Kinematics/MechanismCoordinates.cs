using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Joints;
using Joint = Kinefab.Joints.Joint;

namespace Kinefab.Kinematics;

/// <summary>Finds the unlocked coordinates of a scene's joints.</summary>
internal static class MechanismCoordinates
{
    /// <summary>In order of joint and axis.</summary>
    public static MechanismCoordinate[] Of(MechanismDefinition definition, Joint[] joints)
    {
        var coordinates = new List<MechanismCoordinate>();
        for (int j = 0; j < definition.Joints.Count; j++)
        {
            JointDefinition source = definition.Joints[j];
            int locked = JointFreedoms.LockedAxes(joints[j]);
            for (int axis = 0; axis < 6; axis++)
            {
                if ((locked & (1 << axis)) != 0)
                {
                    continue;
                }

                // The rows measure actor 1 against actor 0, Unity the own body against the connected one.
                double sign = UnityJoints.CoordinateSign(source.Source);
                Coordinate name = source.Source is HingeJoint ? Coordinate.Angle : Coordinate.X + axis;
                var rows = new Joints.JointCoordinate(joints[j], (CoordinateAxis)axis, sign);
                coordinates.Add(new MechanismCoordinate(source.GameObject, source.Component, name, j, rows));
            }
        }

        return coordinates.ToArray();
    }
}
