using System;
using System.Collections.Generic;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics;

/// <summary>Mechanisms without mercy: masses from 1 g to 1 t in one chain, inertias down to 1e-6, any limits and drives, anchors on each other.</summary>
internal static class RandomMechanism
{
    /// <summary>The mechanisms of some seeds, in one world.</summary>
    public static MultibodySystem Make(params int[] seeds)
    {
        var bodies = new List<BodyDefinition>();
        var joints = new List<JointModel>();
        foreach (int seed in seeds)
        {
            (BodyDefinition[] ownBodies, JointModel[] ownJoints) = Parts(seed);
            foreach (JointModel joint in ownJoints)
            {
                joint.Body0 += joint.Body0 == JointModel.World ? 0 : bodies.Count;
                joint.Body1 += joint.Body1 == JointModel.World ? 0 : bodies.Count;
            }

            bodies.AddRange(ownBodies);
            joints.AddRange(ownJoints);
        }

        return new MultibodySystem(new Bodies(bodies.ToArray()), joints.ToArray(), []);
    }

    private static (BodyDefinition[] Bodies, JointModel[] Joints) Parts(int seed)
    {
        var random = new Random(seed);
        var bodies = new BodyDefinition[random.Next(1, 8)];
        for (int i = 0; i < bodies.Length; i++)
        {
            double mass = Math.Pow(10, Between(random, -3, 3));
            bodies[i] = BodyDefinition.Default with
            {
                Pose = new Pose(Point(random, 1), Turn(random)),
                Mass = mass,
                Inertia = new Vector3d(Inertia(random, mass), Inertia(random, mass), Inertia(random, mass)),
                LinearVelocity = Point(random, 3),
                AngularVelocity = Point(random, 10),
                MaxAngularSpeed = random.Next(2) == 0 ? 7 : double.PositiveInfinity,
                IsKinematic = random.Next(10) == 0,
            };
        }

        var joints = new JointModel[random.Next(1, 9)];
        for (int i = 0; i < joints.Length; i++)
        {
            joints[i] = random.Next(3) == 0 ? Revolute(random) : D6(random);
            joints[i].Body0 = random.Next(-1, bodies.Length);
            joints[i].Body1 = bodies.Length > 1 ? (joints[i].Body0 + 1 + random.Next(bodies.Length - 1) + bodies.Length) % bodies.Length : 0;
            if (joints[i].Body0 == joints[i].Body1)
            {
                joints[i].Body0 = JointModel.World;
            }

            joints[i].Frame0 = new Pose(random.Next(4) == 0 ? Vector3d.Zero : Point(random, 1), Turn(random));
            joints[i].Frame1 = new Pose(random.Next(4) == 0 ? Vector3d.Zero : Point(random, 1), Turn(random));
            joints[i].Projection = random.Next(5) == 0;
            joints[i].ProjectionLinearTolerance = 0.01;
            joints[i].ProjectionAngularTolerance = 0.1;
            joints[i].Preprocessing = random.Next(4) != 0;
        }

        return (bodies, joints);
    }

    /// <summary>1e-4 to 0.1 s.</summary>
    public static double Step(int seed) => Math.Pow(10, Between(new Random(seed), -4, -1));

    private static RevoluteJoint Revolute(Random random) => new()
    {
        LimitEnabled = random.Next(2) == 0,
        Limit = new AngularLimit { Lower = Between(random, -3, 0.5), Upper = Between(random, -0.5, 3), Response = Response(random) },
        MotorEnabled = random.Next(3) == 0,
        MotorVelocity = Between(random, -50, 50),
        MotorForceLimit = random.Next(2) == 0 ? double.PositiveInfinity : 1,
        MotorFreeSpin = random.Next(2) == 0,
        Spring = Drive(random),
    };

    private static D6Joint D6(Random random)
    {
        AxisMotion Motion() => (AxisMotion)random.Next(3);
        return new D6Joint
        {
            X = Motion(),
            Y = Motion(),
            Z = Motion(),
            Twist = Motion(),
            Swing1 = Motion(),
            Swing2 = Motion(),
            LinearLimit = new LinearLimit { Value = random.Next(3) == 0 ? 0 : Between(random, 0, 1), Response = Response(random) },
            TwistLimit = new AngularLimit { Lower = Between(random, -3, 0), Upper = Between(random, 0, 3), Response = Response(random) },
            SwingLimit = new ConeLimit { Y = Between(random, 1e-4, 3), Z = Between(random, 1e-4, 3), Response = Response(random) },
            DriveX = Drive(random),
            DriveTwist = Drive(random),
            DriveSwing = Drive(random),
            DriveSlerp = Drive(random),
            DrivePose = new Pose(Point(random, 1), Turn(random)),
            DriveLinearVelocity = Point(random, 5),
            DriveAngularVelocity = Point(random, 20),
        };
    }

    private static LimitResponse Response(Random random) => new()
    {
        Stiffness = random.Next(3) == 0 ? Math.Pow(10, Between(random, 0, 7)) : 0,
        Damping = random.Next(3) == 0 ? Math.Pow(10, Between(random, -2, 4)) : 0,
        Restitution = random.Next(2),
        ContactDistance = Between(random, 0, 0.2),
    };

    private static DriveModel Drive(Random random) => random.Next(2) == 0
        ? default
        : new DriveModel
        {
            Stiffness = Math.Pow(10, Between(random, -1, 8)),
            Damping = Math.Pow(10, Between(random, -2, 5)),
            ForceLimit = random.Next(2) == 0 ? double.PositiveInfinity : Between(random, 0, 100),
            IsAcceleration = random.Next(2) == 0,
        };

    private static double Inertia(Random random, double mass) => Math.Max(1e-6, mass * Math.Pow(10, Between(random, -6, 0)));

    private static Quaterniond Turn(Random random)
    {
        Quaterniond q = new(Between(random, -1, 1), Between(random, -1, 1), Between(random, -1, 1), Between(random, -1, 1));
        return random.Next(4) == 0 ? Quaterniond.Identity : q.Normalized();
    }

    private static Vector3d Point(Random random, double size) => new(Between(random, -size, size), Between(random, -size, size), Between(random, -size, size));

    private static double Between(Random random, double low, double high) => low + (high - low) * random.NextDouble();
}
