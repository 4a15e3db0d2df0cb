using System;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Bodies whose rotations are frozen, at joints that ask for a turn that they do not make.</summary>
public sealed class FrozenRotationTests
{
    [TestCase(-0.2655, -0.6353, 0.7252)]
    [TestCase(0.9, -0.4, 0.1)]
    [TestCase(0.3, 0.8, 0.5)]
    public void HingeAcrossTheOnlyAxisThatTurns_HoldsTheBodyStill(double x, double y, double z)
    {
        var body = new Rigidbody
        {
            Mass = 1.6,
            InertiaTensor = new Vector3d(0.105, 0.158, 0.073),
            CenterOfMass = new Vector3d(0.5, 0.07, 0.25),
            AngularDamping = 0,
            Constraints = RigidbodyConstraints.FreezeRotationY | RigidbodyConstraints.FreezeRotationZ,
        };
        World world = SmallScene.Create(new HingeJoint { Axis = new Vector3d(x, y, z) }, body, solver: SolverKind.Exact);
        world.Gravity = new Vector3d(0, -9.81, 0);
        double most = 0;

        for (int i = 0; i < 200; i++)
        {
            world.Step(0.02);
            most = Math.Max(most, world.KineticEnergy);
        }

        Assert.That(most, Is.LessThan(1e-9), "It cannot move: what moves came from nothing.");
        Assert.That(world.Stops, Is.Zero);
    }

    /// <summary>The hinge's axis turns away, and the body may not follow: it was open by 1.7 degrees a step without a word, 7e-6 rad in each of thousands of parts.</summary>
    [Test]
    public void HingeThatIsTurnedAwayFromABodyThatCannotFollow_IsNotOpenWithoutAWord()
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int hand = b.Body(BodyDefinition.Default with { IsKinematic = true });
        int body = b.Body(new Vector3d(0.9, -0.5, -1), Quaterniond.Identity, 1.49, new Vector3d(0.003, double.PositiveInfinity, double.PositiveInfinity));
        RevoluteJoint hinge = b.Hinge(hand, body, new Vector3d(0.7, -0.2, -0.8), new Vector3d(0.87, -0.43, 0.24));
        MultibodySystem m = b.Build();
        var solver = new RattleSolver(m);
        Vector3d axis = new Vector3d(0.2, 0.63, -0.38).Normalized();
        for (int i = 1; i <= 5; i++)
        {
            m.Bodies.KinematicTargets[hand] = new Pose(Vector3d.Zero, Quaterniond.AxisAngle(axis, 0.015 * i));
            solver.Step(0.02);
            Vector3d first = m.Bodies.PoseOf(hinge.Body0).Rotation * hinge.Frame0.Rotation * Vector3d.UnitX;
            Vector3d second = m.Bodies.PoseOf(hinge.Body1).Rotation * hinge.Frame1.Rotation * Vector3d.UnitX;
            Assert.That(Vector3d.Cross(first, second).Length < 1e-6 || m.Stops > 0, $"step {i}");
        }

        Assert.That(m.Stops, Is.Positive);
    }
}
