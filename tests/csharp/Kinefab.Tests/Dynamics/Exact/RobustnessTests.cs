using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Exact;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Exact;

/// <summary>No scene, however unkind, makes a number that is none.</summary>
internal sealed class RobustnessTests
{
    [Test]
    public void Step_RandomScenes_StayFinite()
    {
        for (int seed = 0; seed < 600; seed++)
        {
            var random = new Random(seed);
            MultibodySystem mechanism = RandomScene(random);
            var solver = new ExactSolver(mechanism);
            double dt = Math.Pow(10, -4 + 3 * random.NextDouble());
            for (int i = 0; i < 8; i++)
            {
                solver.Step(dt);
            }

            Assert.That(IsFinite(mechanism), Is.True, $"seed {seed}");
        }
    }

    [TestCase(1e-4)]
    [TestCase(0.1)]
    public void Step_MassesFromGramToTonne_StayFiniteAndClosed(double dt)
    {
        var b = new MechanismBuilder();
        int last = Joint.World;
        double[] masses = { 1e-3, 1e3, 1, 1e-3, 1e3 };
        for (int i = 0; i < masses.Length; i++)
        {
            int bar = b.Bar(new Vector3d(0.5 * i, 0, 0), new Vector3d(0.5 * (i + 1), 0, 0), masses[i]);
            b.Hinge(last, bar, new Vector3d(0.5 * i, 0, 0), Vector3d.UnitZ);
            last = bar;
        }

        MultibodySystem m = b.Build();
        var solver = new ExactSolver(m);
        for (int i = 0; i < 200; i++)
        {
            solver.Step(dt);
        }

        Assert.That(IsFinite(m), Is.True);
        if (dt < 0.01)
        {
            Assert.That(MechanismMeasures.Drift(m), Is.LessThanOrEqualTo(1e-8));
        }
    }

    private static MultibodySystem RandomScene(Random random)
    {
        var b = new MechanismBuilder();
        int bodies = random.Next(1, 6);
        for (int i = 0; i < bodies; i++)
        {
            double mass = Math.Pow(10, -3 + 6 * random.NextDouble());
            double scale = Math.Pow(10, -6 + 5 * random.NextDouble()) * mass;
            BodyDefinition d = BodyDefinition.Default;
            d.Pose = new Pose(Vector(random), new Quaterniond(random.NextDouble(), random.NextDouble(), random.NextDouble(), 1).Normalized());
            d.Mass = mass;
            d.Inertia = new Vector3d(1 + random.NextDouble(), 1 + random.NextDouble(), 1 + random.NextDouble()) * scale;
            d.AngularVelocity = Vector(random) * 5;
            d.IsKinematic = random.Next(12) == 0;
            b.Body(d);
        }

        int joints = random.Next(0, bodies + 3);
        for (int j = 0; j < joints; j++)
        {
            int body0 = random.Next(-1, bodies);
            int body1 = random.Next(-1, bodies);
            if (body0 == body1)
            {
                continue;
            }

            // Coincident anchors, degenerate axes and frames that do not meet are all in it.
            Vector3d axis = random.Next(8) == 0 ? Vector3d.Zero : Vector(random);
            Vector3d point = random.Next(4) == 0 ? Vector3d.Zero : Vector(random);
            var frame = new Pose(point, axis == Vector3d.Zero
                ? Quaterniond.Identity
                : Quaterniond.FromAxes(axis.Normalized(), Vector3d.Perpendicular(axis.Normalized()), Vector3d.Cross(axis.Normalized(), Vector3d.Perpendicular(axis.Normalized()))));
            Joint joint = random.Next(3) == 0 ? RandomHinge(random) : RandomD6(random);
            b.Add(joint, body0, body1, frame);
            if (random.Next(5) == 0)
            {
                joint.Frame1 = new Pose(joint.Frame1.Position + Vector(random) * 0.1, joint.Frame1.Rotation);
            }
        }

        return b.Build();
    }

    private static RevoluteJoint RandomHinge(Random random) => new()
    {
        LimitEnabled = random.Next(2) == 0,
        Limit = new AngularLimit { Lower = -random.NextDouble(), Upper = random.NextDouble() - 0.1, Response = RandomResponse(random) },
        MotorEnabled = random.Next(3) == 0,
        MotorVelocity = 10 * random.NextDouble(),
        MotorForceLimit = 100 * random.NextDouble(),
        Spring = RandomDrive(random),
    };

    private static D6Joint RandomD6(Random random) => new()
    {
        X = (AxisMotion)random.Next(3), Y = (AxisMotion)random.Next(3), Z = (AxisMotion)random.Next(3),
        Twist = (AxisMotion)random.Next(3), Swing1 = (AxisMotion)random.Next(3), Swing2 = (AxisMotion)random.Next(3),
        LinearLimit = new LinearLimit { Value = random.NextDouble(), Response = RandomResponse(random) },
        TwistLimit = new AngularLimit { Lower = -random.NextDouble(), Upper = random.NextDouble(), Response = RandomResponse(random) },
        SwingLimit = new ConeLimit { Y = 0.1 + random.NextDouble(), Z = 0.1 + random.NextDouble(), Response = RandomResponse(random) },
        DriveX = RandomDrive(random), DriveTwist = RandomDrive(random), DriveSwing = RandomDrive(random), DriveSlerp = RandomDrive(random),
    };

    private static LimitResponse RandomResponse(Random random) => random.Next(2) == 0
        ? new LimitResponse { Restitution = random.NextDouble(), BounceThreshold = 0.2 }
        : new LimitResponse { Stiffness = Math.Pow(10, 6 * random.NextDouble()), Damping = Math.Pow(10, 3 * random.NextDouble()) };

    private static JointDrive RandomDrive(Random random) => random.Next(2) == 0
        ? default
        : new JointDrive
        {
            Stiffness = Math.Pow(10, 6 * random.NextDouble()), Damping = Math.Pow(10, 4 * random.NextDouble()),
            ForceLimit = random.Next(2) == 0 ? double.PositiveInfinity : 100 * random.NextDouble(), IsAcceleration = random.Next(2) == 0,
        };

    private static Vector3d Vector(Random random) => new(2 * random.NextDouble() - 1, 2 * random.NextDouble() - 1, 2 * random.NextDouble() - 1);

    private static bool IsFinite(MultibodySystem m)
    {
        for (int i = 0; i < m.Bodies.Count; i++)
        {
            Pose p = m.Bodies.Poses[i];
            if (!p.Position.IsFinite || !p.Rotation.Vector.IsFinite || double.IsNaN(p.Rotation.W)
                || !m.Bodies.LinearVelocities[i].IsFinite || !m.Bodies.AngularVelocities[i].IsFinite)
            {
                return false;
            }
        }

        return true;
    }
}
