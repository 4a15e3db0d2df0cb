using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json.Nodes;
using System.Text.RegularExpressions;
using Kinefab.Tests.Conformance;
using Kinefab.Numerics;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>What the settings make of bodies and joints.</summary>
[NonParallelizable]
public sealed class PhysicsImportTests
{
    private static readonly string Samples = Path.Combine(ConformanceCases.Folder, "..", "..", "csharp", "unity", "com.kinefab", "Samples~");
    private static readonly string Arm = Path.Combine(Samples, "Arm", "Arm.kinefab");
    private static readonly string Gripper = Path.Combine(Samples, "Gripper", "Gripper.kinefab");

    private static readonly string[] LostRanges = ["JOINT_LIMIT_BEYOND_TURN", "JOINT_LIMIT_ASYMMETRIC"];

    [Test]
    public void Joints_OfAnArticulation_AreOneForEachLinkBelowTheRoot()
    {
        ImportedAsset links = ImportedAsset.Of(Arm), joints = ImportedAsset.Of(Arm, new KinefabSettings { physics = KinefabPhysics.Joints });
        Unity.ArticulationBody[] from = All<Unity.ArticulationBody>(links);
        Assert.That((from.Length, All<Unity.ArticulationBody>(joints).Length), Is.EqualTo((7, 0)));
        Unity.Rigidbody[] bodies = All<Unity.Rigidbody>(joints);
        Assert.That(bodies.Select(b => (b.name, b.mass, b.isKinematic)), Is.EqualTo(from.Select(l => (l.name, l.mass, l.immovable))));
        Unity.ConfigurableJoint[] made = All<Unity.ConfigurableJoint>(joints);
        Assert.That(made.Select(j => (j.name, j.connectedBody.name)), Is.EqualTo(from.Skip(1).Select(l => (l.name, l.transform.parent.name))));
        foreach ((Unity.ConfigurableJoint joint, Unity.ArticulationBody link) in made.Zip(from.Skip(1)))
        {
            Assert.That((joint.lowAngularXLimit.limit, joint.highAngularXLimit.limit, joint.angularXDrive.positionSpring), Is.EqualTo((link.xDrive.lowerLimit, link.xDrive.upperLimit, link.xDrive.stiffness)), joint.name);
            Assert.That((joint.angularXMotion, joint.angularYMotion, joint.xMotion), Is.EqualTo((Unity.ConfigurableJointMotion.Limited, Unity.ConfigurableJointMotion.Locked, Unity.ConfigurableJointMotion.Locked)));
        }
    }

    // What a link holds and no ConfigurableJoint does: told by the exporter's own codes, and free.
    [Test]
    public void Joints_OfLinksWithWiderRanges_SayWhatIsLost()
    {
        using var scene = new EditedScene("../csharp/unity/com.kinefab/Samples~/Arm/Arm.kinefab");
        JsonObject[] links = [.. scene.Objects.SelectMany(o => o!["components"]?.AsArray() ?? []).Select(c => c!.AsObject()).Where(c => (string?)c["jointType"] == "Revolute")];
        links[1]["xDrive"] = new JsonObject { ["lowerLimit"] = -11, ["upperLimit"] = 225 };
        links[2]["jointType"] = "Spherical";
        links[2]["swingYLock"] = "Limited";
        links[2]["swingZLock"] = "Limited";
        links[2]["yDrive"] = new JsonObject { ["lowerLimit"] = -20, ["upperLimit"] = 50 };
        links[2]["zDrive"] = new JsonObject { ["lowerLimit"] = -30, ["upperLimit"] = 30 };
        scene.Save();
        ImportedAsset joints = ImportedAsset.Of(scene.Scene, new KinefabSettings { physics = KinefabPhysics.Joints });
        Unity.ConfigurableJoint[] made = All<Unity.ConfigurableJoint>(joints);
        Assert.That(made[1].angularXMotion, Is.EqualTo(Unity.ConfigurableJointMotion.Free));
        Assert.That((made[2].angularYLimit.limit, made[2].angularZLimit.limit), Is.EqualTo((50f, 30f)));
        Assert.That(joints.Codes.Where(c => c.StartsWith("JOINT_LIMIT", StringComparison.Ordinal)), Is.EqualTo(LostRanges));
        Assert.That(joints.Context.Warnings, Has.Some.Contains("may turn from -11 to 225 degrees"));
        Assert.That(ImportedAsset.Of(scene.Scene).Codes, Has.None.StartsWith("JOINT_LIMIT"));
    }

    // The mechanism is the same whatever physics has of it, and its drives find the joint that stands for a link.
    [Test]
    public void Joints_OfAnArticulation_AreAimedLikeItsLinks()
    {
        using var played = new PlayedMechanism(Arm, KinefabPhysics.Joints);
        double[] asked = [10, 20, -30, 40, 50, -60];
        played.Component.Set(asked);
        played.Frame();
        Assert.That(played.Off(played.Component.Motion.State), Is.LessThan(2e-5));
        played.Component.Mover = KinefabMover.JointDrives;
        double[] aimed = [.. All<Unity.ConfigurableJoint>(played.Root).Select(j => 2 * Math.Asin(Math.Abs(j.targetRotation.x)) * 180 / Math.PI)];
        Assert.That(aimed, Is.EqualTo(asked.Select(Math.Abs)).Within(1e-3));
    }

    // The loop stays closed by joints on helper bodies; sliders, couplings and findings are those of the links.
    [Test]
    public void Articulation_OfAFileWithJoints_IsWhatTheExportMakes()
    {
        ImportedAsset asset = ImportedAsset.Of(PlayedMechanism.Full("lever/lever.kinefab"), new KinefabSettings { physics = KinefabPhysics.Articulation });
        Assert.That((asset.Context.Errors, All<Unity.HingeJoint>(asset).Length), Is.EqualTo((Array.Empty<string>(), 0)));
        Unity.ArticulationBody[] links = All<Unity.ArticulationBody>(asset);
        Assert.That(links.Count(l => l.immovable), Is.EqualTo(1));
        Assert.That(links.Where(l => !l.immovable).Select(l => l.transform.parent.GetComponent<Unity.ArticulationBody>() != null), Is.All.True);
        Assert.That(All<Unity.Rigidbody>(asset).Select(b => b.name), Is.All.EndsWith("closure").And.Not.Empty);
        Assert.That(asset.Source.Findings.Count(f => f.code == "ARTICULATION_LOOP_HELPER"), Is.EqualTo(All<Unity.Rigidbody>(asset).Length));
        Assert.That(asset.Codes, Has.None.EqualTo("UNITY_PHYSICS_AS_EXPORTED"));
        Assert.That(ImportedAsset.Of(Arm, new KinefabSettings { physics = KinefabPhysics.Articulation }).Codes, Has.None.StartsWith("ARTICULATION").And.None.EqualTo("UNITY_PHYSICS_AS_EXPORTED"));
        Assert.That(ImportedAsset.Of(Arm).Source.DescribePhysics(), Is.EqualTo("7 ArticulationBodies and 0 joints"));
    }

    [Test]
    public void Articulation_ThatCannotHoldAJoint_NamesItAndKeepsTheJoints()
    {
        using var scene = new EditedScene();
        JsonObject joint = scene.Objects.SelectMany(o => o!["components"]?.AsArray() ?? []).Select(c => c!.AsObject()).First(c => (string?)c["type"] == "HingeJoint");
        joint["breakForce"] = 12;
        scene.Save();
        ImportedAsset asset = ImportedAsset.Of(scene.Scene, new KinefabSettings { physics = KinefabPhysics.Articulation });
        Assert.That(asset.Context.Warnings, Has.Some.Match("ARTICULATION_IMPOSSIBLE.*it can break.*As Exported").And.Some.Match(@"UNITY_PHYSICS_AS_EXPORTED.*its \d+ Rigidbodies and \d+ joints stay"));
        Assert.That((asset.Context.Errors, All<Unity.ArticulationBody>(asset).Length), Is.EqualTo((Array.Empty<string>(), 0)));
        Assert.That(All<Unity.Joint>(asset), Is.Not.Empty);
    }

    // One mechanism, whatever holds it in physics: the same freedoms by the same names, and every part where it was.
    [Test]
    public void Articulation_OfEveryFixture_IsMovedAsItsJointsAre()
    {
        const int Steps = 12;
        List<string> apart = [];
        int moved = 0;
        foreach (string file in PlayedMechanism.Scenes())
        {
            using var joints = new PlayedMechanism(PlayedMechanism.Full(file), KinefabPhysics.AsExported);
            using var links = new PlayedMechanism(PlayedMechanism.Full(file), KinefabPhysics.Articulation);
            KinefabMechanism one = joints.Component, other = links.Component;
            if (one == null || All<Unity.ArticulationBody>(links.Root).Length == 0)
                continue;
            // A hinge's angle is a link's angularX; of a joint without a name both are told by their object, with a number where it has several.
            string Said(KinefabFreedom f) => Regex.Replace(f.FullName, @"\.(angle|angularX)$|\[\d+\]", "");
            string[] here = [.. one.Freedoms.Select(Said)], there = [.. other.Freedoms.Select(Said)];
            if (here.Length == 0 || !here.Order().SequenceEqual(there.Order()) || one.Last.Branches > 1 || one.Freedoms[0].Low > -1e-4 || -one.Freedoms[0].Low < 0.01 * one.Freedoms[0].High)
                continue; // another tree may choose others of the coordinates for the same freedoms; from a dead point there are two ways on
            double[] values = new double[here.Length], theirs = new double[here.Length];
            for (int step = 1; step <= Steps; step++)
            {
                double to = Math.Clamp(3.0 * step * (one.Freedoms[0].IsAngle ? 1 : 0.0005), 0.9 * one.Freedoms[0].Low, 0.9 * one.Freedoms[0].High); // at its ends two poses meet
                values[0] = theirs[Array.IndexOf(there, here[0])] = to;
                if (!one.Set(values).Reached || !other.Set(theirs).Reached)
                    break;
                double off = Apart(one, other);
                moved++;
                if (off > 1e-7)
                {
                    apart.Add($"{file}: {off} m at {to} of {one.Freedoms[0].FullName}");
                    break;
                }
            }
        }

        TestContext.Out.WriteLine($"{moved} poses");
        Assert.That(string.Join("\n", apart), Is.Empty);
        Assert.That(moved, Is.GreaterThan(500));

        static double Apart(KinefabMechanism one, KinefabMechanism other)
        {
            double worst = 0;
            HashSet<int> idle = [.. one.Motion.Mechanism.CountMobility().Idle.SelectMany(free => free.GameObjects)];
            foreach (int body in one.Motion.Mechanism.Bodies.Where(b => !idle.Contains(b)))
            {
                string id = one.Motion.Mechanism.Scene.Document.GameObjects[body].Id;
                Pose a = one.Motion.State.Pose(id), b = other.Motion.State.Pose(id);
                worst = Math.Max(worst, Math.Max((a.Position - b.Position).Length, (a.Point(new(0.1, 0.2, -0.1)) - b.Point(new(0.1, 0.2, -0.1))).Length));
            }

            return worst;
        }
    }

    [Test]
    public void Couplings_AreKeptByTheScriptWherePhysicsMoves()
    {
        KinefabCoupling[] made = All<KinefabCoupling>(ImportedAsset.Of(Gripper));
        Assert.That(made.Select(c => (c.driven.name, c.terms.Single().joint.name, c.terms.Single().ratio)), Is.EqualTo(new[] { ("Left jaw", "Spindle", (float)(-0.02 / 360)), ("Right jaw", "Left jaw", -1f) }));
        Assert.That(All<KinefabCoupling>(ImportedAsset.Of(Gripper, new KinefabSettings { physics = KinefabPhysics.None })), Is.Empty);

        // Under a scaled parent a turn is as many degrees, and a way as many times longer.
        var parent = new Unity.GameObject("parent");
        parent.transform.localScale = new Unity.Vector3(3, 3, 3);
        Unity.GameObject scaled = KinefabScene.Instantiate(Gripper, parent.transform, findings: []);
        Assert.That(All<KinefabCoupling>(scaled).Select(c => c.terms.Single().ratio), Is.EqualTo(new[] { -0.06f / 360, -1f }).Within(1e-9));
    }

    [Test]
    public void Couplings_RestWhileTheSolverHoldsTheBodies()
    {
        using var played = new PlayedMechanism(Gripper, KinefabPhysics.AsExported);
        KinefabCoupling[] couplings = All<KinefabCoupling>(played.Root);
        Assert.That(couplings.Select(c => c.enabled), Is.All.False);
        played.Component.Mover = KinefabMover.Physics;
        Assert.That(couplings.Select(c => c.enabled), Is.All.True.And.Exactly(2).Items);
    }

    // The solver has to know of it too, or its sliders would move what stands.
    [Test]
    public void Ground_OfTheSettings_IsTheSolversToo()
    {
        using var scene = new EditedScene("../csharp/unity/com.kinefab/Samples~/FourBar/FourBar.kinefab");
        JsonObject body = scene.Objects.SelectMany(o => o!["components"]?.AsArray() ?? []).Select(c => c!.AsObject()).First(c => (bool?)c["isKinematic"] == true);
        body.Remove("isKinematic");
        scene.Save();
        ImportedAsset free = ImportedAsset.Of(scene.Scene);
        string id = (string)scene.Objects.First(o => o!["components"]?.AsArray().Contains(body) == true)!["id"]!;
        ImportedAsset held = ImportedAsset.Of(scene.Scene, new KinefabSettings { ground = id });
        Assert.That(held.Codes, Has.None.EqualTo("UNITY_GROUND_UNKNOWN"));
        Assert.That(All<Unity.Rigidbody>(held).Count(b => b.isKinematic), Is.EqualTo(All<Unity.Rigidbody>(free).Count(b => b.isKinematic) + 1));
        Assert.That(held.Root.GetComponent<KinefabMechanism>().CanDrag(All<Unity.Rigidbody>(held).Single(b => b.isKinematic).transform), Is.False);
    }

    [Test]
    public void Ground_OfAnArticulation_IsItsRootAlone()
    {
        Assert.That(ImportedAsset.Of(Arm, new KinefabSettings { ground = "Forearm" }).Codes, Does.Contain("UNITY_GROUND_UNKNOWN"));
        Assert.That(ImportedAsset.Of(Arm, new KinefabSettings { ground = "Pedestal" }).Codes, Has.None.EqualTo("UNITY_GROUND_UNKNOWN"));
    }

    [Test]
    public void Mechanism_WithoutAFreedom_IsToldInTheInspector()
    {
        ImportedAsset asset = ImportedAsset.Of(PlayedMechanism.Full("mechanisms/M45.kinefab"));
        Assert.That(asset.Source.Findings.Single(f => f.code == "UNITY_NOTHING_MOVES").remedy, Does.Contain("kinefab analyse"));
        List<KinefabFinding> found = [];
        KinefabScene.Instantiate(PlayedMechanism.Full("mechanisms/M45.kinefab"), findings: found);
        Assert.That(found.Select(f => f.code), Does.Contain("UNITY_NOTHING_MOVES"));
        Assert.That(ImportedAsset.Of(Gripper).Codes, Has.None.EqualTo("UNITY_NOTHING_MOVES"));
    }

    private static T[] All<T>(ImportedAsset asset) => All<T>(asset.Root);

    private static T[] All<T>(Unity.GameObject root) => root.GetComponentsInChildren<T>(true);
}
