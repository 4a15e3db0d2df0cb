using System;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>What joints did in a step is summed up when it is read, but for joints that can break: the numbers are the same.</summary>
internal sealed class UnreadReactionTests
{
    private const int Steps = 90;

    private static readonly string[] Scenes = [.. RowScenes.Kinds.Keys, "four-bars", "slider-crank"];

    [Test]
    public void Reactions_ReadLate_AreThoseOfJointsThatCouldBreak([ValueSource(nameof(Scenes))] string name, [Values(1, 4, 8)] int width)
    {
        MultibodySystem unread = Scene(name), awaited = Scene(name);
        foreach (JointModel joint in awaited.Joints)
        {
            joint.BreakForce = 1e30;
        }

        var late = new RattleSolver(unread, width);
        var early = new RattleSolver(awaited, width);
        for (int i = 0; i < Steps; i++)
        {
            late.Step(1.0 / 60);
            early.Step(1.0 / 60);
            Assert.That(unread.UnreadReactions, Is.Not.Null);
            Assert.That(awaited.UnreadReactions, Is.Null);

            // Not read in each step: what was not is lost to the next.
            if (i % 3 == 0)
            {
                Assert.That(unread.Reactions.Select(r => (r.Force, r.Torque)), Is.EqualTo(awaited.Reactions.Select(r => (r.Force, r.Torque))), $"step {i}");
            }
        }

        Assert.That(unread.Reactions.Count(r => r.Force.Length > 1e-3), Is.EqualTo(unread.Joints.Length));
    }

    // Not as many as fill the lanes.
    private static MultibodySystem Scene(string name) => name switch
    {
        "four-bars" => SolverScenes.FourBars(11),
        "slider-crank" => SolverScenes.SliderCrank(),
        _ => RowScenes.Pendulums(11, RowScenes.Kinds[name]),
    };
}
