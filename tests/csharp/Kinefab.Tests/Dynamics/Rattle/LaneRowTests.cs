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
