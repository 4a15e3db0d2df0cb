using System;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Exact;

/// <summary>What a run is judged by, from poses and velocities alone.</summary>
internal static class MechanismMeasures
{
    /// <summary>Largest distance between the two anchors of a joint without linear freedom, metres.</summary>
    public static double Drift(MultibodySystem mechanism)
    {
        double most = 0;
        foreach (Joint joint in mechanism.Joints)
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
    public static double Energy(MultibodySystem mechanism)
    {
        double sum = 0;
        Bodies bodies = mechanism.Bodies;
        for (int i = 0; i < bodies.Count; i++)
        {
            if (bodies.InverseMasses[i] == 0)
            {
                continue;
            }

            Vector3d w = bodies.Poses[i].Rotation.InverseRotate(bodies.AngularVelocities[i]);
            Vector3d inverse = bodies.InverseInertias[i];
            double mass = 1 / bodies.InverseMasses[i];
            sum += mass * (bodies.LinearVelocities[i].LengthSquared / 2 - Vector3d.Dot(mechanism.Gravity, bodies.Poses[i].Position));
            sum += (w.X * w.X / inverse.X + w.Y * w.Y / inverse.Y + w.Z * w.Z / inverse.Z) / 2;
        }

        return sum;
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
