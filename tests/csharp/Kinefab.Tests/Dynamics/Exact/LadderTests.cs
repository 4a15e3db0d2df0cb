using Kinefab.Dynamics;
using Kinefab.Dynamics.Exact;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Exact;

/// <summary>When steps are cut, for how long, and what is counted when no method can take one.</summary>
internal sealed class LadderTests
{
    [Test]
    public void Note_HarderStep_IsKept()
    {
        var cut = default(StepCut);
        cut.Note(3, 5);
        Assert.That(cut.Halvings, Is.EqualTo(3));
        cut.Note(3, 0.1);
        Assert.That(cut.Halvings, Is.EqualTo(3));
    }

    [Test]
    public void Note_FifteenCalmSteps_OneHalvingLess()
    {
        var cut = default(StepCut);
        cut.Note(3, 5);
        for (int i = 0; i < 14; i++)
        {
            cut.Note(3, 1);
        }

        Assert.That(cut.Halvings, Is.EqualTo(3));
        cut.Note(3, 1);
        Assert.That(cut.Halvings, Is.EqualTo(2));
    }

    [Test]
    public void Note_DemandAmongCalmSteps_CountsAnew()
    {
        var cut = default(StepCut);
        cut.Note(3, 5);
        for (int i = 0; i < 14; i++)
        {
            cut.Note(3, 1);
        }

        cut.Note(3, 1.5);
        for (int i = 0; i < 14; i++)
        {
            cut.Note(3, 1);
        }

        Assert.That(cut.Halvings, Is.EqualTo(3));
    }

    [TestCase(4, 0, 0.25, 0.5)]
    [TestCase(0, 10, 0.1, 2)]
    [TestCase(10000, 10, 0.1, 10)]
    public void Demand_StiffnessAndSpeed_TheLarger(double stiffness, double speed, double dt, double expected)
    {
        Assert.That(Ladder.Demand(stiffness, speed, dt), Is.EqualTo(expected).Within(1e-12));
    }

    [Test]
    public void Step_LoopThatCannotClose_StandsAndSaysSo()
    {
        // A bar of 1 m pinned to the world at two points 1.5 m apart.
        var b = new MechanismBuilder();
        int bar = b.Bar(Vector3d.Zero, Vector3d.UnitX, 1);
        b.Hinge(Joint.World, bar, Vector3d.Zero, Vector3d.UnitZ);
        RevoluteJoint far = b.Hinge(Joint.World, bar, Vector3d.UnitX, Vector3d.UnitZ);
        far.Frame0 = new Pose(new Vector3d(1.5, 0, 0), far.Frame0.Rotation);
        MultibodySystem mechanism = b.Build();
        var solver = new ExactSolver(mechanism);
        Pose start = mechanism.Bodies.Poses[0];
        for (int i = 0; i < 10; i++)
        {
            solver.Step(0.02);
        }

        Assert.That(mechanism.Overflows, Is.Positive);
        Assert.That(mechanism.Bodies.Poses[0], Is.EqualTo(start));
        Assert.That(mechanism.Bodies.LinearVelocities[0].Length, Is.LessThan(1));
    }
}
