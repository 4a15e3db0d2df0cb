using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>Which bodies the dynamics' joints hold to which, in <see cref="JointEndScene"/>.</summary>
public sealed class JointEndTests
{
    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Ends_EveryKind_AreTheScenes(SolverKind solver)
    {
        World world = World.Create(JointEndScene.Make(), solver);

        Assert.That(world.Bodies.Select(b => b.Id), Is.EqualTo(JointEndScene.Bodies));
        Assert.That(world.Joints.Select(j => Name(world, j.Solved.Body0) + "-" + Name(world, j.Solved.Body1)), Is.EqualTo(JointEndScene.Ends));
    }

    [TestCase(SolverKind.Unity, 0.05)]
    [TestCase(SolverKind.Exact, 1e-9)]
    public void Coordinates_AfterASwing_AreThoseThatKinematicsReads(SolverKind solver, double degrees)
    {
        ValidScene scene = JointEndScene.Make();
        World world = World.Create(scene, solver);
        MechanismState state = Mechanism.Create(scene).NewState();

        SmallScene.Run(world, 0.5);
        state.SetPoses(world.Bodies.Select(b => b.GameObject).ToArray(), world.Bodies.Select(b => b.Pose).ToArray());

        Assert.That(world.Joints.Select(j => j.Coordinate(Kinefab.Document.Coordinate.Angle)).Min(), Is.LessThan(-20), "they swing");
        foreach (WorldJoint joint in world.Joints)
        {
            Assert.That(state.Coordinate(joint.Id + ".angle"), Is.EqualTo(joint.Coordinate(Kinefab.Document.Coordinate.Angle)).Within(degrees), joint.Id);
        }
    }

    [TestCase("hung")]
    [TestCase("hungBelow")]
    public void Anchor_ConnectedBodyInactive_StaysWhereItStood(string id)
    {
        World world = World.Create(JointEndScene.Make(), SolverKind.Exact);
        WorldBody hung = world.Bodies.Single(b => b.Id == id);
        var anchor = new Vector3d(-0.3, 0.05, 0);
        Vector3d before = hung.Pose.Point(anchor);

        SmallScene.Run(world, 0.3);

        Assert.That((hung.Pose.Point(anchor) - before).Length, Is.LessThan(1e-9));
    }

    private static string Name(World world, int body) => body == JointModel.World ? "world" : world.Bodies[body].Id;
}
