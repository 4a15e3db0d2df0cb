using System;
using System.IO;
using System.Linq;
using System.Text.Json.Nodes;
using Kinefab.Advice;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Advice;

/// <summary>The figures of the advice come out again when its changes are made by hand and run by hand, to the bit.</summary>
public sealed class ReproductionTests
{
    private const double Degrees = 180 / Math.PI;

    private string _chain = "";
    private string _borne = "";

    [OneTimeSetUp]
    public void WriteChains()
    {
        string folder = Directory.CreateTempSubdirectory("kinefab").FullName;
        _chain = Path.Combine(folder, "chain.kinefab");
        File.WriteAllText(_chain, StabilityAdviceTests.Chain(8, 0.1, 10).Text());
        _borne = Path.Combine(folder, "borne.kinefab");
        File.WriteAllText(_borne, Borne());
    }

    [OneTimeTearDown]
    public void RemoveChain() => Directory.Delete(Path.GetDirectoryName(_chain)!, recursive: true);

    [Test]
    public void Drift_BeforeAndAfterEveryChange_IsWhatARunByHandShows([Values("lever", "chain", "borne")] string scene)
    {
        string file = scene == "lever" ? AdviceScene.Lever : scene == "chain" ? _chain : _borne;
        AdviceReport advice = StabilityAdvice.Of(ValidScene.Load(file));
        AdviceFinding drift = StabilityAdviceTests.Single(advice, DiagnosticCodes.AdviceJointDrifts);

        Assert.That(Drifts(ValidScene.Load(file), advice), Does.Contain((drift.Before.Distance, drift.Before.Angle)));
        Assert.That(drift.Tried, Has.Count.GreaterThan(5));
        foreach (TriedChange tried in drift.Tried)
            Assert.That(Drifts(AdviceEdits.Apply(file, tried.Edits), advice), Does.Contain((tried.After.Distance, tried.After.Angle)), tried.Change);
    }

    [Test]
    public void Edits_OfAnIsland_NameItsJointsOnAKinematicBody()
    {
        AdviceFinding drift = StabilityAdviceTests.Single(StabilityAdvice.Of(ValidScene.Load(_borne)), DiagnosticCodes.AdviceJointDrifts);
        TriedChange preprocessing = drift.Tried.First(t => t.Change.Contains("Enable Preprocessing off", StringComparison.Ordinal));
        Assert.That(preprocessing.Edits.Select(e => e.Pointer), Does.Contain("/gameObjects/0/components/1/enablePreprocessing"));
    }

    [Test]
    public void Deviation_BeforeAndAfterEveryChange_IsTheDistanceFromTheExactRun()
    {
        ValidScene lever = ValidScene.Load(AdviceScene.Lever);
        AdviceReport advice = StabilityAdvice.Of(lever);
        AdviceFinding motion = StabilityAdviceTests.Single(advice, DiagnosticCodes.AdviceMotionDiffers);

        (double Distance, double Angle) before = Deviation(lever, lever, advice, body: 0);
        Assert.That((motion.Before.Distance, motion.Before.Angle), Is.EqualTo(((double?, double?))before));
        foreach (TriedChange tried in motion.Tried)
        {
            // The worst body may be another one after the change, but never a better one.
            ValidScene changed = AdviceEdits.Apply(AdviceScene.Lever, tried.Edits);
            var bodies = Enumerable.Range(0, 3).Select(b => Deviation(lever, changed, advice, b)).Select(d => ((double?)d.Distance, (double?)d.Angle));
            Assert.That(bodies, Does.Contain((tried.After.Distance, tried.After.Angle)), tried.Change);
        }
    }

    [Test]
    public void Sinking_BeforeAndAfterEveryForce_IsWhatTheExactSolverShowsOfAHeldPose()
    {
        string file = Path.Combine(Path.GetDirectoryName(_chain)!, "arm.kinefab");
        const string drive = """{"angularXDrive": {"positionSpring": 1000, "positionDamper": 20, "maximumForce": 0.7}}""";
        File.WriteAllText(file, new AdviceScene().Configured(1, drive).Configured(0.5, drive).Text());
        AdviceReport advice = StabilityAdvice.Of(ValidScene.Load(file));
        AdviceFinding weak = StabilityAdviceTests.Single(advice, DiagnosticCodes.AdviceDriveWeak);

        Assert.That(Sinking(ValidScene.Load(file), advice), Is.EqualTo(weak.Before.Angle));
        Assert.That(weak.Tried, Has.Count.GreaterThan(1));
        foreach (TriedChange tried in weak.Tried)
            Assert.That(Sinking(AdviceEdits.Apply(file, tried.Edits), advice), Is.EqualTo(tried.After.Angle), tried.Change);
    }

    // The chain, borne by a kinematic bar at its start that carries the joint between them.
    private static string Borne()
    {
        var scene = new AdviceScene().Loose(1).Loose(0.1);
        for (int i = 0; i < 7; i++)
            scene.Hinged(i == 6 ? 10 : 0.1);
        JsonNode root = JsonNode.Parse(scene.Text())!;
        JsonArray components = root["gameObjects"]![0]!["components"]!.AsArray();
        components[0]!["isKinematic"] = true;
        components.Add(JsonNode.Parse("""{"type": "HingeJoint", "anchor": [0.1, 0, 0], "axis": [0, 0, 1], "connectedBody": 1}"""));
        return root.ToJsonString();
    }

    private static double Sinking(ValidScene scene, AdviceReport advice)
    {
        World world = World.Create(scene, SolverKind.Exact);
        foreach (WorldJoint joint in world.Joints)
            joint.DriveTo(Coordinate.AngularX, 0);
        double worst = 0;
        Run(scene, advice, world, () => { }, _ => worst = Math.Max(worst, Math.Abs(world.Joints[0].Coordinate(Coordinate.AngularX))));
        return worst;
    }

    private static (double?, double?)[] Drifts(ValidScene scene, AdviceReport advice)
    {
        World world = World.Create(scene);
        var worst = new (double Distance, double Angle)[world.Joints.Count];
        Run(scene, advice, world, atSample: _ => { }, atStep: () =>
        {
            for (int j = 0; j < worst.Length; j++)
            {
                JointDrift drift = world.Joints[j].Drift;
                worst[j] = (Math.Max(worst[j].Distance, drift.Distance), Math.Max(worst[j].Angle, drift.Angle));
            }
        });
        return worst.Select(w => ((double?)w.Distance, (double?)w.Angle)).ToArray();
    }

    private static (double Distance, double Angle) Deviation(ValidScene scene, ValidScene changed, AdviceReport advice, int body)
    {
        World exact = World.Create(scene, SolverKind.Exact);
        World unity = World.Create(changed);
        (double Distance, double Angle) worst = default;
        Run(changed, advice, unity, atStep: () => { }, atSample: _ =>
        {
            exact.Step(advice.Step);
            Vector3d apart = unity.Bodies[body].CenterOfMass - exact.Bodies[body].CenterOfMass;
            Quaterniond turn = unity.Bodies[body].Pose.Rotation.Conjugate() * exact.Bodies[body].Pose.Rotation;
            double angle = 2 * Trigonometry.Atan2(turn.Vector.Length, Math.Abs(turn.W)) * Degrees;
            worst = (Math.Max(worst.Distance, apart.Length), Math.Max(worst.Angle, angle));
        });
        return worst;
    }

    private static void Run(ValidScene scene, AdviceReport advice, World world, Action atStep, Action<int> atSample)
    {
        int substeps = (int)Math.Round(advice.Step / scene.Document.Physics.FixedTimestep);
        for (int k = 0; k < advice.Steps; k++)
        {
            for (int s = 0; s < substeps; s++)
            {
                world.Step(advice.Step / substeps);
                atStep();
            }

            atSample(k);
        }
    }
}
