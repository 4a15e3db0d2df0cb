using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>What PhysX and the couplings count from when they get a mechanism that is not at its exported pose.</summary>
[NonParallelizable]
public sealed class HandOverTests
{
    private static readonly string Samples = Path.Combine(PlayedMechanism.Fixtures, "..", "csharp", "unity", "com.kinefab", "Samples~");

    // Of single precision, metres and of a quaternion's parts.
    private const float Single = 2e-6f;

    // A turn shows in no pose: the coupling of the jaw would take 350 degrees of the spindle for -10, and throw the jaw to the other side.
    [TestCase(KinefabPhysics.Joints)]
    [TestCase(KinefabPhysics.Articulation)]
    public void Couplings_HandedOverBeyondHalfATurn_LeaveThePartsWhereTheyStand(KinefabPhysics physics)
    {
        using var played = new PlayedMechanism(Path.Combine(Samples, "Gripper", "Gripper.kinefab"), physics);
        double zero = Zero(played);
        for (int i = 1; i <= 35; i++)
        {
            played.Component.Drive("Spindle", 10 * i);
            played.Frame();
        }

        played.Frame();
        double jaw = played.Component.Value("Left jaw");
        Assert.That(Math.Abs(jaw), Is.EqualTo(350 * 0.02 / 360).Within(1e-9));
        played.Component.Mover = KinefabMover.Physics;
        played.Frame();
        Assert.That(Target(played.Root), Is.EqualTo(zero + jaw).Within(1e-6));
    }

    [Test]
    public void Couplings_OfASceneStoredBeyondHalfATurn_LeaveThePartsWhereTheyStand()
    {
        using var stored = new PlayedMechanism(Path.Combine(Samples, "Gripper", "Gripper.kinefab"), KinefabPhysics.Joints, plays: false);
        stored.Component.Drive("Spindle", 350);
        stored.Component.Mover = KinefabMover.Physics;
        double jaw = stored.Component.Value("Left jaw");
        using var exported = new PlayedMechanism(Path.Combine(Samples, "Gripper", "Gripper.kinefab"), KinefabPhysics.Joints);
        double zero = Zero(exported);
        Unity.GameObject loaded = Unity.Object.Instantiate(stored.Root);
        Unity.Player.Frame();
        Assert.That(Target(loaded), Is.EqualTo(zero + jaw).Within(1e-6));
        Unity.Object.DestroyImmediate(loaded);
    }

    [TestCase("Lever", KinefabMover.Exact)]
    [TestCase("Lever", KinefabMover.Physics)]
    [TestCase("FourBar", KinefabMover.JointDrives)]
    public void Joints_OfAMovedMechanismThatIsSwitchedOffAndOn_CountFromTheExportedPose(string sample, KinefabMover mover)
    {
        using var played = new PlayedMechanism(Path.Combine(Samples, sample, sample + ".kinefab"), KinefabPhysics.Joints);
        played.Frame();
        List<(Unity.Vector3 Position, Unity.Quaternion Rotation)> exported = MadeAt(played.Root);
        Assert.That(exported, Is.Not.Empty);
        played.Component.Drive(0, played.Component.Freedoms[0].High / 4);
        played.Frame();
        played.Frame();
        played.Component.Mover = mover;
        played.Root.SetActive(false);
        Assert.That(played.Root.GetComponentsInChildren<Unity.Joint>(true).Select(joint => joint.MadeAt), Is.All.Null);
        played.Root.SetActive(true);
        Dictionary<string, Unity.Vector3> stood = Positions(played.Root);
        played.Frame();
        List<(Unity.Vector3 Position, Unity.Quaternion Rotation)> anew = MadeAt(played.Root);
        for (int i = 0; i < exported.Count; i++)
        {
            Assert.That(Unity.Vector3.Distance(anew[i].Position, exported[i].Position), Is.LessThan(Single));
            Assert.That(Math.Abs(Unity.Quaternion.Dot(anew[i].Rotation, exported[i].Rotation)), Is.EqualTo(1).Within(Single));
        }

        foreach ((string part, Unity.Vector3 at) in Positions(played.Root))
            Assert.That(Unity.Vector3.Distance(at, stood[part]), Is.LessThan(Single), part);
    }

    // The bob hangs by a joint of the frame's and has none of its own: PhysX knows of its place only from the step before.
    [Test]
    public void Joints_OnABodyWithoutOneOfItsOwn_CountFromTheExportedPose()
    {
        const string Pendulum = """
            {"format": "kinefab.scene", "version": "1.0", "gameObjects": [
             {"id": "frame", "name": "Frame", "components": [{"type": "Rigidbody", "isKinematic": true},
              {"type": "HingeJoint", "connectedBody": 1, "anchor": [0, 0, 0], "axis": [0, 0, 1], "autoConfigureConnectedAnchor": false, "connectedAnchor": [0, 0.5, 0]}]},
             {"id": "bob", "name": "Bob", "transform": {"localPosition": [0, -0.5, 0]}, "components": [{"type": "Rigidbody", "mass": 2, "inertiaTensor": [0.1, 0.2, 0.3]}]}]}
            """;
        Unity.Player.Play(true);
        Unity.GameObject root = KinefabScene.Instantiate(System.Text.Encoding.UTF8.GetBytes(Pendulum), settings: new KinefabSettings(), findings: []);
        try
        {
            KinefabMechanism mechanism = root.GetComponent<KinefabMechanism>();
            Unity.Rigidbody bob = root.GetComponentsInChildren<Unity.Rigidbody>().Single(body => body.name == "Bob");
            List<(Unity.Vector3 Position, Unity.Quaternion Rotation)> exported = MadeAt(root);
            Assert.That(mechanism.Drive(0, 40).Reached, Is.True);
            Unity.Player.Frame();
            bob.Arrive();
            Unity.Player.Frame();
            root.SetActive(false);
            root.SetActive(true);
            Unity.Player.Frame();
            Assert.That(Math.Abs(Unity.Quaternion.Dot(MadeAt(root).Single().Rotation, exported.Single().Rotation)), Is.EqualTo(1).Within(Single));
            Assert.That(Math.Abs(bob.transform.position.x), Is.EqualTo(0.5 * Math.Sin(40 * Math.PI / 180)).Within(Single));
        }
        finally
        {
            Unity.Object.DestroyImmediate(root);
            Unity.Player.Play(false);
        }
    }

    // The joint that is switched off has none in Unity: the one behind it is the first there.
    [Test]
    public void JointDrives_OfAPartWithAJointSwitchedOff_AimTheOneThatIsThere()
    {
        const string Door = """
            {"format": "kinefab.scene", "version": "1.1", "gameObjects": [
             {"id": "frame", "name": "Frame", "components": [{"type": "Rigidbody", "isKinematic": true}]},
             {"id": "door", "name": "Door", "components": [{"type": "Rigidbody", "mass": 2, "inertiaTensor": [0.1, 0.2, 0.3]},
              {"type": "FixedJoint", "connectedBody": 0, "enabled": false},
              {"type": "HingeJoint", "connectedBody": 0, "anchor": [0, 0, 0], "axis": [0, 1, 0], "autoConfigureConnectedAnchor": false, "connectedAnchor": [0, 0, 0]}]}]}
            """;
        Unity.Player.Play(true);
        Unity.GameObject root = KinefabScene.Instantiate(System.Text.Encoding.UTF8.GetBytes(Door), findings: []);
        try
        {
            KinefabMechanism mechanism = root.GetComponent<KinefabMechanism>();
            mechanism.Mover = KinefabMover.JointDrives;
            Assert.That(mechanism.Drive(0, 25).Reached, Is.True);
            Unity.HingeJoint hinge = root.GetComponentsInChildren<Unity.HingeJoint>().Single();
            Assert.That((hinge.useSpring, Math.Abs(hinge.spring.targetPosition)), Is.EqualTo((true, 25f)));
        }
        finally
        {
            Unity.Object.DestroyImmediate(root);
            Unity.Player.Play(false);
        }
    }

    // Where it sends the jaw at the exported pose: Unity counts from where the anchors meet.
    private static double Zero(PlayedMechanism played)
    {
        played.Component.Mover = KinefabMover.Physics;
        played.Frame();
        double zero = Target(played.Root);
        played.Component.Mover = KinefabMover.Exact;
        return zero;
    }

    // Where the coupling sends the left jaw; a joint's targets are those of the connected body against its own.
    private static double Target(Unity.GameObject root)
    {
        KinefabCoupling coupling = root.GetComponentsInChildren<KinefabCoupling>(true).Single(one => one.name == "Left jaw");
        return coupling.driven is Unity.ConfigurableJoint joint ? -joint.targetPosition.x : coupling.drivenArticulationBody.xDrive.target;
    }

    private static List<(Unity.Vector3 Position, Unity.Quaternion Rotation)> MadeAt(Unity.GameObject root) =>
        [.. root.GetComponentsInChildren<Unity.Joint>(true).Select(joint => joint.MadeAt!.Value)];

    private static Dictionary<string, Unity.Vector3> Positions(Unity.GameObject root) =>
        root.GetComponentsInChildren<Unity.Transform>(true).Where(at => at != root.transform).ToDictionary(at => at.name, at => at.position);
}
