using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Threading;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics.Articulations;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Joints, coordinates and couplings answer to the CAD's own names, then to ids; what several answer to says which.</summary>
public sealed class CadNameTests
{
    private static readonly string Lever = Path.Combine(Kinefab.Tests.Dynamics.Scenario.Folder, "..", "..", "csharp", "examples", "LeverTests", "lever.kinefab");

    private static readonly Mechanism Mechanism = Mechanism.Load(Lever);

    [TestCase("Shaft", "Lever/Crank:1.angle")]
    [TestCase("Shaft.angle", "Lever/Crank:1.angle")]
    [TestCase("Slide", "Lever/SliderD:1.x")]
    [TestCase("Insert:1", "Lever/Crank:1.angle")]
    [TestCase("Lever/Crank:1", "Lever/Crank:1.angle")]
    [TestCase("Lever/Crank:1[1]", "Lever/Crank:1.angle")]
    [TestCase("Crank:1", "Lever/Crank:1.angle")]
    public void Coordinate_ByAnyOfItsNames_IsFound(string name, string expected)
    {
        MechanismCoordinate found = Mechanism.Coordinates[Mechanism.CoordinateNamed(name)];
        Assert.That(found.Name, Is.EqualTo(expected));
        WorldJoint joint = World.Load(Lever).Joint(name.EndsWith(".angle", StringComparison.Ordinal) ? name[..^".angle".Length] : name);
        Assert.That((joint.GameObject, joint.Component), Is.EqualTo((found.GameObject, found.Component)));
    }

    [Test]
    public void Coordinate_EveryName_FindsItsOwn()
    {
        for (int i = 0; i < Mechanism.Coordinates.Count; i++)
            Assert.That(Mechanism.CoordinateNamed(Mechanism.Coordinates[i].Name), Is.EqualTo(i));
        World world = World.Load(Lever);
        foreach (WorldJoint joint in world.Joints)
            Assert.That(world.Joint(joint.Name), Is.SameAs(joint));
    }

    [Test]
    public void Coordinate_OfNoJoint_ListsTheCadNamesToo() => Assert.That(
        () => Mechanism.CoordinateNamed("Shift"), Throws.ArgumentException.With.Message.Contains("Lever/Crank:1.angle \"Shaft\"").And.Message.Contains("\"Slide\""));

    // Unity's ArticulationBody has no field for the name: the export leaves it in the extras, where the Python side finds it too.
    [TestCase("Axis1")]
    [TestCase("Axis1.angularX")]
    [TestCase("Insert:1")]
    [TestCase("L1")]
    public void Coordinate_OfALink_AnswersToItsJointsNames(string name)
    {
        ArticulationBody link = LinkScene.Link(ArticulationJointType.Revolute) with { Because = ["Insert:1"], ExtrasJson = """{"name": "Axis1"}""" };
        ValidScene scene = LinkScene.Scene(LinkScene.Base, link, LinkScene.Link(ArticulationJointType.Prismatic));
        Mechanism mechanism = Mechanism.Create(scene);
        World world = World.Create(scene);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(mechanism.Coordinates[mechanism.CoordinateNamed(name)].Name, Is.EqualTo("L1.angularX"));
            Assert.That(world.Joint(name.Split('.')[0]).NameInCad, Is.EqualTo("Axis1"));
            Assert.That(() => world.DriveTo(name, 40), Throws.Nothing);
            Assert.That(() => world.DriveTo("Axs1", 40), Throws.ArgumentException.With.Message.Contains("L1.angularX \"Axis1\""));
        }
    }

    // A body called hip hangs on a joint called thigh, and the other way round, as robots have it.
    [Test]
    public void Coordinate_JointCalledAsAnotherObject_IsTheJoint()
    {
        var scene = new MechanismScene();
        int hip = scene.Body("hip", new Vector3d(0, 1, 0));
        int thigh = scene.Body("thigh", new Vector3d(0, 2, 0));
        scene.Hinge(hip, null, new Vector3d(0, 1, 0), Vector3d.UnitZ);
        scene.Hinge(thigh, hip, new Vector3d(0, 2, 0), Vector3d.UnitX);
        SceneDocument document = scene.Document();
        GameObject[] objects = [Named(document.GameObjects[0], "thigh"), Named(document.GameObjects[1], "hip")];
        ValidScene valid = new(document with { GameObjects = objects });
        Mechanism mechanism = Mechanism.Create(valid);
        Assert.That(mechanism.Coordinates.Select(c => c.Name), Is.EqualTo(["hip[1].angle", "thigh[1].angle"]));
        Assert.That(mechanism.CoordinateNamed("hip"), Is.EqualTo(1));
        Assert.That(mechanism.CoordinateNamed("thigh"), Is.EqualTo(0));
        Assert.That(mechanism.CoordinateNamed("hip[1]"), Is.EqualTo(0));
        foreach (WorldJoint joint in World.Create(valid).Joints)
            Assert.That(World.Create(valid).Joint(joint.Name).Name, Is.EqualTo(joint.Name));
    }

    [Test]
    public void Coordinate_TwoJointsOfOneName_SaysWhich()
    {
        var scene = new MechanismScene();
        int a = scene.Body("a", new Vector3d(0, 1, 0));
        int b = scene.Body("b", new Vector3d(0, 2, 0));
        scene.Hinge(a, null, new Vector3d(0, 1, 0), Vector3d.UnitZ);
        scene.Hinge(b, a, new Vector3d(0, 2, 0), Vector3d.UnitX);
        SceneDocument document = scene.Document();
        ValidScene valid = new(document with { GameObjects = [.. document.GameObjects.Select(o => Named(o, "Pin"))] });
        const string which = "Pin: say which: a.angle \"Pin\", b.angle \"Pin\".";
        Assert.That(() => Mechanism.Create(valid).CoordinateNamed("Pin"), Throws.ArgumentException.With.Message.StartsWith(which));
        Assert.That(() => World.Create(valid).DriveTo("Pin", 3), Throws.ArgumentException.With.Message.StartsWith(which));
        Assert.That(() => World.Create(valid).Joint("Pin"), Throws.ArgumentException.With.Message.StartsWith("Pin: say which: a \"Pin\", b \"Pin\"."));
    }

    [TestCase("{\"name\": 7}")]
    [TestCase("{\"name\": \"\"}")]
    [TestCase("{\"name\"")]
    [TestCase("[]")]
    public void Coordinate_ExtrasWithoutAName_AnswersToItsId(string extras)
    {
        World world = Kinefab.Tests.Dynamics.SmallScene.Create(new HingeJoint { ExtrasJson = extras });
        Assert.That(world.Joint("own").NameInCad, Is.Null);
        Assert.That(world["own"], Is.Zero);
    }

    [Test]
    public void Coupling_ById_IsFoundElseSaysWhich()
    {
        Mechanism gears = Mechanism.Load(Path.Combine(Kinefab.Tests.Dynamics.Scenario.Folder, "..", "..", "fixtures", "mechanisms", "M24.kinefab"));
        Coupling screw = gears.Scene.Document.Couplings[0];
        Assert.That(gears.Coupling(screw.Id!), Is.SameAs(screw));
        Assert.That(() => gears.Coupling("gear"), Throws.ArgumentException.With.Message.Contains(screw.Id!));
        Assert.That(() => Mechanism.Coupling("gear"), Throws.ArgumentException.With.Message.Contains("there are none."));
    }

    [Test]
    public void Sweep_ByNames_GivesColumnsAndPoses()
    {
        SweepResult sweep = Mechanism.Sweep("Shaft", 0, 360, 72);
        Assert.That(sweep.Stop, Is.Null);
        Assert.That(sweep["Shaft"], Is.EqualTo(sweep.Values));
        Assert.That(sweep["Slide"].Max() - sweep["Slide"].Min(), Is.EqualTo(0.05).Within(1e-6));
        int bar = Mechanism.GameObjectNamed("BarC:1");
        for (int i = 0; i < 73; i += 9)
        {
            Assert.That(sweep.Pose("BarC:1", i), Is.EqualTo(sweep.States[i].Pose(bar)));
            Assert.That(sweep.States[i]["Slide"], Is.EqualTo(sweep["Slide"][i]));
        }

        Assert.That(sweep.ToString(), Does.StartWith("Lever/Crank:1.angle 0 to 360 deg in 72 steps; worst gap "));
        Assert.That(() => sweep.Pose("BarC:1", 73), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => sweep.Pose("Bar", 0), Throws.ArgumentException.With.Message.Contains("Lever/BarC:1"));
        Assert.That(() => sweep["Bar"], Throws.ArgumentException);
    }

    [Test]
    public void Sweep_Cancelled_Stops()
    {
        using var cancellation = new CancellationTokenSource();
        var progress = new Cancels(cancellation, 5);
        Assert.That(() => Mechanism.Sweep("Shaft", 0, 360, 72, progress, cancellation.Token), Throws.InstanceOf<OperationCanceledException>());
        Assert.That(progress.Last, Is.EqualTo(5));
        Assert.That(() => Mechanism.CountMobility(null, cancellation.Token), Throws.InstanceOf<OperationCanceledException>());
        Assert.That(() => Kinefab.Advice.StabilityAdvice.Of(Mechanism.Scene, null, cancellation.Token), Throws.InstanceOf<OperationCanceledException>());
    }

    [TestCase(0, 1e308)]
    [TestCase(-360001, 0)]
    [TestCase(0, double.NaN)]
    public void Sweep_FartherThanAnyoneWaitsFor_IsRefused(double from, double to) =>
        Assert.That(() => Mechanism.Sweep("Shaft", from, to), Throws.InstanceOf<ArgumentOutOfRangeException>().With.Property("ParamName").EqualTo(to == 0 ? "from" : "to"));

    // What turns on and on comes beyond any bound of its value.
    [Test]
    public void Drive_FromFarAway_GoesOn()
    {
        var solver = new PositionSolver(Mechanism);
        MechanismState state = Mechanism.NewState();
        Assert.That(solver.Drive(state, "Shaft", 360000).Converged);
        Assert.That(solver.Drive(state, "Shaft", 360010).Converged);
        Assert.That(state["Shaft"], Is.EqualTo(360010).Within(1e-9));
    }

    [Test]
    public void Drive_WrongCalls_SayWhatThereIs()
    {
        var solver = new PositionSolver(Mechanism);
        MechanismState state = Mechanism.NewState();
        Assert.That(() => solver.Drive(state, 99, 1), Throws.InstanceOf<ArgumentOutOfRangeException>().With.Message.Contains("0 Lever/Crank:1.angle"));
        Assert.That(() => solver.Drive(state, -1, 1), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => solver.Drive(state, "Shaft", double.NaN), Throws.InstanceOf<ArgumentException>().With.Message.Contains("Lever/Crank:1.angle"));
        Assert.That(() => solver.Drive(state, "Shaft", 3.6e7), Throws.InstanceOf<ArgumentOutOfRangeException>().With.Message.Contains("Lever/Crank:1.angle goes at most 360000 deg at once, and stands at 0."));
        Assert.That(() => solver.Drive(state, new CoordinateTarget[] { new(0, -360001) }), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => state.Coordinate(99), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => state.Pose(9999), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => state.Pose(-1), Throws.InstanceOf<ArgumentOutOfRangeException>());
    }

    // The coordinate of a slide reads as in CAD, of a turn about its axis the other way round; of either the other way where the
    // source counts the connected body.
    [TestCase(null, 1, -1)]
    [TestCase("{\"counts\": \"connected\"}", -1, 1)]
    public void ToCad_OfAScrew_TurnsTheSenseThatTheFileTells(string? extras, double slide, double turn)
    {
        var scene = new MechanismScene();
        int body = scene.Body("nut", new Vector3d(0, 1, 0));
        scene.Configurable(body, null, new Vector3d(0, 1, 0), Vector3d.UnitZ, Vector3d.UnitX, "FLLFLL");
        SceneDocument document = scene.Document();
        GameObject nut = document.GameObjects[0];
        ValidScene valid = new(document with { GameObjects = [nut with { Components = [nut.Components[0], (ConfigurableJoint)nut.Components[1] with { ExtrasJson = extras }] }] });
        Mechanism mechanism = Mechanism.Create(valid);
        Assert.That(mechanism.Coordinates.Select(c => c.ToCad(12)), Is.EqualTo(new[] { slide * 12, turn * 12 }));
        Assert.That(mechanism.Coordinates.Select(c => c.FromCad(c.ToCad(12))), Is.All.EqualTo(12));
    }

    private static GameObject Named(GameObject source, string name) =>
        source with { Components = [.. source.Components.Select(c => c is HingeJoint hinge ? hinge with { ExtrasJson = $"{{\"name\": \"{name}\"}}" } : c)] };

    private sealed class Cancels(CancellationTokenSource cancellation, int at) : IProgress<int>
    {
        public int Last { get; private set; }

        public void Report(int value)
        {
            Last = value;
            if (value == at)
                cancellation.Cancel();
        }
    }
}
