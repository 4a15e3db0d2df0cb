using System;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Joints that repeat each other share a load, and do not work against each other: what no body feels, a joint would break by. Such loads came of
/// rounding, and of drifts that begin far off, a thousand times what is carried and more.
/// </summary>
internal sealed class RedundantReactionTests
{
    private const double Dt = 0.02;

    /// <summary>Two blocks of a centimetre, one held to the other twice: their joints had 127 times their weight, and a step took sixty parts.</summary>
    [Test]
    public void BlocksThatAreHeldTwice_LoadTheirJointsByNoMoreThanTheyPull([Values(0.01, 0.1, 1)] double size, [Values(1, 11)] int count)
    {
        const double mostWeights = 6, mostParts = 8;
        const int steps = 300;
        double mass = 1000 * size * size * size;
        Rigidbody block = Block(mass, new Vector3d(1, 1, 1) * (mass * size * size / 6));
        World world = Make(
            count,
            new Vector3d(0, -9.81, 0),
            (block, Vector3d.Zero, new Kinefab.Document.Joint[] { new HingeJoint { Anchor = new Vector3d(0.1, 0.5, 0.3) * size, Axis = new Vector3d(1, 0.2, 0.1) } }),
            (block, new Vector3d(0, -size, 0), new Kinefab.Document.Joint[] { new FixedJoint { ConnectedBody = 0 }, Ball(new Vector3d(0.2, 0.4, 0) * size) }));
        double most = 0;
        for (int i = 0; i < steps; i++)
        {
            world.Step(Dt);
            most = Math.Max(most, world.Joints.Max(joint => joint.CurrentForce.Length));
        }

        Assert.That(most / (2 * mass * 9.81), Is.InRange(0.5, mostWeights));
        Assert.That(world.SubstepWork / world.Joints.Count / steps, Is.LessThanOrEqualTo(mostParts));
    }

    /// <summary>
    /// A light body on two hinges that cross, which a stiff spring would turn: 58 N m at a lever of about a metre. The hinges had 7e6 N, by which, over gaps of
    /// 1e-10 m, the whole that nothing holds lost 2e-5 of its angular momentum.
    /// </summary>
    [Test]
    public void HingesThatCross_HoldASpringWithItsLoad([Values(1, 11)] int count)
    {
        const double mostForce = 200, mostChange = 1e-7;
        var spin = new Vector3d(1, 2, -1);
        var away = new Vector3d(1, 0, 0);
        Rigidbody light = Block(0.0034, new Vector3d(2.6e-3, 4.5e-3, 4.5e-3)), heavy = Block(0.32, new Vector3d(0.05, 0.26, 0.28));
        World world = Make(
            count,
            Vector3d.Zero,
            (light, Vector3d.Zero, Array.Empty<Kinefab.Document.Joint>()),
            (heavy, away, new Kinefab.Document.Joint[]
            {
                new HingeJoint { ConnectedBody = 0, Anchor = new Vector3d(-0.8, 0.3, 0), Axis = new Vector3d(1, 0.5, 0) },
                new HingeJoint
                {
                    ConnectedBody = 0,
                    Anchor = new Vector3d(0.1, -0.6, 0.4),
                    Axis = new Vector3d(0, 0.3, 1),
                    UseSpring = true,
                    Spring = new JointSpring { Spring = 110, TargetPosition = 30 },
                },
            }));
        for (int i = 0; i < world.Bodies.Count; i += 2)
        {
            world.Bodies[i].AngularVelocity = spin;
            world.Bodies[i + 1].AngularVelocity = spin;
            world.Bodies[i + 1].LinearVelocity = Vector3d.Cross(spin, away);
        }

        Vector3d before = AngularMomentum(world);
        double most = 0;
        for (int i = 0; i < 100; i++)
        {
            world.Step(Dt);
            most = Math.Max(most, world.Joints.Max(joint => joint.CurrentForce.Length));
        }

        Assert.That(most, Is.InRange(1, mostForce));
        Assert.That((AngularMomentum(world) - before).Length / before.Length, Is.LessThanOrEqualTo(mostChange));
        Assert.That(world.SubstepWork, Is.Zero);
    }

    /// <summary>
    /// A crumb that a spring presses against what holds it twice: 0.06 N m at a lever of centimetres. What rounding makes of the load that its joints had
    /// against each other moves so light a body faster than the tolerance, and 11 kN of it stayed.
    /// </summary>
    [Test]
    public void CrumbThatIsHeldTwice_HoldsASpringWithItsLoad([Values(1, 11)] int count)
    {
        const double dt = 0.001, mostForce = 20;
        World world = Make(
            count,
            new Vector3d(0, -9.81, 0),
            (Block(1, new Vector3d(1, 1, 1)) with { IsKinematic = true }, Vector3d.Zero, Array.Empty<Kinefab.Document.Joint>()),
            (Block(2.4e-5, new Vector3d(1.4e-8, 5.3e-8, 4.8e-8)), new Vector3d(0.03, 0.05, -0.02), new Kinefab.Document.Joint[]
            {
                new HingeJoint
                {
                    ConnectedBody = 0,
                    Anchor = new Vector3d(0, 0.04, 0),
                    Axis = new Vector3d(0.63, 0.11, -0.46),
                    UseSpring = true,
                    Spring = new JointSpring { Spring = 0.0316, TargetPosition = 115 },
                },
                new ConfigurableJoint
                {
                    ConnectedBody = 0,
                    Anchor = new Vector3d(-0.04, 0, -0.04),
                    Axis = new Vector3d(0.62, -0.32, -0.98),
                    XMotion = ConfigurableJointMotion.Locked,
                    YMotion = ConfigurableJointMotion.Limited,
                    ZMotion = ConfigurableJointMotion.Locked,
                    AngularXMotion = ConfigurableJointMotion.Limited,
                    AngularYMotion = ConfigurableJointMotion.Locked,
                    AngularZMotion = ConfigurableJointMotion.Locked,
                    LinearLimit = new SoftJointLimit { Limit = 0.0013 },
                    LowAngularXLimit = new SoftJointLimit { Limit = -4 },
                    HighAngularXLimit = new SoftJointLimit { Limit = 2 },
                },
            }));
        for (int i = 1; i < world.Bodies.Count; i += 2)
        {
            world.Bodies[i].LinearVelocity = new Vector3d(0.15, -0.23, -0.32);
        }

        double most = 0;
        for (int i = 0; i < 20; i++)
        {
            world.Step(dt);
            most = Math.Max(most, world.Joints.Max(joint => joint.CurrentForce.Length));
        }

        Assert.That(most, Is.InRange(0.1, mostForce));
    }

    /// <summary>
    /// Two bodies, one a twelfth of the other's mass, that two joints hold to each other and nothing else, after a pull has ended: they turn with less than a
    /// radian a second, and of the drifts that lanes make side by side none took their joints' loads against each other off, 3.4 kN.
    /// </summary>
    [Test]
    public void PullThatHasEnded_LeavesNoLoad([Values(1, 11)] int count)
    {
        const double mostForce = 30;
        World world = Make(
            count,
            Vector3d.Zero,
            (Block(0.5, new Vector3d(0.03, 0.28, 0.31)), Vector3d.Zero, Array.Empty<Kinefab.Document.Joint>()),
            (Block(6, new Vector3d(0.8, 1.5, 0.9)), new Vector3d(1.1, 0.4, -0.3), new Kinefab.Document.Joint[]
            {
                new ConfigurableJoint
                {
                    ConnectedBody = 0,
                    Anchor = new Vector3d(-0.9, 0.2, 0.3),
                    Axis = new Vector3d(0.4, 0.1, -0.8),
                    SecondaryAxis = new Vector3d(0.3, 1, 0.2),
                    XMotion = ConfigurableJointMotion.Locked,
                    YMotion = ConfigurableJointMotion.Locked,
                    ZMotion = ConfigurableJointMotion.Limited,
                    LinearLimit = new SoftJointLimit { Limit = 0.086 },
                    AngularXMotion = ConfigurableJointMotion.Locked,
                    AngularYMotion = ConfigurableJointMotion.Locked,
                    AngularZMotion = ConfigurableJointMotion.Limited,
                    AngularZLimit = new SoftJointLimit { Limit = 150 },
                },
                new HingeJoint { ConnectedBody = 0, Anchor = new Vector3d(-0.3, -0.7, 0.5), Axis = new Vector3d(0.5, -0.6, 0.2) },
            }));
        double most = 0;
        for (int i = 0; i < 60; i++)
        {
            for (int body = 0; body < world.Bodies.Count && i < 6; body += 2)
            {
                world.Bodies[body].AddForceAtPosition(new Vector3d(5.1, -9.3, -7.2), world.Bodies[body].CenterOfMass + new Vector3d(0.7, 0.9, 1.2));
            }

            world.Step(Dt);
            most = Math.Max(most, world.Joints.Max(joint => joint.CurrentForce.Length));
        }

        Assert.That(most, Is.InRange(0.1, mostForce));
    }

    /// <summary>Four bars in space, all of whose hinges are parallel, one of them twice: four kinds of loads that its hinges may have against each other.</summary>
    [Test]
    public void FourBarsOnFiveHinges_LoadThemByNoMoreThanTheyPull([Values(1, 11)] int count)
    {
        const double mostWeights = 12, mass = 2.7;
        var axis = new Vector3d(0.2, 0.1, 1);
        Rigidbody bar = Block(0.9, new Vector3d(0.02, 0.1, 0.11));
        World world = Make(
            count,
            new Vector3d(0, -9.81, 0),
            (bar, new Vector3d(0, 0.5, 0), new Kinefab.Document.Joint[] { new HingeJoint { Anchor = new Vector3d(0, -0.5, 0), Axis = axis } }),
            (bar, new Vector3d(0.7, 1.1, 0), new Kinefab.Document.Joint[] { new HingeJoint { ConnectedBody = 0, Anchor = new Vector3d(-0.7, -0.1, 0), Axis = axis } }),
            (bar, new Vector3d(1.5, 0.6, 0), new Kinefab.Document.Joint[]
            {
                new HingeJoint { ConnectedBody = 1, Anchor = new Vector3d(-0.1, 0.6, 0), Axis = axis },
                new HingeJoint { Anchor = new Vector3d(0, -0.6, 0), Axis = axis },
                new HingeJoint { Anchor = new Vector3d(0, -0.6, 0) + 0.3 * axis, Axis = axis },
            }));
        double most = 0;
        for (int i = 0; i < 100; i++)
        {
            world.Step(Dt);
            most = Math.Max(most, world.Joints.Max(joint => joint.CurrentForce.Length));
        }

        Assert.That(most / (mass * 9.81), Is.InRange(0.3, mostWeights));
    }

    private static Rigidbody Block(double mass, Vector3d inertia) => new() { Mass = mass, InertiaTensor = inertia, AngularDamping = 0, MaxAngularVelocity = 1000 };

    private static ConfigurableJoint Ball(Vector3d anchor) => new()
    {
        XMotion = ConfigurableJointMotion.Locked,
        YMotion = ConfigurableJointMotion.Locked,
        ZMotion = ConfigurableJointMotion.Locked,
        Anchor = anchor,
        ConnectedBody = 0,
    };

    // As many of them side by side.
    private static World Make(int count, Vector3d gravity, params (Rigidbody Body, Vector3d At, Kinefab.Document.Joint[] Joints)[] bodies)
    {
        GameObject[] objects = Enumerable.Range(0, count * bodies.Length).Select(Object).ToArray();
        var document = new SceneDocument { GameObjects = objects, Physics = new Physics { Gravity = gravity } };
        return World.Create(SceneValidator.Validate(document).Scene ?? throw new InvalidOperationException(), SolverKind.Exact);

        GameObject Object(int i)
        {
            int first = i - i % bodies.Length;
            (Rigidbody body, Vector3d at, Kinefab.Document.Joint[] joints) = bodies[i % bodies.Length];
            return new GameObject
            {
                Id = $"B{i}",
                Name = $"B{i}",
                Transform = new Transform { LocalPosition = at + new Vector3d(0, 0, 10 * (i / bodies.Length)) },
                Components = joints.Select(joint => joint with { ConnectedBody = first + joint.ConnectedBody }).Prepend<Component>(body).ToArray(),
            };
        }
    }

    // About the origin.
    private static Vector3d AngularMomentum(World world)
    {
        Vector3d sum = Vector3d.Zero;
        foreach (WorldBody body in world.Bodies)
        {
            Quaterniond q = body.Pose.Rotation;
            sum += q * Vector3d.Scale(body.Settings.InertiaTensor, q.InverseRotate(body.AngularVelocity));
            sum += body.Settings.Mass * Vector3d.Cross(body.CenterOfMass, body.LinearVelocity);
        }

        return sum;
    }
}
