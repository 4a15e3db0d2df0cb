using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using KinefabUnity;
using KinefabUnity.Editing;
using NUnit.Framework;
using UnityEditor;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>Who moves the parts: the solver, drives or physics, the mouse, the inspector.</summary>
[NonParallelizable]
public sealed class MechanismHandsTests
{
    private static readonly string Samples = Path.Combine(PlayedMechanism.Fixtures, "..", "csharp", "unity", "com.kinefab", "Samples~");

    [Test]
    public void Mover_Exact_HoldsTheBodiesAndHandsThemOverAsFastAsTheyGo()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Lever, KinefabPhysics.AsExported);
        Unity.Rigidbody crank = played.Part("Lever/Crank:1").GetComponent<Unity.Rigidbody>();
        Assert.That(crank.isKinematic, Is.True);
        for (int i = 1; i <= 10; i++)
        {
            played.Component.Drive("Shaft", 2 * i);
            played.Frame();
        }

        played.Component.Mover = KinefabMover.Physics;
        Assert.That(crank.isKinematic, Is.False);

        // 2 degrees in a step of 0.02 s.
        Assert.That(crank.angularVelocity.magnitude, Is.EqualTo(100 * Math.PI / 180).Within(1e-3));

        // Physics turns the crank further: the values follow, and the solver takes it from there.
        Unity.Transform at = crank.transform;
        at.localRotation = Unity.Quaternion.AngleAxis(-3, crank.GetComponent<Unity.HingeJoint>().axis) * at.localRotation;
        played.Frame();
        double followed = played.Component.Value("Shaft");
        Assert.That(Math.Abs(followed - 20), Is.EqualTo(3).Within(1e-3));
        played.Component.Mover = KinefabMover.Exact;
        Assert.That(crank.isKinematic, Is.True);
        played.Frame();
        Assert.That(played.Off(played.Component.Motion.State), Is.LessThan(2e-5));
    }

    [Test]
    public void Mover_JointDrives_AimsTheJointsAndGivesThemBack()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Lever, KinefabPhysics.AsExported);
        Unity.HingeJoint hinge = played.Part("Lever/Crank:1").GetComponent<Unity.HingeJoint>();
        (bool UseSpring, bool UseMotor, Unity.JointSpring Spring) before = (hinge.useSpring, hinge.useMotor, hinge.spring);
        played.Component.Mover = KinefabMover.JointDrives;
        played.Component.Drive("Shaft", 25);
        int shaft = played.Component.Freedoms[0].Coordinate;
        Assert.That((hinge.useSpring, (double)hinge.spring.targetPosition), Is.EqualTo((true, played.Component.Motion.State.Coordinate(shaft))).Using<(bool, double)>((a, b) => a.Item1 == b.Item1 && Math.Abs(a.Item2 - b.Item2) < 1e-4));
        Assert.That(played.Part("Lever/Crank:1").GetComponent<Unity.Rigidbody>().isKinematic, Is.False);
        played.Component.enabled = false;
        Assert.That((hinge.useSpring, hinge.useMotor, hinge.spring), Is.EqualTo(before));
    }

    [Test]
    public void Articulation_Exact_SetsTheLinksJointPositions()
    {
        using var played = new PlayedMechanism(Path.Combine(Samples, "Arm", "Arm.kinefab"), KinefabPhysics.AsExported);
        Assert.That(played.Component.Freedoms, Has.Count.EqualTo(6));
        played.Component.Set(new double[] { 10, 20, -30, 40, 50, -60 });
        played.Frame();
        Unity.ArticulationBody[] links = [.. played.Root.GetComponentsInChildren<Unity.ArticulationBody>().Where(link => link.jointPosition.dofCount == 1)];
        Assert.That(links.Select(link => Math.Round(Math.Abs(link.jointPosition[0]) * 180 / Math.PI, 3)), Is.EqualTo(new[] { 10.0, 20, 30, 40, 50, 60 }));
        Assert.That(links.Any(link => link.useGravity), Is.False);
        played.Component.Mover = KinefabMover.JointDrives;
        Assert.That(links.Select(link => Math.Round(Math.Abs(link.xDrive.target), 3)), Is.EqualTo(new[] { 10.0, 20, 30, 40, 50, 60 }));
        Assert.That(links.All(link => link.useGravity), Is.True);
    }

    // Unity's joints count metres of the world, wherever and however large the mechanism stands.
    [TestCase(KinefabPhysics.AsExported)]
    [TestCase(KinefabPhysics.Joints)]
    public void Mover_UnderAScaledParent_SendsSlidesAsManyTimesFurther(KinefabPhysics physics)
    {
        var parent = new Unity.GameObject("parent");
        parent.transform.localScale = new Unity.Vector3(3, 3, 3);
        using var played = new PlayedMechanism(Written(Slides), physics, parent.transform);
        foreach (KinefabFreedom freedom in played.Component.Freedoms)
            played.Component.Drive(freedom.FullName, 0.2);
        played.Frame();
        Unity.ArticulationBody link = played.Part("link").GetComponent<Unity.ArticulationBody>();
        if (link != null)
            Assert.That(link.jointPosition[0], Is.EqualTo(0.6f).Within(1e-6));
        played.Component.Mover = KinefabMover.JointDrives;
        if (link != null)
            Assert.That(link.xDrive.target, Is.EqualTo(0.6f).Within(1e-6));
        foreach (Unity.ConfigurableJoint joint in played.Root.GetComponentsInChildren<Unity.ConfigurableJoint>())
            Assert.That(Math.Abs(joint.targetPosition.x), Is.EqualTo(0.6f).Within(1e-6), joint.name);
        Unity.Object.DestroyImmediate(parent);
    }

    // Unity counts a link's position from where its anchors meet, whatever the pose in the file.
    [Test]
    public void Mover_JointDrives_OfALinkWhoseAnchorsStandApart_CountsFromWhereTheyMeet()
    {
        string apart = Slides.Replace("\"xDrive\": {\"damping\": 5", "\"parentAnchorPosition\": [-0.1, 0, 0], \"xDrive\": {\"damping\": 5", StringComparison.Ordinal);
        using var played = new PlayedMechanism(Written(apart), KinefabPhysics.AsExported);
        foreach (KinefabFreedom freedom in played.Component.Freedoms)
            played.Component.Drive(freedom.FullName, 0.2);
        played.Frame();
        Unity.ArticulationBody link = played.Part("link").GetComponent<Unity.ArticulationBody>();
        Assert.That(link.jointPosition[0], Is.EqualTo(0.3f).Within(1e-6));
        played.Component.Mover = KinefabMover.JointDrives;
        Assert.That(link.xDrive.target, Is.EqualTo(0.3f).Within(1e-6));
    }

    // A damper that wants the speed of a motor would hold the spring beyond its target.
    [Test]
    public void Mover_JointDrives_StandsWhereItIsSentAndGivesSpeedsBack()
    {
        using var played = new PlayedMechanism(Written(Slides), KinefabPhysics.AsExported);
        Unity.ArticulationBody link = played.Part("link").GetComponent<Unity.ArticulationBody>();
        Unity.ConfigurableJoint joint = played.Part("slide").GetComponent<Unity.ConfigurableJoint>();
        (Unity.ArticulationDrive Drive, Unity.Vector3 Speed, Unity.Vector3 Turning) before = (link.xDrive, joint.targetVelocity, joint.targetAngularVelocity);
        Assert.That((Math.Abs(link.xDrive.targetVelocity), joint.targetVelocity.x), Is.EqualTo((0.3f, 0.1f)));
        played.Component.Mover = KinefabMover.JointDrives;
        Assert.That((link.xDrive.targetVelocity, joint.targetVelocity.x, joint.targetVelocity.y), Is.EqualTo((0f, 0f, 0.5f)));
        played.Component.enabled = false;
        Assert.That((link.xDrive, joint.targetVelocity, joint.targetAngularVelocity), Is.EqualTo(before));
    }

    [Test]
    public void Mover_JointDrives_GivesABallAllOfItsDrivesBack()
    {
        using var played = new PlayedMechanism(Written(Ball), KinefabPhysics.AsExported);
        Unity.ArticulationBody link = played.Part("ball").GetComponent<Unity.ArticulationBody>();
        (Unity.ArticulationDrive, Unity.ArticulationDrive, Unity.ArticulationDrive) before = (link.xDrive, link.yDrive, link.zDrive);
        played.Component.Mover = KinefabMover.JointDrives;
        Assert.That(new[] { link.xDrive, link.yDrive, link.zDrive }.Select(drive => drive.stiffness), Is.All.GreaterThan(0));
        played.Component.enabled = false;
        Assert.That((link.xDrive, link.yDrive, link.zDrive), Is.EqualTo(before));
    }

    private const string Slides = """
        {"format": "kinefab.scene", "version": "1.0", "gameObjects": [
            {"id": "base", "name": "base", "components": [{"type": "ArticulationBody", "mass": 1, "inertiaTensor": [1, 1, 1], "immovable": true}]},
            {"id": "link", "name": "link", "parent": 0, "components": [{"type": "ArticulationBody", "mass": 1, "inertiaTensor": [1, 1, 1], "jointType": "Prismatic", "linearLock": "Free", "xDrive": {"damping": 5, "targetVelocity": 0.3}}]},
            {"id": "frame", "name": "frame", "components": [{"type": "Rigidbody", "isKinematic": true}]},
            {"id": "slide", "name": "slide", "components": [{"type": "Rigidbody", "mass": 1, "inertiaTensor": [1, 1, 1]},
                {"type": "ConfigurableJoint", "connectedBody": 2, "xMotion": "Free", "yMotion": "Locked", "zMotion": "Locked", "angularXMotion": "Locked", "angularYMotion": "Locked", "angularZMotion": "Locked",
                 "xDrive": {"positionDamper": 5}, "targetVelocity": [0.1, 0.5, 0]}]}]}
        """;

    private const string Ball = """
        {"format": "kinefab.scene", "version": "1.0", "gameObjects": [
            {"id": "base", "name": "base", "components": [{"type": "ArticulationBody", "mass": 1, "inertiaTensor": [1, 1, 1], "immovable": true}]},
            {"id": "ball", "name": "ball", "parent": 0, "components": [{"type": "ArticulationBody", "mass": 1, "inertiaTensor": [1, 1, 1], "jointType": "Spherical", "twistLock": "Free", "swingYLock": "Free", "swingZLock": "Free"}]}]}
        """;

    private static string Written(string scene)
    {
        string path = Path.Combine(TestContext.CurrentContext.WorkDirectory, $"{TestContext.CurrentContext.Test.ID}.kinefab");
        File.WriteAllText(path, scene);
        return path;
    }

    [Test]
    public void Gripper_JawsFollowTheSpindle()
    {
        using var played = new PlayedMechanism(Path.Combine(Samples, "Gripper", "Gripper.kinefab"));
        played.Component.Drive("Spindle", 180);
        Assert.That(Math.Abs(played.Component.Value("Left jaw")), Is.EqualTo(0.01).Within(1e-9));
        Assert.That(played.Component.Value("Right jaw"), Is.EqualTo(-played.Component.Value("Left jaw")).Within(1e-9));
    }

    // The camera looks along +Z at the middle of a part; the mouse goes down on it, sideways, and up.
    [Test]
    public void Dragger_PullsWhatTheMouseIsOn()
    {
        using var played = new PlayedMechanism(Path.Combine(Samples, "FourBar", "FourBar.kinefab"), KinefabPhysics.None);
        var eye = new Unity.GameObject("Eye");
        Unity.Camera camera = eye.AddComponent<Unity.Camera>();
        Unity.Bounds crank = played.Component.MovingParts().Single(part => part.name == "Crank").GetComponentsInChildren<Unity.MeshRenderer>()[0].bounds;
        eye.transform.position = crank.center - new Unity.Vector3(0, 0, 1);
        KinefabDragger dragger = eye.AddComponent<KinefabDragger>();
        dragger.view = camera;
        double before = played.Component.Value("Motor");

        Unity.Input.mousePosition = new Unity.Vector3(0, 0, 0);
        Unity.Input.IsDown = true;
        Unity.Player.Frame();
        Assert.That(dragger.Part?.name, Is.EqualTo("Crank"));
        Unity.Input.WasDown = true;
        Unity.Input.mousePosition = new Unity.Vector3(0.02f, 0, 0);
        Unity.Player.Frame();
        double pulled = played.Component.Value("Motor");
        Assert.That(Math.Abs(pulled - before), Is.GreaterThan(5));
        Unity.Input.IsDown = Unity.Input.WasDown = false;
        Unity.Player.Frame();
        Assert.That(dragger.Part == null, Is.True);
        Assert.That(played.Component.Value("Motor"), Is.EqualTo(pulled));
        Unity.Object.DestroyImmediate(eye);
    }

    // The button was let go over another window: the next press would take the solver for who had the parts before.
    [Test]
    public void Dragger_PressedAgainWithoutARelease_GivesThePartsBackToPhysics()
    {
        using var played = new PlayedMechanism(Path.Combine(Samples, "FourBar", "FourBar.kinefab"), KinefabPhysics.AsExported);
        played.Component.Mover = KinefabMover.Physics;
        var eye = new Unity.GameObject("Eye");
        Unity.Camera camera = eye.AddComponent<Unity.Camera>();
        Unity.Bounds crank = played.Component.MovingParts().Single(part => part.name == "Crank").GetComponentsInChildren<Unity.MeshRenderer>()[0].bounds;
        eye.transform.position = crank.center - new Unity.Vector3(0, 0, 1);
        KinefabDragger dragger = eye.AddComponent<KinefabDragger>();
        dragger.view = camera;
        Unity.Input.mousePosition = new Unity.Vector3(0, 0, 0);
        Unity.Input.IsDown = true;
        for (int press = 0; press < 2; press++)
        {
            Unity.Input.WasDown = false;
            Unity.Player.Frame();
            Assert.That((dragger.Part?.name, played.Component.Mover), Is.EqualTo(("Crank", KinefabMover.Exact)));
        }

        Unity.Input.IsDown = Unity.Input.WasDown = false;
        Unity.Player.Frame();
        Assert.That(played.Component.Mover, Is.EqualTo(KinefabMover.Physics));
        Unity.Object.DestroyImmediate(eye);
    }

    [Test]
    public void Inspector_HasASliderForEachFreedomAndRecordsUndo()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Lever, plays: false);
        var inspector = Unity.ScriptableObject.CreateInstance<KinefabMechanismEditor>();
        inspector.target = played.Component;
        EditorGUILayout.Shown.Clear();
        Undo.Recorded.Clear();
        EditorGUILayout.Set = (label, value) => label.StartsWith("Shaft", StringComparison.Ordinal) ? 40f : value;
        try
        {
            inspector.OnInspectorGUI();
        }
        finally
        {
            EditorGUILayout.Set = (label, value) => value;
        }

        Assert.That(EditorGUILayout.Shown, Has.Some.EqualTo("Shaft [°]: 0 in -180 to 180"));
        Assert.That(played.Component.Value("Shaft"), Is.EqualTo(40).Within(1e-9));
        Assert.That(played.Off(played.Component.Motion.State), Is.LessThan(2e-5), "placed in the editor, too");
        (string name, Unity.Object[] objects) = Undo.Recorded.Single();
        Assert.That(name, Is.EqualTo("Move Shaft"));
        Assert.That(objects, Has.Member(played.Component).And.Member(played.Part("Lever/Crank:1")).And.No.Member(played.Root.transform));
    }

    [TestCaseSource(typeof(PlayedMechanism), nameof(PlayedMechanism.Scenes))]
    public void Figures_OfEveryFixture_AreFiniteAndGoAlong(string path)
    {
        using var played = new PlayedMechanism(PlayedMechanism.Full(path), KinefabPhysics.None);
        if (played.Component == null || played.Component.Freedoms.Count == 0)
            return;
        var figures = new JointFigures(played.Component.Motion.Mechanism);
        Assert.That(figures.Lines, Is.Not.Empty);
        MechanismState state = played.Component.Motion.State;
        foreach (FigureLine line in figures.Lines)
        {
            JointFigures.At(state, line, out Vector3d a, out Vector3d b);
            Assert.That(a.IsFinite && b.IsFinite, Is.True);
        }

        Handles.Drawn.Clear();
        MechanismGizmos.Draw(played.Component, GizmoType.Active);
        Assert.That(Handles.Drawn, Has.Count.EqualTo(figures.Lines.Count));
    }
}
