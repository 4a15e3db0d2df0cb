using System;
using Kinefab.Dynamics;
using Kinefab.Joints;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Numbers a mechanism's bodies otherwise, which must change nothing but the last digits.</summary>
internal static class BodyOrder
{
    /// <summary>Shuffles the bodies in place.</summary>
    /// <returns>New index of each body.</returns>
    public static int[] Shuffle(MultibodySystem mechanism, Random random)
    {
        Bodies bodies = mechanism.Bodies;
        var places = new int[bodies.Count];
        for (int i = 0; i < places.Length; i++)
        {
            places[i] = i;
        }

        random.Shuffle(places);
        Move(bodies.Poses, places);
        Move(bodies.LinearVelocities, places);
        Move(bodies.AngularVelocities, places);
        Move(bodies.InverseMasses, places);
        Move(bodies.InverseInertias, places);
        Move(bodies.LinearDampings, places);
        Move(bodies.AngularDampings, places);
        Move(bodies.MaxAngularSpeeds, places);
        Move(bodies.UseGravity, places);
        Move(bodies.IsKinematic, places);
        Move(bodies.KinematicTargets, places);
        Move(bodies.Locks, places);
        Move(bodies.Forces, places);
        Move(bodies.Torques, places);
        foreach (JointModel joint in mechanism.Joints)
        {
            joint.Body0 = joint.Body0 == JointModel.World ? JointModel.World : places[joint.Body0];
            joint.Body1 = joint.Body1 == JointModel.World ? JointModel.World : places[joint.Body1];
        }

        return places;
    }

    private static void Move<T>(T[] values, int[] places)
    {
        var old = (T[])values.Clone();
        for (int i = 0; i < old.Length; i++)
        {
            values[places[i]] = old[i];
        }
    }
}
