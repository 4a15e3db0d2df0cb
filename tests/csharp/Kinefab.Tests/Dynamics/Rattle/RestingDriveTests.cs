using System;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Tests.Kinematics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Drives without limit of force that come to a stop or a dead point: they stand there at the price of a plain step, and go on as soon as they can. Each
/// step had asked for a thousandth less, or for more again, and taken up to 2,000 parts for it.
/// </summary>
internal sealed class RestingDriveTests
{
    private const double Dt = 0.02;

    /// <summary>A drive that stands at a stop goes on when that is taken away: it had needed twenty steps to come back to its speed, in steps of any length.</summary>
    [TestCase(60, 30)]
    [TestCase(-60, -20)]
    public void DriveAt_StopThatIsTakenAway_GoesOnAtOnce(double speed, double stop)
    {
        const int stood = 100, after = 10;
        var joint = new HingeJoint
        {
            Axis = Vector3d.UnitZ,
            UseLimits = true,
            Limits = new JointLimits { Min = Math.Min(stop, -20), Max = Math.Max(stop, 30) },
        };
        World world = SmallScene.Create(joint, solver: SolverKind.Exact);
        world.Joints[0].DriveAt(Coordinate.Angle, speed);
        Run(world, stood);
        Assert.That(world.Joints[0].Coordinate(Coordinate.Angle), Is.EqualTo(stop).Within(1e-6));

        var hinge = (WorldHingeJoint)world.Joints[0];
        hinge.Settings = hinge.Settings with { Limits = new JointLimits { Min = -150, Max = 150 } };
        hinge.DriveAt(Coordinate.Angle, speed);
        Run(world, after);
        Assert.That((hinge.Coordinate(Coordinate.Angle) - stop) / speed, Is.GreaterThan(0.5 * after * Dt));
    }

    /// <summary>
    /// What pressed a joint against its stop lets go of it by 1e-8 rad when it rests. That was taken for a stop that is gone, at which a drive tries again,
    /// in every other step: of sizes at which ten tolerances are less than that, mostly of centimetres, 2,400 parts of joints a second instead of 16.
    /// </summary>
    [Test]
    public void DriveAt_AgainstTheStopOfAnotherJoint_RestsAtAnySize([Values(1, 0.1, 0.01)] double size, [Range(1, 8)] int seed)
    {
        const int steps = 120;
        var draw = new Draw(seed);
        double angle = draw.Between(0, 6), crank = size * draw.Between(0.2, 0.4), rod = size * draw.Between(0.6, 1);
        var elbow = new Vector3d(crank * Math.Cos(angle), crank * Math.Sin(angle), 0);
        var pin = new Vector3d(elbow.X + Math.Sqrt(rod * rod - elbow.Y * elbow.Y), 0, 0);
        var builder = new MechanismBuilder { Gravity = new Vector3d(0, -9.81 * size, 0) };
        int first = builder.Bar(Vector3d.Zero, elbow, 1, 0.05 * size), second = builder.Bar(elbow, pin, 1, 0.05 * size);
        int slider = builder.Body(pin, Quaterniond.Identity, 2, size * size * new Vector3d(0.01, 0.01, 0.01));
        RevoluteJoint driven = builder.Hinge(JointModel.World, first, Vector3d.Zero, Vector3d.UnitZ);
        driven.MotorEnabled = true;
        driven.MotorVelocity = draw.Between(-4, 4);
        RevoluteJoint limited = builder.Hinge(first, second, elbow, Vector3d.UnitZ);
        limited.LimitEnabled = true;
        limited.Limit = new AngularLimit { Lower = -draw.Between(1, 2), Upper = draw.Between(0.3, 1.3), Response = new LimitResponse { Restitution = 0.5 } };
        builder.Hinge(second, slider, pin, Vector3d.UnitZ);
        builder.Add(new D6Joint { X = AxisMotion.Free }, JointModel.World, slider, pin, Vector3d.UnitX);
        MultibodySystem m = builder.Build();
        var solver = new RattleSolver(m);
        for (int i = 0; i < steps; i++)
        {
            solver.Step(Dt);
        }

        Assert.That(m.SubstepWork, Is.LessThanOrEqualTo(2 * m.Joints.Length * steps));
        Assert.That(m.Stops, Is.Zero);
    }

    /// <summary>
    /// A flywheel of 1,000 kg m^2 geared up 300 times is more than a drive is reckoned to need in a step. While it comes it is not slowed down: it would
    /// be braked, slower and slower.
    /// </summary>
    [Test]
    public void DriveAt_HeavyGear_ComesToItsSpeed()
    {
        var scene = new SceneDocument
        {
            GameObjects = new[] { Wheel("slow", 0, 1), Wheel("fast", 1, 1000) },
            Couplings = new[] { new Coupling { Kind = CouplingKind.Gear, A = At(0), B = At(1), Ratio = 300 } },
        };
        World world = World.Create(SmallScene.Validate(scene), SolverKind.Exact);
        world.Joints[0].DriveAt(Coordinate.Angle, 60);
        Run(world, 10);
        double before = world.Joints[0].Coordinate(Coordinate.Angle);
        Run(world, 10);
        Assert.That(world.Joints[0].Coordinate(Coordinate.Angle) - before, Is.EqualTo(60 * 10 * Dt).Within(1e-6));

        static JointCoordinate At(int wheel) => new() { GameObject = wheel, Component = 1, Coordinate = Coordinate.Angle };

        static GameObject Wheel(string id, double x, double inertia) => new()
        {
            Id = id,
            Name = id,
            Transform = new Transform { LocalPosition = new Vector3d(x, 0, 0) },
            Components = new Component[]
            {
                new Rigidbody { Mass = 1, InertiaTensor = new Vector3d(inertia, inertia, inertia), AngularDamping = 0, MaxAngularVelocity = 1e5 },
                new HingeJoint { Axis = Vector3d.UnitZ },
            },
        };
    }

    /// <summary>A slider that drives its crank to a dead point stands there, swings little, and is named.</summary>
    [TestCase("M07", 1)]
    [TestCase("M07", -1)]
    [TestCase("M08", 1)]
    [TestCase("M08", -1)]
    public void DriveAt_ToADeadPoint_StandsThereAtThePriceOfAStep(string fixture, int side)
    {
        World world = UnreachableGoalTests.Fixture(fixture);
        WorldJoint slider = world.Joints.Single(joint => joint.Id == "slider" && joint.FreeCoordinates.Contains(Coordinate.X));
        slider.DriveAt(Coordinate.X, 0.4 * side);
        Run(world, 200);
        double work = world.SubstepWork, place = slider.Coordinate(Coordinate.X);
        Run(world, 100);
        Assert.That(slider.Coordinate(Coordinate.X), Is.EqualTo(place).Within(2e-3));
        Assert.That((world.SubstepWork - work) / world.Joints.Count / 100, Is.LessThanOrEqualTo(3));
        Assert.That(world.Stops, Is.Zero);
        Assert.That(world.Findings.Diagnostics.Select(found => found.Code), Does.Contain(DiagnosticCodes.DriveStalled));
    }

    /// <summary>
    /// A motor in a loop that it throws through dead points: what it might give followed from what the bodies had, so that each throw allowed a wider one,
    /// to 2e15 J and 472 stops.
    /// </summary>
    [Test]
    public void Step_MotorThatThrowsItsLoopAbout_GivesNoMoreThanABound()
    {
        var scene = new MachineScene(3000232);
        World world = scene.Build();
        double most = 0;
        for (int i = 1; i <= 200; i++)
        {
            scene.Before(world, i * scene.Step, scene.Step);
            world.Step(scene.Step);
            most = Math.Max(most, world.KineticEnergy);
        }

        Assert.That(most, Is.LessThanOrEqualTo(1e9));
        Assert.That(world.Stops, Is.Zero);
    }

    private static void Run(World world, int steps)
    {
        for (int i = 0; i < steps; i++)
        {
            world.Step(Dt);
        }
    }
}
