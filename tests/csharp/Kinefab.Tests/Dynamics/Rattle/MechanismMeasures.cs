using System;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>What a run is judged by, from poses and velocities alone.</summary>
internal static class MechanismMeasures
{
    /// <summary>Largest distance between the two anchors of a joint without linear freedom, metres.</summary>
    public static double Drift(MultibodySystem mechanism)
    {
        double most = 0;
        foreach (JointModel joint in mechanism.Joints)
        {
            Vector3d gap = mechanism.Bodies.PoseOf(joint.Body1).Point(joint.Frame1.Position)
                - mechanism.Bodies.PoseOf(joint.Body0).Point(joint.Frame0.Position);
            if (joint is D6Joint d6)
            {
                Quaterniond frame = mechanism.Bodies.PoseOf(joint.Body0).Rotation * joint.Frame0.Rotation;
                Vector3d local = frame.InverseRotate(gap);
                gap = new Vector3d(
                    d6.X == AxisMotion.Locked ? local.X : 0, d6.Y == AxisMotion.Locked ? local.Y : 0, d6.Z == AxisMotion.Locked ? local.Z : 0);
            }

            most = Math.Max(most, double.IsNaN(gap.Length) ? double.PositiveInfinity : gap.Length);
        }

        return most;
    }

    /// <summary>Kinetic and gravitational energy, J.</summary>
    public static double Energy(MultibodySystem mechanism) => Kinetic(mechanism) + Potential(mechanism);

    /// <summary>Kinetic energy, J.</summary>
    public static double Kinetic(MultibodySystem mechanism)
    {
        double sum = 0;
        for (int i = 0; i < mechanism.Bodies.Count; i++)
        {
            sum += mechanism.Bodies.KineticEnergy(i);
        }

        return sum;
    }

    /// <summary>Gravitational energy, J.</summary>
    public static double Potential(MultibodySystem mechanism)
    {
        double sum = 0;
        for (int i = 0; i < mechanism.Bodies.Count; i++)
        {
            sum += mechanism.Bodies.PotentialEnergy(i, mechanism.Gravity);
        }

        return sum;
    }

    /// <summary>
    /// What free fall from rest would have given all bodies after a time, J. By Gauss's principle of least constraint joints
    /// take from its speed and add nothing.
    /// </summary>
    public static double FallEnergy(MultibodySystem mechanism, double time)
    {
        double sum = 0;
        foreach (double inverseMass in mechanism.Bodies.InverseMasses)
        {
            sum += inverseMass > 0 ? mechanism.Gravity.LengthSquared * time * time / (2 * inverseMass) : 0;
        }

        return sum;
    }

    /// <summary>Whether all poses and velocities are numbers, and rotations are rotations.</summary>
    public static bool IsFinite(MultibodySystem mechanism)
    {
        Bodies bodies = mechanism.Bodies;
        for (int i = 0; i < bodies.Count; i++)
        {
            if (!bodies.Poses[i].Position.IsFinite || !(Math.Abs(bodies.Poses[i].Rotation.LengthSquared - 1) < 1e-3)
                || !bodies.LinearVelocities[i].IsFinite || !bodies.AngularVelocities[i].IsFinite)
            {
                return false;
            }
        }

        return true;
    }

    /// <summary>A number that differs when any bit of any pose or velocity does.</summary>
    public static ulong Bits(MultibodySystem mechanism)
    {
        ulong hash = 14695981039346656037;
        Bodies bodies = mechanism.Bodies;
        for (int i = 0; i < bodies.Count; i++)
        {
            Mix(bodies.Poses[i].Position);
            Mix(bodies.Poses[i].Rotation.Vector);
            Mix(bodies.LinearVelocities[i]);
            Mix(bodies.AngularVelocities[i]);
        }

        return hash;

        void Mix(Vector3d v)
        {
            for (int k = 0; k < 3; k++)
            {
                hash = (hash ^ (ulong)BitConverter.DoubleToInt64Bits(v[k])) * 1099511628211;
            }
        }
    }
}
