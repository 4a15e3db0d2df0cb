using System.IO;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.NUnit;
using Kinefab.Validation;
using NUnit.Framework;
using static Kinefab.NUnit.MechanismConstraints;

namespace LeverTests;

/// <summary>A hand lever turns a shaft with an eccentric panel; a bar carries the motion to a slider.</summary>
public sealed class LeverTests
{
    private const string Exported = "lever.kinefab";
    private const string Crank = "Shaft";
    private const string Slider = "Slide";

    private static readonly string Here = TestContext.CurrentContext.TestDirectory;
    private static readonly ValidScene Scene = ValidScene.Load(Path.Combine(Here, Exported));
    private static readonly Mechanism Lever = Mechanism.Create(Scene);

    [Test]
    public void Scene_AsExported_IsValid() => Assert.That(Path.Combine(Here, Exported), Is.ValidScene);

    [Test]
    public void Lever_AsBuilt_HasOneFreedom() => Assert.That(Scene, Has.Mobility(1));

    [Test]
    public void Loop_AtTheExportedPose_Closes() => Assert.That(Lever, Closes.Within(1e-9));

    [Test]
    public void Crank_OverAWholeTurn_MovesTheSliderByItsStroke() =>
        Assert.That(Lever, Drives(Crank).From(0).To(360).Moving(Slider).By(0.05).Within(1e-4));

    [Test]
    public void Crank_Backwards_GoesAsFar() => Assert.That(Lever, Drives(Crank).From(0).To(-720).Steps(144));

    [Test]
    public void Motion_OverATurn_IsTheRecordedOne() => Assert.That(Lever, Matches.Trajectory(Path.Combine(Here, "lever.motion.json")).Within(1e-9));

    [Test]
    public void Lever_LeftAlone_KeepsItsEnergy() => Assert.That(Scene, Keeps.Energy.Within(0.5).Percent.For(seconds: 2));

    [Test]
    public void Slider_BeyondItsReach_CannotBeDriven() => Assert.That(Lever, !Drives(Slider).To(0.2));

    [Test]
    public void Slider_PulledBySomebody_StopsInReach()
    {
        var state = Lever.NewState();
        DriveResult pulled = new PositionSolver(Lever).Drag(state, "SliderD:1", default, new(-5, 0, 0));
        Assert.That(pulled.Status, Is.EqualTo(DriveStatus.OutOfReach));
    }

    [Test]
    public void Joints_InUnitysSolver_HoldToAMillimetre()
    {
        World world = World.Create(Scene, SolverKind.Unity);
        world.Run(seconds: 1);
        Assert.That(world.Joints, Has.All.Matches<WorldJoint>(joint => joint!.Drift.Distance < 1e-3));
    }
}
