using System.Linq;
using Kinefab.Joints;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Which bodies the kinematics' joints hold to which, in <see cref="JointEndScene"/>.</summary>
public sealed class JointEndTests
{
    [Test]
    public void Ends_EveryKind_AreTheScenes()
    {
        Mechanism mechanism = Mechanism.Create(JointEndScene.Make());

        Assert.That(Enumerable.Range(0, mechanism.BodyCount).Select(i => Name(mechanism, i)), Is.EqualTo(JointEndScene.Bodies));
        Assert.That(mechanism.Joints.Select(j => Name(mechanism, j.Body0) + "-" + Name(mechanism, j.Body1)), Is.EqualTo(JointEndScene.Ends));
    }

    [Test]
    public void Drive_TheArm_CarriesItsChildrenButNotWhatHangsOnInactiveOnes()
    {
        ValidScene scene = JointEndScene.Make();
        Mechanism mechanism = Mechanism.Create(scene);
        var solver = new PositionSolver(mechanism);
        MechanismState state = mechanism.NewState();

        solver.Drive(state, mechanism.CoordinateNamed("arm.angle"), -10);

        // The connected object itself, inactive, goes with the arm as a Transform does.
        Assert.That(Way("nested"), Is.GreaterThan(0.05));
        Assert.That(Way("deep"), Is.GreaterThan(0.05));
        Assert.That(Way("off"), Is.GreaterThan(0.05));
        Assert.That(Way("below"), Is.GreaterThan(0.05));
        Assert.That(Way("hung"), Is.LessThan(1e-12));
        Assert.That(Way("hungBelow"), Is.LessThan(1e-12));
        Assert.That(Way("kinematic"), Is.Zero);
        Assert.That(Way("onKinematic"), Is.LessThan(1e-12));

        double Way(string id)
        {
            int gameObject = mechanism.GameObjectNamed(id);
            return (state.Pose(gameObject).Position - scene.WorldTransform(gameObject).Pose.Position).Length;
        }
    }

    private static string Name(Mechanism mechanism, int body) =>
        body == JointModel.World ? "world" : mechanism.Scene.Document.GameObjects[mechanism.GameObjects[body]].Id;
}
