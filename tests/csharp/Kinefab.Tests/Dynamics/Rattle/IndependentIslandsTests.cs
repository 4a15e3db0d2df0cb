using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>What hangs together by no joint has nothing to do with each other: an island moves to the bit as it does alone, whatever happens beside it.</summary>
internal sealed class IndependentIslandsTests
{
    private const double Dt = 1.0 / 60;
    private const int Islands = 6;
    private const int BodiesEach = 3;

    /// <summary>
    /// Islands of one shape share the room in which they step alone: what a drive without limit of force at a dead point remembered there was the
    /// island's before it, which led to other motions in every fifth of these worlds, by up to 2 cm.
    /// </summary>
    [Test]
    public void Step_OfSliderCranksInOneWorld_IsThatOfEachInAWorldOfItsOwn([Range(1, 20)] int seed)
    {
        MultibodySystem together = SliderCranks(seed, Enumerable.Range(0, Islands));
        MultibodySystem[] apart = Enumerable.Range(0, Islands).Select(i => SliderCranks(seed, new[] { i })).ToArray();
        var solver = new RattleSolver(together);
        RattleSolver[] solvers = Array.ConvertAll(apart, one => new RattleSolver(one));
        for (int step = 0; step < 120; step++)
        {
            solver.Step(Dt);
            for (int i = 0; i < Islands; i++)
            {
                solvers[i].Step(Dt);
                AssertSame(together, BodiesEach * i, apart[i], 0, BodiesEach, $"step {step}, island {i}");
            }
        }

        Assert.That(together.StalledJoints, Has.Count.EqualTo(apart.Sum(one => one.StalledJoints.Count)));
    }

    /// <summary>
    /// A motor that is switched on and off has its own island found anew. All others forgot what they knew: a crank that rested at its dead point was
    /// thrown about at 14 rad/s, an arm on a stiff spring got the speed that its last step only showed.
    /// </summary>
    [Test]
    public void Step_WhereAJointElsewhereChanges_HasTheSameBits([Range(1, 10)] int seed, [Values(1, 4, 8)] int width)
    {
        MultibodySystem calm = WithAnArm(seed, out _);
        MultibodySystem changed = WithAnArm(seed, out RevoluteJoint toggled);
        var solver = new RattleSolver(calm, width);
        var other = new RattleSolver(changed, width);
        for (int step = 0; step < 200; step++)
        {
            toggled.MotorEnabled ^= step % 25 == 24;
            solver.Step(Dt);
            other.Step(Dt);
            AssertSame(calm, BodiesEach, changed, BodiesEach, calm.Bodies.Count - BodiesEach, $"step {step}");
        }
    }

    /// <summary>What a joint that broke has left of a loop whose axes are off has no loop, and so nothing that is off: its angles hold again.</summary>
    [Test]
    public void Break_OfALoopWithAxesOff_LeavesAnExactChain()
    {
        MultibodySystem m = SolverScenes.FourBars(1, 0.02);
        m.Gravity = new Vector3d(0, -3, -9);
        var solver = new RattleSolver(m);
        for (int i = 0; i < 30; i++)
        {
            solver.Step(Dt);
        }

        m.Joints[2].IsBroken = true;
        for (int i = 0; i < 120; i++)
        {
            solver.Step(Dt);
        }

        JointModel last = m.Joints[3];
        Vector3d axis0 = m.Bodies.PoseOf(last.Body0).Rotation * (last.Frame0.Rotation * Vector3d.UnitX);
        Vector3d axis1 = m.Bodies.PoseOf(last.Body1).Rotation * (last.Frame1.Rotation * Vector3d.UnitX);
        Assert.That(Vector3d.Cross(axis0, axis1).Length, Is.LessThan(1e-9));
    }

    // A motor, limits and a mass of its own each; by the seed it turns the crank or the slider's pin, with a limit of force or without.
    private static MultibodySystem SliderCranks(int seed, IEnumerable<int> islands)
    {
        var builder = new MechanismBuilder();
        foreach (int i in islands)
        {
            AddSliderCrank(builder, seed, i);
        }

        return builder.Build();
    }

    private static MultibodySystem WithAnArm(int seed, out RevoluteJoint toggled)
    {
        var builder = new MechanismBuilder();
        toggled = AddSliderCrank(builder, seed, 0);
        for (int i = 1; i < Islands; i++)
        {
            AddSliderCrank(builder, seed, i);
        }

        int arm = builder.Bar(new Vector3d(0, 0, -3), new Vector3d(1, 0, -3), 1);
        builder.Hinge(JointModel.World, arm, new Vector3d(0, 0, -3), Vector3d.UnitZ).Spring = new DriveModel { Stiffness = 1e3, Damping = 1e3, ForceLimit = double.PositiveInfinity };
        return builder.Build();
    }

    // The hinge that has no motor.
    private static RevoluteJoint AddSliderCrank(MechanismBuilder builder, int seed, int island)
    {
        var shape = new Draw(seed);
        var own = new Draw(1000 * seed + island);
        var origin = new Vector3d(0, 0, 3 * island);
        double angle = own.Between(0, 6), crank = own.Between(0.2, 0.4), rod = own.Between(0.6, 1);
        Vector3d elbow = origin + new Vector3d(crank * Math.Cos(angle), crank * Math.Sin(angle), 0);
        var pin = new Vector3d(elbow.X + Math.Sqrt(rod * rod - elbow.Y * elbow.Y), 0, origin.Z);
        int first = builder.Bar(origin, elbow, 1), second = builder.Bar(elbow, pin, 1);
        int slider = builder.Body(pin, Quaterniond.Identity, own.Between(1, 4), new Vector3d(0.01, 0.01, 0.01));
        RevoluteJoint atCrank = builder.Hinge(JointModel.World, first, origin, Vector3d.UnitZ);
        RevoluteJoint between = builder.Hinge(first, second, elbow, Vector3d.UnitZ);
        RevoluteJoint atSlider = builder.Hinge(second, slider, pin, Vector3d.UnitZ);
        builder.Add(new D6Joint { X = AxisMotion.Free }, JointModel.World, slider, pin, Vector3d.UnitX);
        bool isAtSlider = shape.One(2), isEndless = shape.One(2), isLimited = shape.One(2);
        RevoluteJoint driven = isAtSlider ? atSlider : atCrank;
        driven.MotorEnabled = true;
        driven.MotorVelocity = own.Between(-4, 4);
        driven.MotorForceLimit = isEndless ? double.PositiveInfinity : 40;
        between.LimitEnabled = isLimited;
        between.Limit = new AngularLimit { Lower = own.Between(-2, -1), Upper = own.Between(0.3, 1.3) };
        RevoluteJoint idle = isAtSlider ? atCrank : atSlider;
        idle.MotorForceLimit = 1;
        return idle;
    }

    private static void AssertSame(MultibodySystem a, int firstA, MultibodySystem b, int firstB, int count, string where)
    {
        for (int i = 0; i < count; i++)
        {
            Assert.That(b.Bodies.Poses[firstB + i], Is.EqualTo(a.Bodies.Poses[firstA + i]), where);
            Assert.That(b.Bodies.LinearVelocities[firstB + i], Is.EqualTo(a.Bodies.LinearVelocities[firstA + i]), where);
            Assert.That(b.Bodies.AngularVelocities[firstB + i], Is.EqualTo(a.Bodies.AngularVelocities[firstA + i]), where);
        }
    }
}
