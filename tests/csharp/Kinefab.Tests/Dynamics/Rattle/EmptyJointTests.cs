using System;
using System.Globalization;
using System.Linq;
using System.Text;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Joints of six free motions: they keep bodies from colliding and lend their angles to couplings, and have no row of their own.</summary>
public sealed class EmptyJointTests
{
    private const string Empty = """{"type":"ConfigurableJoint","connectedBody":CONNECTED,"axis":[0,0,1],"autoConfigureConnectedAnchor":false}""";

    [TestCase(0)]
    [TestCase(2)]
    [TestCase(3)]
    [TestCase(5)]
    public void Gear_OnAJointWithoutRows_TurnsAsItSays(int arms)
    {
        World geared = World.Create(Scene(arms, Empty, coupled: true), SolverKind.Exact);

        geared.Run(0.5);

        WorldJoint pinion = geared.Joint("pinion"), helper = geared.Joint("helper[2]");
        Assert.Multiple(() =>
        {
            Assert.That(geared.Stops, Is.Zero);
            Assert.That(Math.Abs(pinion.Coordinate(Coordinate.Angle)), Is.GreaterThan(1), "nothing turned");
            Assert.That(pinion.Coordinate(Coordinate.Angle), Is.EqualTo(-1.5 * helper.Coordinate(Coordinate.AngularX)).Within(1e-6));
        });
    }

    [Test]
    public void JointWithoutRows_BetweenBodies_LeavesTheMotionAsItIs()
    {
        World with = World.Create(Scene(3, Empty, coupled: false), SolverKind.Exact), without = World.Create(Scene(3, "", coupled: false), SolverKind.Exact);

        with.Run(0.5);
        without.Run(0.5);

        Assert.That(with.Bodies.Select(body => body.Pose), Is.EqualTo(without.Bodies.Select(body => body.Pose)));
    }

    [Test]
    public void JointWithoutRows_ThatIsGivenADrive_DrivesFromThen()
    {
        World world = World.Create(Scene(1, Empty, coupled: false), SolverKind.Exact);
        world.Run(0.1);
        var helper = (WorldConfigurableJoint)world.Joint("helper[2]");
        Assert.That(helper.CurrentTorque, Is.EqualTo(Vector3d.Zero));

        helper.Settings = helper.Settings with { AngularXDrive = new JointDrive { PositionSpring = 500, PositionDamper = 50 } };
        world.Run(2);

        Assert.That(helper.Coordinate(Coordinate.AngularX), Is.EqualTo(0).Within(2));
    }

    // Two wheels on one axis, the first with a helper welded to it that has an empty joint with the second, arms and a pinion.
    private static ValidScene Scene(int arms, string joint, bool coupled)
    {
        static string Hinge(int connected, string at) =>
            string.Create(CultureInfo.InvariantCulture, $$"""{"type":"HingeJoint","connectedBody":{{connected}},"axis":[0,0,1],"autoConfigureConnectedAnchor":false,"connectedAnchor":[{{at}}]}""");
        static string Body(string id, string at, string joints) =>
            $$"""{"id":"{{id}}","name":"{{id}}","transform":{"localPosition":[{{at}}]},"components":[{"type":"Rigidbody","angularDamping":0}{{joints}}]}""";
        var objects = new StringBuilder("""{"id":"base","name":"base","components":[{"type":"Rigidbody","isKinematic":true,"useGravity":false}]}""");
        void Add(string id, string at, params string[] joints) => objects.Append(',').Append(Body(id, at, string.Concat(joints.Where(text => text.Length > 0).Select(text => "," + text))));
        Add("first", "0,0,0.1", Hinge(0, "0,0,0.1"));
        Add("second", "0,0,0.2", Hinge(0, "0,0,0.2"));
        Add("pinion", "0.4,0.1,0.2", Hinge(2, "0.4,0.1,0"));
        Add("helper", "0,0,0.1", """{"type":"FixedJoint","connectedBody":1}""", joint.Replace("CONNECTED", "2", StringComparison.Ordinal));
        for (int i = 0; i < arms; i++)
            Add($"arm{i}", string.Create(CultureInfo.InvariantCulture, $"0.{i + 1},-0.2,0.1"), Hinge(1, string.Create(CultureInfo.InvariantCulture, $"0.{i + 1},-0.2,0")));
        string couplings = coupled
            ? """[{"id":"mesh","kind":"gear","a":{"gameObject":4,"component":2,"coordinate":"angularX"},"b":{"gameObject":3,"component":1,"coordinate":"angle"},"ratio":-1.5}]"""
            : "[]";
        return ValidScene.Load(Encoding.UTF8.GetBytes($$"""{"format":"kinefab.scene","version":"1.0","gameObjects":[{{objects}}],"couplings":{{couplings}}}"""));
    }
}
