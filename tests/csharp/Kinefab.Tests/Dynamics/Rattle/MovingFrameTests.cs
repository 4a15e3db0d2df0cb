using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// A mechanism on a base that goes on evenly moves as on one that stands, and one that hangs on nothing as if its centre stood (Galilei). The energy of the
/// first was held in the world's frame, where the base gives and takes without end: pendulums gained 0.76 % in their own in steps of 1/60 s. That of
/// the second was held to a share of its way's, in which 2.7 % of its own are little.
/// </summary>
internal sealed class MovingFrameTests
{
    private const double Dt = 1.0 / 60;
    private const int Steps = 200;

    private static readonly Vector3d[] Velocities = { new(1, 0, 0), new(-0.013, 0.2, 0.0071), new(3, -40, 17) };

    private static readonly string[] Mechanisms = { "hinges", "slide", "limits", "spring", "ball", "two bases", "floating" };

    [Test]
    public void Mechanism_MovesAsWhereItsFrameStands([ValueSource(nameof(Mechanisms))] string mechanism, [Values(0, 1, 2)] int velocity, [Values(1, 11)] int count)
    {
        const double tolerance = 1e-7;
        World still = Make(mechanism, count, Vector3d.Zero), moving = Make(mechanism, count, Velocities[velocity]);

        // What floats turns so fast that rounding is 1e-7 after 150 steps.
        int steps = mechanism == "floating" ? 120 : Steps;
        for (int i = 1; i <= steps; i++)
        {
            Step(still, i, Vector3d.Zero);
            Step(moving, i, Velocities[velocity]);
            for (int b = 0; b < still.Bodies.Count; b++)
            {
                Vector3d way = moving.Bodies[b].Pose.Position - i * Dt * Velocities[velocity] - still.Bodies[b].Pose.Position;
                Vector3d speed = moving.Bodies[b].LinearVelocity - Velocities[velocity] - still.Bodies[b].LinearVelocity;
                Assert.That(Math.Max(way.Length, Dt * speed.Length), Is.LessThanOrEqualTo(tolerance), $"step {i}, {still.Bodies[b].Id}");
            }
        }

        Assert.That(moving.SubstepWork, Is.EqualTo(still.SubstepWork));
    }

    private static void Step(World world, int step, Vector3d velocity)
    {
        foreach (WorldBody body in world.Bodies.Where(body => body.IsKinematic))
        {
            Vector3d start = body.Id.EndsWith('C') ? Far : Vector3d.Zero;
            body.KinematicTarget = new Pose(start + new Vector3d(0, 0, Place(body)) + step * Dt * velocity, body.Pose.Rotation);
        }

        world.Step(Dt);
    }

    private static Vector3d Far => new(2.1, 0.3, 0);

    private static double Place(WorldBody body) => int.Parse(body.Id.Split(' ')[0], System.Globalization.CultureInfo.InvariantCulture);

    private static World Make(string mechanism, int count, Vector3d velocity)
    {
        var objects = new List<GameObject>();
        for (int i = 0; i < count; i++)
        {
            int first = objects.Count;
            var at = new Vector3d(0, 0, i);
            Add($"{i} A", at, mechanism == "floating" ? Link(0.8, 0.9) : new Rigidbody { IsKinematic = true });
            var axis = new Vector3d(0.1, 0.05 + 0.01 * i, 1);
            switch (mechanism)
            {
                case "hinges":
                case "floating":
                    Add($"{i} B", at + new Vector3d(0.6, -0.1, 0), Link(1.3, 0.7), Hinge(first, new Vector3d(-0.6, 0, 0), axis));
                    Add($"{i} D", at + new Vector3d(1.4, 0.1, 0.1), Link(0.4, 0.5), Hinge(first + 1, new Vector3d(-0.4, 0.05, 0), axis));
                    break;
                case "limits":
                    Add($"{i} B", at + new Vector3d(0.6, -0.1, 0), Link(1.3, 0.7), Hinge(first, new Vector3d(-0.6, 0, 0), axis) with
                    {
                        UseLimits = true,
                        Limits = new JointLimits { Min = -20, Max = 40, Bounciness = 0.3 },
                    });
                    break;
                case "spring":
                    Add($"{i} B", at + new Vector3d(0.6, -0.1, 0), Link(1.3, 0.7), Hinge(first, new Vector3d(-0.6, 0, 0), axis) with
                    {
                        UseSpring = true,
                        Spring = new JointSpring { Spring = 30, Damper = 0.02, TargetPosition = 25 },
                    });
                    break;
                case "slide":
                    Add($"{i} B", at + new Vector3d(0.6, -0.1, 0), Link(1.3, 0.7), new ConfigurableJoint
                    {
                        ConnectedBody = first,
                        Axis = axis,
                        XMotion = ConfigurableJointMotion.Locked,
                        YMotion = ConfigurableJointMotion.Free,
                        ZMotion = ConfigurableJointMotion.Locked,
                        AngularXMotion = ConfigurableJointMotion.Locked,
                        AngularYMotion = ConfigurableJointMotion.Locked,
                        AngularZMotion = ConfigurableJointMotion.Locked,
                        YDrive = new JointDrive { PositionSpring = 40, MaximumForce = 1e6 },
                    });
                    Add($"{i} D", at + new Vector3d(1.1, -0.1, 0), Link(0.5, 0.4), Hinge(first + 1, new Vector3d(-0.5, 0, 0), axis));
                    break;
                case "ball":
                    Add($"{i} B", at + new Vector3d(0.6, -0.1, 0), Link(1.3, 0.7), Ball(first, new Vector3d(-0.6, 0, 0)));
                    break;
                default:
                    Add($"{i} C", at + Far, new Rigidbody { IsKinematic = true });
                    Add($"{i} B", at + new Vector3d(0.6, -0.1, 0), Link(1.3, 0.7), Ball(first, new Vector3d(-0.6, 0.1, 0)));
                    Add($"{i} D", at + new Vector3d(1.6, 0, 0), Link(0.4, 0.5), Ball(first + 2, new Vector3d(-0.5, 0, 0)), Ball(first + 1, new Vector3d(0.5, 0.3, 0)));
                    break;
            }
        }

        var document = new SceneDocument { GameObjects = objects };
        World world = World.Create(SceneValidator.Validate(document).Scene ?? throw new InvalidOperationException(), SolverKind.Exact);
        foreach (WorldBody body in world.Bodies)
        {
            body.LinearVelocity = body.IsKinematic ? Vector3d.Zero : velocity;
            body.AngularVelocity = body.IsKinematic ? Vector3d.Zero : (mechanism == "floating" ? 3 : 1) * new Vector3d(0.3, -0.2, body.Id.EndsWith('B') ? 9 : -14);
        }

        return world;

        void Add(string id, Vector3d at, Rigidbody body, params Kinefab.Document.Joint[] joints) =>
            objects.Add(new GameObject { Id = id, Name = id, Transform = new Transform { LocalPosition = at }, Components = joints.Prepend<Component>(body).ToArray() });
    }

    private static Rigidbody Link(double mass, double length) => new()
    {
        Mass = mass,
        InertiaTensor = new Vector3d(0.02, 1, 1.01) * (mass * length * length / 12),
        AngularDamping = 0,
        MaxAngularVelocity = 1000,
    };

    private static HingeJoint Hinge(int to, Vector3d anchor, Vector3d axis) => new() { ConnectedBody = to, Anchor = anchor, Axis = axis };

    private static ConfigurableJoint Ball(int to, Vector3d anchor) => new()
    {
        ConnectedBody = to,
        Anchor = anchor,
        XMotion = ConfigurableJointMotion.Locked,
        YMotion = ConfigurableJointMotion.Locked,
        ZMotion = ConfigurableJointMotion.Locked,
    };
}
