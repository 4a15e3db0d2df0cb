using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics.Rattle;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>Limits of a twist in the exact solver hold at any swing, by a row that is a gradient and grows nowhere.</summary>
internal sealed class WeighedTwistTests
{
    // Metres that the slide goes for each degree of a coupled ball's twist.
    private const double Ratio = 0.001;

    /// <summary>Swings up to a ten-thousandth of a radian beside half a turn, where the twist itself turns ten thousand times as fast as its joint.</summary>
    [TestCase(0.7)]
    [TestCase(Math.PI - 0.02)]
    [TestCase(Math.PI - 1e-4)]
    public void WeighedGradient_OfWhatIsLeft_IsItsRate(double swing)
    {
        var random = new Random(5);
        double h = 1e-5 * Math.Cos(swing / 2);
        for (int trial = 0; trial < 100; trial++)
        {
            double toward = 2 * Math.PI * random.NextDouble(), twist = 3 * random.NextDouble() - 1, goal = 2 * random.NextDouble() - 0.5;
            Quaterniond at = Quaterniond.AxisAngle(new Vector3d(0, Math.Cos(toward), Math.Sin(toward)), swing) * Quaterniond.AxisAngle(Vector3d.UnitX, twist);

            Vector3d gradient = SwingTwist.WeighedGradient(Vector3d.UnitX, at * Vector3d.UnitX, goal - twist, out double weight);

            Assert.That(weight, Is.EqualTo(Math.Cos(swing / 2)).Within(1e-12));
            for (int axis = 0; axis < 3; axis++)
            {
                Vector3d turn = axis == 0 ? Vector3d.UnitX : axis == 1 ? Vector3d.UnitY : Vector3d.UnitZ;
                double rate = (Weighed(turn, h) - Weighed(turn, -h)) / (2 * h);
                Assert.That(-gradient[axis], Is.EqualTo(rate).Within(1e-4), $"trial {trial}, axis {axis}");
            }

            double Weighed(Vector3d turn, double angle)
            {
                Quaterniond q = Quaterniond.AxisAngle(turn, angle) * at;
                double c = Math.Sqrt(q.X * q.X + q.W * q.W);
                return c * (goal - SwingTwist.Nearest(SwingTwist.TwistAngle(q), twist));
            }
        }
    }

    [Test]
    public void WeighedGradient_AtTheGoal_IsAUnitVector([Values(0, 2.0, Math.PI - 1e-6)] double swing)
    {
        Vector3d axis = Quaterniond.AxisAngle(new Vector3d(0, 0.6, 0.8), swing) * Vector3d.UnitX;
        Assert.That(SwingTwist.WeighedGradient(Vector3d.UnitX, axis, 0, out _).Length, Is.EqualTo(1).Within(1e-9));
    }

    /// <summary>
    /// A rod on a ball whose twist has limits is swung over its top, beside it by less and less, where its twist goes round faster than anything moves.
    /// </summary>
    [TestCase(0)]
    [TestCase(1e-6)]
    [TestCase(1e-3)]
    [TestCase(0.05)]
    public void Step_BallSwungOverItsTop_TakesFewParts(double aside)
    {
        const double dt = 1.0 / 60, mostParts = 25;
        var b = new MechanismBuilder();
        int rod = b.Body(new Vector3d(0.5, 0, 0), Quaterniond.Identity, 1.3, new Vector3d(0.01, 0.11, 0.12));
        var ball = new D6Joint
        {
            Twist = AxisMotion.Limited, Swing1 = AxisMotion.Free, Swing2 = AxisMotion.Free,
            TwistLimit = new AngularLimit { Lower = -10 * Math.PI / 180, Upper = 80 * Math.PI / 180 },
        };
        b.Add(ball, JointModel.World, rod, Pose.Identity);
        MultibodySystem m = b.Build();
        var spin = new Vector3d(0, aside, 7);
        m.Bodies.AngularVelocities[rod] = spin;
        m.Bodies.LinearVelocities[rod] = Vector3d.Cross(spin, new Vector3d(0.5, 0, 0));
        var solver = new RattleSolver(m, new List<InconsistentLoop>());
        double start = MechanismMeasures.Energy(m), work = 0, most = 0;
        for (int i = 1; i <= 300; i++)
        {
            solver.Step(dt);
            most = Math.Max(most, 1 + m.SubstepWork - work);
            work = m.SubstepWork;
            double twist = SwingTwist.TwistAngle(m.Bodies.Poses[rod].Rotation) * 180 / Math.PI, turned = 360 * Math.Round((twist - 35) / 360);
            Assert.That(MechanismMeasures.Energy(m), Is.LessThanOrEqualTo(start + 0.05), $"step {i}");
            Assert.That(twist - turned, Is.InRange(-10.01, 80.01), $"step {i}");
        }

        Assert.That(most, Is.LessThanOrEqualTo(mostParts));
        Assert.That(m.Stops, Is.Zero);
    }

    /// <summary>
    /// A ball whose twist moves a slide is swung over its top, or beside it, where its twist goes round faster than anything moves: what the slide weighs
    /// holds it, and there is a motion over the top.
    /// </summary>
    [TestCase(1, 1e-3, 0.001)]
    [TestCase(0.01, 0, 0.02)]
    [TestCase(0.01, 0.05, 0.005)]
    public void Step_CoupledBallSwungOverItsTop_KeepsItsEnergyInFewParts(double slide, double aside, double dt)
    {
        const double mostParts = 100;
        World world = CoupledBall(new Vector3d(0.5, 0, 0), 0.01, slide);
        WorldBody ball = world.Bodies[0];
        ball.AngularVelocity = new Vector3d(0.5, aside, 7);
        ball.LinearVelocity = Vector3d.Cross(ball.AngularVelocity, ball.Pose.Position);
        world.Bodies[1].LinearVelocity = new Vector3d(0.5 * 180 / Math.PI * Ratio, 0, 0);
        double start = world.KineticEnergy + world.PotentialEnergy;
        for (int i = 0; i < 3 / dt; i++)
        {
            double work = world.SubstepWork;
            world.Step(dt);
            Assert.That(world.SubstepWork - work, Is.LessThanOrEqualTo(mostParts), $"step {i}");
            Assert.That(world.KineticEnergy + world.PotentialEnergy, Is.EqualTo(start).Within(0.1), $"step {i}");
        }

        Assert.That(world.Joints[1].Coordinate(Coordinate.X), Is.EqualTo(Ratio * world.Joints[0].Coordinate(Coordinate.AngularX)).Within(1e-6));
        Assert.That(world.Stops, Is.Zero);
    }

    /// <summary>A drive of the twist gets there and stays, however near the half-turn the ball swings: it had sought that, where its weight was none.</summary>
    [Test]
    public void DriveTo_TwistOfACoupledBall_StaysAtItsGoal([Values(10.0, 40, 90, 170)] double goal, [Values(0.02, 0.01)] double dt)
    {
        World world = CoupledBall(new Vector3d(0.5, 0.1, -0.2), 0.1, 1);
        world.Joints[0].DriveTo(Coordinate.AngularX, goal);
        for (int i = 1; i <= 10 / dt; i++)
        {
            world.Step(dt);
            Assert.That(i * dt < 3 ? goal : world.Joints[0].Coordinate(Coordinate.AngularX), Is.EqualTo(goal).Within(1e-3), $"step {i}");
        }

        Assert.That(world.Findings.Diagnostics, Is.Empty);
    }

    /// <summary>
    /// A round ball whose angle about X is a ratio times the one about Y goes along q ~ (tan(ratio a / 2), tan(a / 2), 0, 1) at a constant speed, by symmetry:
    /// over poles of either angle, where it has no value and the other one has. A speed aside leads past them.
    /// </summary>
    [TestCase(1, 0)]
    [TestCase(-1.7, 0)]
    [TestCase(3, 0)]
    [TestCase(2, 0.05)]
    [TestCase(0.5, 0.05)]
    public void Step_BallOfTwoCoupledAngles_GoesItsWay(double ratio, double aside)
    {
        const double dt = 0.001, inertia = 0.1, speed = 5, fine = 1e-4;
        World world = BallOfTwoCoupledAngles(ratio, inertia);
        WorldBody ball = world.Bodies[0];
        ball.AngularVelocity = new Vector3d(ratio, 1, aside) * (speed / Math.Sqrt(ratio * ratio + 1));
        double energy = world.KineticEnergy, a = 0, way = 0;
        for (int i = 1; i <= 3000; i++)
        {
            world.Step(dt);
            Assert.That(world.KineticEnergy, Is.EqualTo(energy).Within(3e-5 * energy), $"step {i}");
            for (; aside == 0 && way < speed * i * dt; a += fine)
                way += Between(Path(a), Path(a + fine));
            if (aside == 0)
                Assert.That(Between(ball.Pose.Rotation, Path(a)), Is.LessThan(8 * fine), $"step {i}");
        }

        Quaterniond Path(double angle) =>
            new Quaterniond(Math.Sin(ratio * angle / 2) * Math.Cos(angle / 2), Math.Sin(angle / 2) * Math.Cos(ratio * angle / 2), 0, Math.Cos(ratio * angle / 2) * Math.Cos(angle / 2)).Normalized();

        static double Between(Quaterniond one, Quaterniond other) => 2 * Math.Asin((one.Conjugate() * other).Vector.Length);
    }

    /// <summary>
    /// At y = x / 0.5 = 180 degrees the driven angle x has no value: it comes to it, and goes over it, as anywhere else. It was thrown back at 32 rad/s there, and
    /// told of a drive that stalls.
    /// </summary>
    [Test]
    public void DriveTo_CoupledAngleOverItsOwnPole_GetsThere([Values(90, 120, 170)] double goal, [Values(0.02, 0.01)] double dt)
    {
        World world = BallOfTwoCoupledAngles(0.5, 0.1);
        WorldJoint joint = world.Joints[0];
        joint.DriveTo(Coordinate.AngularX, goal);
        double last = 0;
        for (int i = 1; i <= 3 / dt; i++)
        {
            world.Step(dt);
            double now = joint.Coordinate(Coordinate.AngularY);
            Assert.That(now, Is.GreaterThan(last - 1e-6), $"step {i}");
            last = now;
        }

        Assert.That(last, Is.EqualTo(2 * goal).Within(1e-6));
        Assert.That(world.Findings.Diagnostics, Is.Empty);
    }

    private static World BallOfTwoCoupledAngles(double ratio, double inertia)
    {
        const ConfigurableJointMotion free = ConfigurableJointMotion.Free, locked = ConfigurableJointMotion.Locked;
        var joint = new ConfigurableJoint
        {
            Axis = Vector3d.UnitX, SecondaryAxis = Vector3d.UnitY, XMotion = locked, YMotion = locked, ZMotion = locked,
            AngularXMotion = free, AngularYMotion = free, AngularZMotion = free,
        };
        var body = new Rigidbody { InertiaTensor = new Vector3d(inertia, inertia, inertia), AngularDamping = 0, MaxAngularVelocity = 1000 };
        return World.Create(
            SmallScene.Validate(new SceneDocument
            {
                Physics = new Physics { Gravity = Vector3d.Zero },
                GameObjects = [new GameObject { Id = "ball", Name = "ball", Components = [body, joint] }],
                Couplings = [new Coupling { Kind = CouplingKind.Gear, A = At(Coordinate.AngularY), B = At(Coordinate.AngularX), Ratio = ratio }],
            }),
            SolverKind.Exact);

        static JointCoordinate At(Coordinate coordinate) => new() { Component = 1, Coordinate = coordinate };
    }

    private static World CoupledBall(Vector3d start, double aboutX, double slide)
    {
        const ConfigurableJointMotion free = ConfigurableJointMotion.Free, locked = ConfigurableJointMotion.Locked;
        var ball = new ConfigurableJoint
        {
            Anchor = start * -1, Axis = Vector3d.UnitX, SecondaryAxis = Vector3d.UnitY, XMotion = locked, YMotion = locked, ZMotion = locked,
            AngularXMotion = free, AngularYMotion = free, AngularZMotion = free,
        };
        return World.Create(
            SmallScene.Validate(new SceneDocument
            {
                GameObjects =
                [
                    Body("ball", start, new Rigidbody { Mass = 1.3, InertiaTensor = new Vector3d(aboutX, 0.11, 0.12), AngularDamping = 0, MaxAngularVelocity = 1000 }, ball),
                    Body("slide", new Vector3d(2, 0, 0), new Rigidbody { Mass = slide, InertiaTensor = new Vector3d(1, 1, 1) }, ball with { Anchor = Vector3d.Zero, XMotion = free, AngularXMotion = locked, AngularYMotion = locked, AngularZMotion = locked }),
                ],
                Couplings = [new Coupling { Kind = CouplingKind.Rack, A = At(0, Coordinate.AngularX), B = At(1, Coordinate.X), Ratio = Ratio }],
            }),
            SolverKind.Exact);

        static JointCoordinate At(int body, Coordinate coordinate) => new() { GameObject = body, Component = 1, Coordinate = coordinate };
        static GameObject Body(string id, Vector3d at, Rigidbody body, Joint joint) =>
            new() { Id = id, Name = id, Transform = SmallScene.At(new Pose(at, Quaterniond.Identity)), Components = [body, joint] };
    }
}
