using System;
using Kinefab.Document;
using Kinefab.Dynamics;
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
}
