using System;
using System.IO;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>Bodies and joints of a world by what a mechanism and the command line call them.</summary>
public sealed class WorldNameTests
{
    // Its rocker carries two hinges.
    private static readonly ValidScene FourBar = ValidScene.Load(Path.Combine(Scenario.Folder, "..", "..", "fixtures", "mechanisms", "M05.kinefab"));

    private static readonly ValidScene Lever = ValidScene.Load(Path.Combine(Scenario.Folder, "..", "..", "fixtures", "lever", "lever.kinefab"));

    [Test]
    public void Joint_EveryName_IsFoundByIt()
    {
        World world = World.Create(FourBar);
        Assert.That(string.Join(" ", world.Joints.Select(j => j.Name)), Is.EqualTo("coupler crank rocker[1] rocker[2]"));
        foreach (WorldJoint joint in world.Joints)
            Assert.That(world.Joint(joint.Name), Is.SameAs(joint));
    }

    [Test]
    public void Joint_EveryCoordinateOfTheMechanism_IsCalledAlike()
    {
        foreach (ValidScene scene in new[] { FourBar, Lever })
        {
            World world = World.Create(scene);
            foreach (MechanismCoordinate coordinate in Mechanism.Create(scene).Coordinates)
            {
                WorldJoint joint = world.Joint(coordinate.Name[..coordinate.Name.LastIndexOf('.')]);
                Assert.That((joint.GameObject, joint.Component), Is.EqualTo((coordinate.GameObject, coordinate.Component)), coordinate.Name);
            }
        }
    }

    [TestCase("Crank:1", "Lever/Crank:1")]
    [TestCase("Lever/Crank:1[1]", "Lever/Crank:1")]
    [TestCase("SliderD:1[5]", "Lever/SliderD:1[5]")]
    public void Joint_NameOrComponentOfItsObject_IsEnough(string name, string expected) =>
        Assert.That(World.Create(Lever).Joint(name).Name, Is.EqualTo(expected));

    [TestCase("rocker", "rocker: say which: rocker[1], rocker[2].")]
    [TestCase("rocker[3]", "rocker[3]: no joint has this name; there are coupler, crank, rocker[1], rocker[2].")]
    [TestCase("", ": no joint has this name; there are coupler, crank, rocker[1], rocker[2].")]
    public void Joint_NoneOrSeveral_ListsThem(string name, string message) =>
        Assert.That(() => World.Create(FourBar).Joint(name), Throws.ArgumentException.With.Message.StartsWith(message));

    [TestCase("Lever/BarC:1")]
    [TestCase("BarC:1")]
    public void Body_IdOrName_IsFound(string name) => Assert.That(World.Create(Lever).Body(name).Id, Is.EqualTo("Lever/BarC:1"));

    [Test]
    public void Body_ObjectWithoutOneOrUnknown_ListsThoseThatThereAre()
    {
        World world = World.Create(FourBar);
        foreach (string name in new[] { "nobody", "crank[1]" })
            Assert.That(() => world.Body(name), Throws.ArgumentException.With.Message.StartsWith($"{name}: no body has this id, nor one alone this name; there are coupler, crank, rocker."));
        var still = new SceneDocument { GameObjects = [new GameObject { Id = "a", Name = "a" }] };
        Assert.That(() => World.Create(SmallScene.Validate(still)).Body("a"), Throws.ArgumentException.With.Message.StartsWith("a: no body has this id, nor one alone this name; there are none."));
    }

    [Test]
    public void Body_NameOfSeveral_IsNotGuessed()
    {
        var twins = new SceneDocument
        {
            GameObjects =
            [
                new GameObject { Id = "left/pin", Name = "pin", Components = [new Rigidbody()] },
                new GameObject { Id = "right/pin", Name = "pin", Components = [new Rigidbody()] },
            ],
        };
        Assert.That(() => World.Create(SmallScene.Validate(twins)).Body("pin"), Throws.ArgumentException.With.Message.StartsWith("pin: say which: left/pin, right/pin."));
    }

    [Test]
    public void BodyAndJoint_Null_AreRefused()
    {
        World world = World.Create(FourBar);
        Assert.That(() => world.Body(null!), Throws.InstanceOf<ArgumentNullException>());
        Assert.That(() => world.Joint(null!), Throws.InstanceOf<ArgumentNullException>());
    }
}
