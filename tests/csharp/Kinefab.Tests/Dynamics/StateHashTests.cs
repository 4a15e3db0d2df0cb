using System;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;
using Quaterniond = Kinefab.Numerics.Quaterniond;

namespace Kinefab.Tests.Dynamics;

public sealed class StateHashTests
{
    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void StateHash_AfterTheSameCalls_IsTheSame(SolverKind solver)
    {
        World world = Hinged(solver);
        ulong start = world.StateHash();
        WorldSnapshot snapshot = world.Snapshot();
        world.Step(0.02);
        ulong after = world.StateHash();

        world.Restore(snapshot);

        Assert.That((world.StateHash(), start != after), Is.EqualTo((start, true)));
        world.Step(0.02);
        Assert.That(world.StateHash(), Is.EqualTo(after));
    }

    // As the documentation has it, written once more.
    [Test]
    public void StateHash_IsFnv1aOverTheBytesOfPosesAndVelocities()
    {
        World world = Hinged(SolverKind.Unity);
        world.Step(0.02);
        ulong hash = 0xcbf29ce484222325;
        foreach (WorldBody body in world.Bodies)
        {
            Vector3d p = body.CenterOfMass;
            Quaterniond q = body.Pose.Rotation;
            (Vector3d v, Vector3d w) = (body.LinearVelocity, body.AngularVelocity);
            double[] state = [p.X, p.Y, p.Z, q.X, q.Y, q.Z, q.W, v.X, v.Y, v.Z, w.X, w.Y, w.Z];
            foreach (byte one in state.SelectMany(number => BitConverter.GetBytes(number)))
                hash = unchecked((hash ^ one) * 0x100000001b3);
        }

        Assert.That(world.StateHash(), Is.EqualTo(hash));
    }

    [Test]
    public void StateHash_OfOneBitMore_IsAnother()
    {
        World world = Hinged(SolverKind.Unity);
        ulong before = world.StateHash();

        world.Bodies[0].LinearVelocity = new Vector3d(0, 0, double.Epsilon);

        Assert.That(world.StateHash(), Is.Not.EqualTo(before));
    }

    private static World Hinged(SolverKind solver) =>
        SmallScene.Create(new HingeJoint { UseMotor = true, Motor = new JointMotor { Force = 3, TargetVelocity = 70 } }, connected: true, solver: solver);
}
