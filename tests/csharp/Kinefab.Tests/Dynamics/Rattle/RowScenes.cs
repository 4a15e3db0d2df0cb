using System;
using System.Collections.Generic;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Double pendulums, many islands of one shape, with each kind of row that a joint may have beyond its locked axes.</summary>
internal static class RowScenes
{
    /// <summary>What to add to the two hinges of a pendulum, by name.</summary>
    public static readonly Dictionary<string, Action<MechanismBuilder, RevoluteJoint, RevoluteJoint>> Kinds = new()
    {
        ["limits, idle"] = (_, upper, lower) => Limits(upper, lower, 170),
        ["limits, reached"] = (_, upper, lower) => Limits(upper, lower, 20),
        ["spring drives"] = (_, upper, lower) => Springs(upper, lower),
        ["velocity motors"] = (_, upper, lower) => Motors(upper, lower),
        ["couplings"] = (builder, upper, lower) => builder.Couple(lower, (upper, -0.5)),
    };

    /// <summary>Two bars of 0.5 m and 1 kg each, released side by side at some 30 degrees from hanging.</summary>
    /// <param name="count">Pendulums.</param>
    /// <param name="add">To each; null: nothing.</param>
    public static MultibodySystem Pendulums(int count, Action<MechanismBuilder, RevoluteJoint, RevoluteJoint>? add = null)
    {
        var builder = new MechanismBuilder();
        for (int i = 0; i < count; i++)
        {
            double angle = 0.5 + 0.001 * i;
            var direction = new Vector3d(0.5 * Math.Sin(angle), -0.5 * Math.Cos(angle), 0);
            var origin = new Vector3d(0, 0, i);
            int upper = builder.Bar(origin, origin + direction, 1);
            int lower = builder.Bar(origin + direction, origin + direction * 2, 1);
            RevoluteJoint first = builder.Hinge(JointModel.World, upper, origin, Vector3d.UnitZ);
            RevoluteJoint second = builder.Hinge(upper, lower, origin + direction, Vector3d.UnitZ);
            add?.Invoke(builder, first, second);
        }

        return builder.Build();
    }

    private static void Limits(RevoluteJoint upper, RevoluteJoint lower, double degrees)
    {
        foreach (RevoluteJoint hinge in new[] { upper, lower })
        {
            hinge.LimitEnabled = true;
            hinge.Limit = new AngularLimit { Lower = -degrees * Math.PI / 180, Upper = degrees * Math.PI / 180 };
        }
    }

    private static void Springs(RevoluteJoint upper, RevoluteJoint lower)
    {
        foreach (RevoluteJoint hinge in new[] { upper, lower })
        {
            hinge.Spring = new DriveModel { Stiffness = 5, Damping = 0.1, ForceLimit = 1000 };
            hinge.SpringTarget = -0.3;
        }
    }

    private static void Motors(RevoluteJoint upper, RevoluteJoint lower)
    {
        upper.MotorEnabled = lower.MotorEnabled = true;
        upper.MotorForceLimit = lower.MotorForceLimit = 1000;
        upper.MotorVelocity = 1;
        lower.MotorVelocity = -1.5;
    }
}
