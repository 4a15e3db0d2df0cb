using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Kinefab.Tests.Conformance;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>Mechanisms made while the game runs: under a parent that is placed, turned and scaled, and many at once.</summary>
[NonParallelizable]
public sealed class KinefabSceneTests
{
    private static readonly string Fixtures = Path.Combine(ConformanceCases.Folder, "..", "..", "fixtures");
    private static readonly string World = Path.Combine(ConformanceCases.Folder, "valid", "hinge", "world.kinefab");
    private static readonly string Slider = Path.Combine(ConformanceCases.Folder, "valid", "configurable", "every_field.kinefab");

    private static IEnumerable<string> Scenes() => Directory.GetFiles(Fixtures, "*.kinefab", SearchOption.AllDirectories)
        .Select(path => Path.GetRelativePath(Fixtures, path)).Order(StringComparer.Ordinal).Append("../tests/conformance/valid/hinge/world.kinefab");

    // In the exported pose nothing is pulled, wherever the mechanism is made: anchors that meet in the file meet there too.
    [TestCaseSource(nameof(Scenes))]
    public void Instantiate_UnderAPlacedTurnedAndScaledParent_LeavesTheAnchorsTogether(string path)
    {
        var still = new Unity.GameObject("still");
        var moved = new Unity.GameObject("moved");
        moved.transform.position = new Unity.Vector3(3, -2, 5);
        moved.transform.rotation = Unity.Quaternion.AngleAxis(50, new Unity.Vector3(1, 2, -2));
        moved.transform.localScale = new Unity.Vector3(2.5f, 2.5f, 2.5f);
        List<KinefabFinding> findings = [];
        Unity.GameObject a = KinefabScene.Instantiate(Path.Combine(Fixtures, path), still.transform, findings: findings), b = KinefabScene.Instantiate(Path.Combine(Fixtures, path), moved.transform, findings: findings);
        Assert.That(findings.Select(f => f.code), Has.None.EqualTo("UNITY_SCALE_UNEVEN"));
        Unity.Joint[] joints = a.GetComponentsInChildren<Unity.Joint>(true), same = b.GetComponentsInChildren<Unity.Joint>(true);
        Assert.That(same, Has.Length.EqualTo(joints.Length));
        foreach ((Unity.Joint one, Unity.Joint other) in joints.Zip(same))
        {
            foreach ((Unity.Vector3 from, Unity.Vector3 to) in new[] { (Own(one), Own(other)), (Connected(one), Connected(other)) })
                Assert.That((moved.transform.TransformPoint(from) - to).magnitude, Is.LessThan(1e-4), one.name);
        }
    }

    [Test]
    public void Instantiate_UnderAScaledParent_ScalesWhatUnityDoesNot()
    {
        var parent = new Unity.GameObject("parent");
        Unity.GameObject a = KinefabScene.Instantiate(Slider, parent.transform);
        parent.transform.localScale = new Unity.Vector3(3, 3, 3);
        Unity.GameObject b = KinefabScene.Instantiate(Slider, parent.transform);
        Unity.ConfigurableJoint one = a.GetComponentsInChildren<Unity.ConfigurableJoint>(true)[0], other = b.GetComponentsInChildren<Unity.ConfigurableJoint>(true)[0];
        Assert.That(other.linearLimit.limit, Is.EqualTo(3 * one.linearLimit.limit).Within(1e-6));
        Assert.That((other.targetPosition - 3 * one.targetPosition).magnitude, Is.LessThan(1e-6));
        Assert.That(other.highAngularXLimit.limit, Is.EqualTo(one.highAngularXLimit.limit));
        Unity.Rigidbody light = one.GetComponent<Unity.Rigidbody>(), wide = other.GetComponent<Unity.Rigidbody>();
        Assert.That(wide.mass, Is.EqualTo(light.mass));
        Assert.That(wide.inertiaTensor.x, Is.EqualTo(9 * light.inertiaTensor.x).Within(1e-5 * wide.inertiaTensor.x));
        Assert.That((wide.centerOfMass - 3 * light.centerOfMass).magnitude, Is.LessThan(1e-6));
    }

    [Test]
    public void Instantiate_UnderAnUnevenScale_SaysSo()
    {
        var parent = new Unity.GameObject("parent");
        parent.transform.localScale = new Unity.Vector3(1, 2.5f, 1);
        List<KinefabFinding> findings = [];
        using (new CommaCulture())
            Assert.That(KinefabScene.Instantiate(World, parent.transform, findings: findings), Is.Not.Null);
        Assert.That(findings.Single(f => f.code == "UNITY_SCALE_UNEVEN").message, Does.Contain("1, 2.5, 1"));
    }

    [Test]
    public void Instantiate_FromMemory_IsTheSameAsFromItsFile()
    {
        string folder = Path.Combine(Fixtures, "lever");
        byte[] file = File.ReadAllBytes(Path.Combine(folder, "lever.kinefab"));
        Unity.GameObject read = KinefabScene.Instantiate(Path.Combine(folder, "lever.kinefab"));
        Unity.GameObject held = KinefabScene.Instantiate(file, buffers: uri => File.ReadAllBytes(Path.Combine(folder, uri)));
        Assert.That(held.GetComponentsInChildren<Unity.Component>(true).Select(c => (c.GetType(), c.name)), Is.EqualTo(read.GetComponentsInChildren<Unity.Component>(true).Select(c => (c.GetType(), c.name))));
    }

    [Test]
    public void Instantiate_ManyAtOnce_SharesNothingThatMoves()
    {
        Unity.GameObject[] all = [.. Enumerable.Range(0, 20).Select(_ => KinefabScene.Instantiate(Path.Combine(Fixtures, "lever", "lever.kinefab")))];
        Unity.Joint[] joints = [.. all.SelectMany(a => a.GetComponentsInChildren<Unity.Joint>(true))];
        Assert.That(joints.Where(j => j.connectedBody != null!).Select(j => j.connectedBody.transform.root == j.transform.root), Is.All.True);
    }

    [Test]
    public void Instantiate_OfAFaultyFile_IsNullAndTellsWhy()
    {
        List<KinefabFinding> findings = [];
        string broken = Path.Combine(ConformanceCases.Folder, "invalid", "gameobject", "parent_later.kinefab");
        Assert.That(KinefabScene.Instantiate(broken, findings: findings), Is.Null);
        Assert.That((findings.Single().severity, findings.Single().line > 0), Is.EqualTo((KinefabSeverity.Error, true)));
        Unity.Debug.Errors.Clear();
        Assert.That(KinefabScene.Instantiate(broken), Is.Null);
        Assert.That(Unity.Debug.Errors.Single(), Does.Contain(findings.Single().code).And.Contain(findings.Single().remedy));
    }

    // Nothing acts before all is there: joints would be pinned to the world, components wake without their parts.
    [Test]
    public void Instantiate_WhileTheGameRuns_WakesLast()
    {
        Unity.Player.Play(true);
        try
        {
            Unity.GameObject root = KinefabScene.Instantiate(Path.Combine(Fixtures, "lever", "lever.kinefab"));
            Assert.That(root.activeSelf, Is.True);
            Assert.That(root.GetComponentsInChildren<Unity.Rigidbody>(true).Any(b => b.MovedAfterMade), Is.False);
        }
        finally
        {
            Unity.Player.Play(false);
        }
    }

    // PhysX 4.1 runs slides against their drive's target velocity; these editors mended it.
    [TestCase("2021.3.45f1", true)]
    [TestCase("2022.3.62f1", true)]
    [TestCase("6000.0.67f1", true)]
    [TestCase("6000.0.68f1", false)]
    [TestCase("6000.2.10f1", true)]
    [TestCase("6000.3.8f1", true)]
    [TestCase("6000.3.9f1", false)]
    [TestCase("6000.3.10b1", false)]
    [TestCase("6000.4.0a1", false)]
    [TestCase("6000.7.0a1", false)]
    [TestCase("7000.0.0b1", false)]
    [TestCase("", false)]
    public void Slides_OfEditorsBeforeItWasMended_RunBackwards(string version, bool backwards) =>
        Assert.That(BodyFields.RunsSlidesBackwards(version), Is.EqualTo(backwards));

    private static Unity.Vector3 Own(Unity.Joint joint) => joint.transform.TransformPoint(joint is Unity.FixedJoint ? Unity.Vector3.zero : joint.anchor);

    private static Unity.Vector3 Connected(Unity.Joint joint)
    {
        if (joint is Unity.FixedJoint)
            return Own(joint);
        return joint.connectedBody == null! ? joint.connectedAnchor : joint.connectedBody.transform.TransformPoint(joint.connectedAnchor);
    }
}
