using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>What hangs on nothing keeps its momentum and angular momentum, whatever its account of energy takes from its speeds: that changed them by up to a thousandth.</summary>
internal sealed class FloatingMomentumTests
{
    [TestCase(1, 0.02)]
    [TestCase(2, 0.02)]
    [TestCase(3, 1.0 / 60)]
    [TestCase(4, 1.0 / 30)]
    [TestCase(5, 1.0 / 240)]
    public void ChainThatWhirls_KeepsBoth(int seed, double dt)
    {
        var random = new Random(seed);
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        Vector3d from = Vector3d.Zero;
        int before = -1;
        for (int i = 0; i < 4; i++)
        {
            Vector3d to = from + 0.4 * Random(random);
            int bar = b.Bar(from, to, 0.3 + random.NextDouble());
            b.Change(bar, d => d with { LinearVelocity = 3 * Random(random), AngularVelocity = 12 * Random(random) });
            if (before >= 0)
            {
                RevoluteJoint hinge = b.Hinge(before, bar, from, Random(random));
                hinge.LimitEnabled = i == 2;
                hinge.Limit = new AngularLimit { Lower = -0.7, Upper = 0.4, Response = new LimitResponse { Restitution = 0.5 } };
            }

            before = bar;
            from = to;
        }

        MultibodySystem m = b.Build();
        (Vector3d linear, Vector3d angular) = Momenta(m);
        var solver = new RattleSolver(m);
        for (int i = 0; i < 300; i++)
        {
            solver.Step(dt);
        }

        (Vector3d linearAfter, Vector3d angularAfter) = Momenta(m);
        Assert.That(m.Stops, Is.Zero);
        Assert.That((linearAfter - linear).Length, Is.LessThanOrEqualTo(1e-9 * linear.Length));
        Assert.That((angularAfter - angular).Length, Is.LessThanOrEqualTo(1e-8 * angular.Length));
    }

    private static (Vector3d Linear, Vector3d Angular) Momenta(MultibodySystem m)
    {
        Vector3d linear = Vector3d.Zero, angular = Vector3d.Zero;
        for (int i = 0; i < m.Bodies.Count; i++)
        {
            Vector3d momentum = (1 / m.Bodies.InverseMasses[i]) * m.Bodies.LinearVelocities[i];
            Quaterniond q = m.Bodies.Poses[i].Rotation;
            Vector3d inverse = m.Bodies.InverseInertias[i];
            Vector3d turn = q.InverseRotate(m.Bodies.AngularVelocities[i]);
            linear += momentum;
            angular += Vector3d.Cross(m.Bodies.Poses[i].Position, momentum) + q * new Vector3d(turn.X / inverse.X, turn.Y / inverse.Y, turn.Z / inverse.Z);
        }

        return (linear, angular);
    }

    private static Vector3d Random(Random random) => new(random.NextDouble() - 0.5, random.NextDouble() - 0.5, random.NextDouble() - 0.5);
}
