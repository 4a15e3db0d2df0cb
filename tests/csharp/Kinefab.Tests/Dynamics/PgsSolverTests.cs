using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Pgs;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

public sealed class PgsSolverTests
{
    [Test]
    public void Step_RandomMechanisms_NeverGivesNaN()
    {
        for (int seed = 0; seed < 500; seed++)
        {
            MultibodySystem mechanism = RandomMechanism.Make(seed);
            var solver = new PgsSolver(mechanism);
            double dt = RandomMechanism.Step(seed);
            for (int step = 0; step < 20; step++)
            {
                solver.Step(dt);
            }

            Assert.That(mechanism.Bodies.Poses.All(p => p.Position.IsFinite && p.Rotation.LengthSquared is > 0.99 and < 1.01), $"seed {seed}");
            Assert.That(mechanism.Bodies.AngularVelocities.All(w => w.IsFinite), $"seed {seed}");
        }
    }

    [Test]
    public void Step_MotionBeyondNumbers_StopsTheBodyAndCountsIt()
    {
        var bodies = new Bodies([BodyDefinition.Default with { LinearVelocity = new Vector3d(1e300, 0, 0) }]);
        var mechanism = new MultibodySystem(bodies, [], []);

        new PgsSolver(mechanism).Step(0.02);

        Assert.That(mechanism.Stops, Is.EqualTo(1));
        Assert.That(bodies.Poses[0].Position, Is.EqualTo(Vector3d.Zero));
    }

    [Test]
    public void Step_BrokenJoint_LeavesTheOrderToTheOthers()
    {
        // Three bodies in a row; the middle joint cannot hold and goes, the other two still do.
        BodyDefinition[] bodies = [.. Enumerable.Range(0, 3).Select(i => BodyDefinition.Default with { Pose = new Pose(new Vector3d(i, 0, 0), Quaterniond.Identity) })];
        JointModel[] joints = [.. Enumerable.Range(0, 3).Select(i => new RevoluteJoint
        {
            Body0 = i - 1,
            Body1 = i,
            Frame0 = new Pose(new Vector3d(i == 0 ? -0.5 : 0.5, 0, 0), Quaterniond.AxisAngle(Vector3d.UnitY, -1.5707963267948966)),
            Frame1 = new Pose(new Vector3d(-0.5, 0, 0), Quaterniond.AxisAngle(Vector3d.UnitY, -1.5707963267948966)),
            BreakForce = i == 1 ? 1 : double.PositiveInfinity,
        })];
        var mechanism = new MultibodySystem(new Bodies(bodies), joints, []);
        var solver = new PgsSolver(mechanism);

        for (int i = 0; i < 50; i++)
        {
            solver.Step(0.02);
        }

        Assert.That(joints.Select(j => j.IsBroken), Is.EqualTo([false, true, false]));
        Pose anchor0 = mechanism.Bodies.Poses[0] * joints[0].Frame1;
        Assert.That((anchor0.Position - new Vector3d(-0.5, 0, 0)).Length, Is.LessThan(0.01));
        Vector3d gap = (mechanism.Bodies.Poses[1] * joints[2].Frame0).Position - (mechanism.Bodies.Poses[2] * joints[2].Frame1).Position;
        Assert.That(gap.Length, Is.LessThan(0.01));
        Assert.That(mechanism.Bodies.Poses[1].Position.Y, Is.LessThan(-3), "the outer two fall together");
    }
}
