using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Islands with limits, drives and couplings, side by side and alone: the same bits in any number of lanes.</summary>
internal sealed class LaneRowTests
{
    private const double Dt = 1.0 / 60;

    // Not a whole number of lanes.
    private const int Islands = 13;

    private static IEnumerable<string> Kinds => RowScenes.Kinds.Keys;

    [TestCaseSource(nameof(Kinds))]
    public void Rows_InAnyNumberOfLanes_GiveTheSameBits(string kind)
    {
        MultibodySystem Make() => RowScenes.Pendulums(Islands, RowScenes.Kinds[kind]);
        List<long> alone = Run(Make(), 1);
        Assert.That(Run(Make(), 4), Is.EqualTo(alone), "4 lanes");
        Assert.That(Run(Make(), 8), Is.EqualTo(alone), "8 lanes");
    }

    [Test]
    public void Limits_NeverReached_ChangeNoBit()
    {
        List<long> without = Run(RowScenes.Pendulums(Islands), 8);
        Assert.That(Run(RowScenes.Pendulums(Islands, RowScenes.Kinds["limits, idle"]), 8), Is.EqualTo(without));
    }

    [Test]
    public void Bodies_ThatAProgramMoves_GiveTheSameBitsInAnyNumberOfLanes()
    {
        List<long> Moved(int lanes) => Run(RowScenes.Pendulums(Islands, RowScenes.Kinds["limits, reached"]), lanes, (m, step) =>
        {
            if (step % 17 == 5)
            {
                m.Bodies.AngularVelocities[step % m.Bodies.Count] += new Vector3d(0, 0, 2);
                m.Bodies.Poses[(step * 7) % m.Bodies.Count] = new Pose(m.Bodies.Poses[(step * 7) % m.Bodies.Count].Position + new Vector3d(0, 1e-4, 0), m.Bodies.Poses[(step * 7) % m.Bodies.Count].Rotation);
            }

            if (step == 100)
            {
                foreach (JointModel joint in m.Joints)
                {
                    ((RevoluteJoint)joint).Limit.Upper += 0.2;
                    ((RevoluteJoint)joint).Limit.Lower += 0.05;
                }
            }
        });
        List<long> alone = Moved(1);
        Assert.That(Moved(4), Is.EqualTo(alone), "4 lanes");
        Assert.That(Moved(8), Is.EqualTo(alone), "8 lanes");
    }

    [Test]
    public void Rows_OfManyKindsInOneGroup_GiveTheSameBitsInAnyNumberOfLanes()
    {
        List<long> alone = Run(Mixed(), 1);
        Assert.That(Run(Mixed(), 4), Is.EqualTo(alone), "4 lanes");
        Assert.That(Run(Mixed(), 8), Is.EqualTo(alone), "8 lanes");
    }

    // A spring and limits on a ConfigurableJoint's twist, a motor that comes to its force limit, limits that throw back; axes askew, bodies in either order.
    private static MultibodySystem Mixed()
    {
        var builder = new MechanismBuilder();
        for (int i = 0; i < Islands; i++)
        {
            var origin = new Vector3d(0, 0, i);
            var axis = new Vector3d(0.2, 0.01 * i, 1);
            Vector3d next = origin + new Vector3d(0.3, -0.4, 0.05), last = next + new Vector3d(0.1, -0.3, -0.02 * i);
            int upper = builder.Bar(origin, next, 1 + 0.1 * i), lower = builder.Bar(next, last, 0.4);
            var d6 = new D6Joint
            {
                Twist = AxisMotion.Limited,
                TwistLimit = new AngularLimit { Lower = -0.4 - 0.02 * i, Upper = 1.2, Response = new LimitResponse { Restitution = i % 2 == 0 ? 0.5 : 0 } },
                DriveTwist = new DriveModel { Stiffness = 2 + i, Damping = 0.05 * i, ForceLimit = 1000, IsAcceleration = i % 3 == 0 },
                DrivePose = new Pose(Vector3d.Zero, Quaterniond.AxisAngle(Vector3d.UnitX, 0.1 * i)),
            };
            builder.Add(d6, JointModel.World, upper, origin, axis);
            RevoluteJoint hinge = builder.Hinge(lower, upper, next, axis);
            hinge.LimitEnabled = true;
            hinge.Limit = new AngularLimit { Lower = -0.3, Upper = 0.5 };
            int third = builder.Bar(last, last + new Vector3d(0, -0.2, 0), 0.2);
            RevoluteJoint motor = builder.Hinge(lower, third, last, new Vector3d(1, 0.3, 0.1));
            motor.MotorEnabled = true;
            motor.MotorVelocity = 1 - 0.2 * i;
            motor.MotorForceLimit = 0.02 * (i + 1);
            motor.MotorFreeSpin = i % 4 == 1;
        }

        return builder.Build();
    }

    // Bits of all poses and speeds after every step, and of the reactions.
    private static List<long> Run(MultibodySystem mechanism, int lanes, Action<MultibodySystem, int>? before = null)
    {
        var solver = new RattleSolver(mechanism, lanes);
        var sums = new List<long>();
        for (int step = 0; step < 240; step++)
        {
            before?.Invoke(mechanism, step);
            solver.Step(Dt);
            long sum = Sum(MemoryMarshal.Cast<Pose, long>(mechanism.Bodies.Poses), 17);
            sum = Sum(MemoryMarshal.Cast<Vector3d, long>(mechanism.Bodies.AngularVelocities), sum);
            sums.Add(Sum(MemoryMarshal.Cast<JointReaction, long>(mechanism.Reactions), sum));
        }

        return sums;
    }

    private static long Sum(ReadOnlySpan<long> numbers, long sum)
    {
        foreach (long bits in numbers)
        {
            sum = unchecked(sum * 1099511628211 + bits);
        }

        return sum;
    }
}
