using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.Json.Nodes;
using System.Text.RegularExpressions;
using System.Threading;
using Kinefab.Advice;
using Kinefab.Advice.Changes;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Advice;

/// <summary>What Unity's solver does to a scene, found and cured by changes whose effect is measured.</summary>
public sealed class StabilityAdviceTests
{
    // A heavy body slides and swings on a light one that slides on the world.
    private const string Slider =
        """
        {"format": "kinefab.scene", "version": "1.0", "gameObjects": [
                 {"id": "b0", "name": "b0", "transform": {"localPosition": [-0.069, -0.339, -0.195], "localRotation": [-0.176984, -0.968912, 0.145987, 0.092592]}, "components": [
                    {"type": "Rigidbody", "mass": 0.163, "inertiaTensor": [0.000898, 0.0039, 0.004798], "centerOfMass": [0.00407, -0.028, 0.0559]},
                    {"type": "ConfigurableJoint", "anchor": [0.18, -0.184, -0.114], "axis": [-0.432, -0.443, 0.48], "xMotion": "Locked", "yMotion": "Free", "zMotion": "Limited", "angularXMotion": "Limited", "angularYMotion": "Locked", "angularZMotion": "Locked", "linearLimit": {"limit": 0.05}, "lowAngularXLimit": {"limit": -1}, "highAngularXLimit": {"limit": 30}}]},
                 {"id": "b1", "name": "b1", "transform": {"localPosition": [-0.0559, -0.364, -0.118], "localRotation": [0.34201, 0.095203, -0.655019, -0.66702]}, "components": [
                    {"type": "Rigidbody", "mass": 17.8, "inertiaTensor": [0.476, 0.649, 1.12], "centerOfMass": [-0.0609, -0.0174, -0.0595]},
                    {"type": "ConfigurableJoint", "connectedBody": 0, "anchor": [0.243, -0.239, -0.263], "axis": [0.121, 0.91, -0.297], "yMotion": "Locked", "angularYMotion": "Locked", "angularZMotion": "Locked"}]}]}
        """;

    [TestCase(false)]
    [TestCase(true)]
    public void HingeThatTurnsPastAHalfTurn_IsOfferedExtendedLimits(bool extended)
    {
        // A motor turns a bar, which leans by 20 degrees, from rest into its stop.
        AdviceReport advice = StabilityAdvice.Of(AdviceScene.Parse($$$"""
            {"format": "kinefab.scene", "version": "1.0", "gameObjects": [
              {"id": "Ground", "name": "Ground", "components": [{"type": "Rigidbody", "useGravity": false, "isKinematic": true}]},
              {"id": "Bar", "name": "Bar", "transform": {"localPosition": [0, 1, 0], "localRotation": [-0.174108137594, 0, 0, 0.984726538905]}, "components": [
                {"type": "Rigidbody", "centerOfMass": [0, 0, 0.2], "inertiaTensor": [0.01, 0.01, 0.001]},
                {"type": "HingeJoint", "connectedBody": 0, "autoConfigureConnectedAnchor": false, "connectedAnchor": [0, 1, 0], "useLimits": true,
                 "limits": {"min": -180, "max": 180}, "extendedLimits": {{{(extended ? "true" : "false")}}}, "useMotor": true, "motor": {"targetVelocity": 720, "force": 500}}]}]}
            """));
        AdviceFinding[] motion = advice.Findings.Where(f => f.Diagnostic.Code == DiagnosticCodes.AdviceMotionDiffers).ToArray();
        Assert.That(motion, Has.Length.EqualTo(extended ? 0 : 1));
        Assert.That(motion.SelectMany(f => f.Tried).Count(t => t.Change.StartsWith("Use Extended Limits on HingeJoint", StringComparison.Ordinal)), Is.EqualTo(extended ? 0 : 1));
        foreach (AdviceFinding finding in motion)
        {
            Assert.That(finding.Before.Angle, Is.GreaterThan(30));
            Assert.That(finding.Best!.Change, Does.StartWith("Use Extended Limits"));
            Assert.That(finding.Best.Score, Is.LessThan(1));
            Assert.That(finding.Best.Work, Is.EqualTo(1));
        }
    }

    // Each row is a count of all joints: seconds of a platform on six rods.
    [TestCase("lever", "lever")]
    [TestCase("mechanisms", "M17")]
    public void ClosingJoints_WhoseRowsAreCounted_CanBeCancelled(string folder, string name)
    {
        ValidScene scene = ValidScene.Load(Path.Combine(Path.GetDirectoryName(AdviceScene.Lever)!, "..", folder, name + ".kinefab"));
        var mechanism = Kinefab.Kinematics.Mechanism.Create(scene);
        MobilityReport counted = MobilityAnalysis.Of(mechanism);
        var cancelled = new CancellationToken(true);

        Assert.That(() => name == "M17" ? ClosureRows.Minimal(scene, 12, counted, out _, cancelled) : ClosureRows.Whole(scene, mechanism, counted, out _, cancelled), Throws.InstanceOf<OperationCanceledException>());
    }

    [Test]
    public void Lever_ClosedWithTheLeastRows_SagsAndIsCuredByLockingTheFreeOnes()
    {
        AdviceReport advice = StabilityAdvice.Of(ValidScene.Load(AdviceScene.Lever));

        AdviceFinding drift = Single(advice, DiagnosticCodes.AdviceJointDrifts);
        AdviceFinding motion = Single(advice, DiagnosticCodes.AdviceMotionDiffers);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(drift.Id, Is.EqualTo("Lever/BarC:1"));
            Assert.That(drift.Before.Angle, Is.EqualTo(1.0).Within(0.2), "the bar sags");
            Assert.That(drift.Best!.After.Angle, Is.LessThan(0.02));
            Assert.That(drift.Best.Work, Is.EqualTo(1), "not by more work");
            Assert.That(drift.Best.Edits.Select(e => e.Value), Is.All.EqualTo("\"Locked\"").And.Exactly(3).Items, "the three rows of the hinge that the export left out");
            Assert.That(motion.Id, Is.EqualTo("Lever/Crank:1"));
            Assert.That(motion.Before.Angle, Is.GreaterThan(20), "the sagging bar turns the lever, which truly stays where it is");
            Assert.That(motion.Best!.Edits.Select(e => e.Pointer), Is.EqualTo(drift.Best.Edits.Select(e => e.Pointer)));
            Assert.That(motion.Best.After.Angle, Is.LessThan(0.1));
            Assert.That(drift.Tried.Select(t => t.Change), Has.Some.Contains("Default Solver Iterations 6 -> 12").And.Some.Contains("Fixed Timestep 0.02 -> 0.01"));
        }
    }

    [Test]
    public void Lever_ClosedWithAllRows_IsClearedOfBeingOverConstrained()
    {
        ValidScene whole = AdviceEdits.Apply(AdviceScene.Lever, Single(StabilityAdvice.Of(ValidScene.Load(AdviceScene.Lever)), DiagnosticCodes.AdviceJointDrifts).Best!.Edits);

        AdviceReport advice = StabilityAdvice.Of(whole);

        AdviceFinding loop = advice.Findings.Single();
        using (Assert.EnterMultipleScope())
        {
            Assert.That(loop.Diagnostic.Code, Is.EqualTo(DiagnosticCodes.AdviceLoopOverConstrained));
            Assert.That(loop.Diagnostic.Severity, Is.EqualTo(Severity.Info));
            Assert.That(loop.Best, Is.Null);
            Assert.That(loop.Diagnostic.Message, Does.Contain("holds 3 of the 5 locked freedoms"));
            Assert.That(loop.Tried[0].Score, Is.GreaterThan(1), "with the rows freed it sags again");
        }
    }

    [Test]
    public void Chain_WithAHundredfoldLoad_IsWarnedOfItsMassesWhichScalingCures()
    {
        AdviceReport advice = StabilityAdvice.Of(Chain(8, 0.1, 10).Read());

        AdviceFinding masses = Single(advice, DiagnosticCodes.AdviceMassesUnlike);
        AdviceFinding drift = Single(advice, DiagnosticCodes.AdviceJointDrifts);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(masses.Diagnostic.Severity, Is.EqualTo(Severity.Warning));
            Assert.That(masses.Diagnostic.Message, Does.Contain("Bar6 of 0.1 kg to Bar7 of 10 kg, 1:100"));
            Assert.That(masses.Diagnostic.Pointer, Is.EqualTo("/gameObjects/7/components/1"));
            Assert.That(masses.Best!.Change, Does.Contain("Mass Scale 100 on HingeJoint Bar7 - Bar6"));
            Assert.That(masses.Best.After.Distance, Is.LessThan(0.1 * masses.Before.Distance!.Value));
            Assert.That(drift.Best!.Score, Is.LessThan(drift.Score));
        }
    }

    [Test]
    public void Chain_WithALoadThatHangsStraightDown_StretchesAtRest()
    {
        AdviceFinding masses = Single(StabilityAdvice.Of(Chain(2, 1, 20).Read("""{"gravity": [9.81, 0, 0]}""")), DiagnosticCodes.AdviceMassesUnlike);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(masses.Diagnostic.Severity, Is.EqualTo(Severity.Warning));
            Assert.That(masses.Before.Distance, Is.GreaterThan(0.01));
            Assert.That(masses.Best!.After.Distance, Is.LessThan(0.0005));
        }
    }

    [Test]
    public void Chain_WithALoadThatWeighsNothing_IsClearedOfItsMasses()
    {
        AdviceReport advice = StabilityAdvice.Of(Chain(2, 1, 20).Read("""{"gravity": [0, 0, 0]}"""));

        AdviceFinding masses = advice.Findings.Single();
        Assert.That((masses.Diagnostic.Code, masses.Diagnostic.Severity), Is.EqualTo((DiagnosticCodes.AdviceMassesUnlike, Severity.Info)));
        Assert.That(masses.Tried, Is.Not.Empty);
    }

    [Test]
    public void Bars_ThinForTheStep_AreWarnedOfAndCured()
    {
        AdviceScene scene = new AdviceScene();
        for (int i = 0; i < 3; i++)
            scene.Hinged(0.2).With("centerOfMass", 0.05, 0.03, 0).With("inertiaTensor", 1e-6, 1e-5, 1e-5);

        AdviceReport advice = StabilityAdvice.Of(scene.Read());

        AdviceFinding thin = Single(advice, DiagnosticCodes.AdviceInertiaThin);

        // m g arm h^2 / I about the bar's own axis, from which its anchors stand 0.03 m off.
        double turn = 0.2 * 9.81 * 0.03 * 0.02 * 0.02 / 1e-6;
        using (Assert.EnterMultipleScope())
        {
            Assert.That(thin.Diagnostic.Severity, Is.EqualTo(Severity.Warning));
            Assert.That(thin.Diagnostic.Message, Does.Contain(FormattableString.Invariant($"by {Math.Round(turn, 1)} rad")));
            Assert.That(thin.Best!.Score, Is.LessThan(0.8 * thin.Score));
            Assert.That(thin.Tried[0].Change, Does.Contain("Inertia Tensor"));
        }
    }

    [Test]
    public void Limit_OfThreeDegreesOnAChain_IsPassedAndSaidHowFar()
    {
        const string limits = """{"useLimits": true, "limits": {"min": -1.5, "max": 1.5}}""";

        AdviceReport advice = StabilityAdvice.Of(new AdviceScene().Hinged(1, limits).Hinged(1, limits).Hinged(1, limits).Hinged(1, limits).Read());

        AdviceFinding narrow = Single(advice, DiagnosticCodes.AdviceLimitNarrow);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(narrow.Diagnostic.Severity, Is.EqualTo(Severity.Warning));
            Assert.That(narrow.Diagnostic.Message, Does.Contain("range of 3 degrees (3 more of its mechanism are as narrow)"));
            Assert.That(narrow.Before.Distance, Is.Null);
            Assert.That(narrow.Best!.After.Angle, Is.LessThan(narrow.Before.Angle!.Value / 2));
        }
    }

    [Test]
    public void Limit_OfThreeDegreesOnOneBar_IsKeptAndOnlyMentioned()
    {
        AdviceReport advice = StabilityAdvice.Of(new AdviceScene().Hinged(1, """{"useLimits": true, "limits": {"min": -1.5, "max": 1.5}}""").Read());

        AdviceFinding narrow = Single(advice, DiagnosticCodes.AdviceLimitNarrow);
        Assert.That((narrow.Diagnostic.Severity, narrow.Diagnostic.Remedy), Is.EqualTo((Severity.Info, "Nothing to do.")));
        Assert.That(narrow.Before.Angle, Is.LessThan(0.2));
    }

    [Test]
    public void Chain_ThrownApart_ShakesInUnityAloneAndIsCured()
    {
        AdviceFinding shakes = Single(StabilityAdvice.Of(Chain(8, 0.1, 10).Read()), DiagnosticCodes.AdviceJointShakes);
        Assert.That(shakes.Before.Distance, Is.GreaterThan(0.1));
        Assert.That(shakes.Best!.Score, Is.LessThan(1));
    }

    [Test]
    public void Chain_InChaos_IsHeldAgainstTheExactMotionOnlyWhileThatIsSure()
    {
        // Four bars falling from the horizontal: after the first swing half the step gives another motion.
        AdviceFinding motion = Single(StabilityAdvice.Of(Chain(4, 1, 1).Read(), new AdviceOptions { Seconds = 3 }), DiagnosticCodes.AdviceMotionDiffers);

        double seconds = double.Parse(Regex.Match(motion.Diagnostic.Message, "within ([0-9.]+) s").Groups[1].Value, CultureInfo.InvariantCulture);
        Assert.That(seconds, Is.InRange(0.2, 2));
    }

    [Test]
    public void Bars_FallingFreely_AreNotHeldAgainstTheErrorOfTheirFall()
    {
        // Semi-implicit Euler falls g h t / 2 = 196 mm too far in 2 s; the hinge has no part in it.
        Assert.That(StabilityAdvice.Of(new AdviceScene().Loose(1).Hinged(1).Read()).Findings, Is.Empty);
        Assert.That(StabilityAdvice.Of(new AdviceScene().Loose(1).Read()).Findings, Is.Empty);
    }

    [Test]
    public void Iterations_OfABodysOwn_AreRaisedWithTheProjects()
    {
        AdviceScene chain = Chain(8, 0.1, 10).With("solverIterations", 12);
        TriedChange tried = Single(StabilityAdvice.Of(chain.Read()), DiagnosticCodes.AdviceJointDrifts).Tried.First(t => t.Change.Contains("Iterations", StringComparison.Ordinal));
        Assert.That(
            tried.Edits.Select(e => (e.Pointer, e.Value)),
            Is.EqualTo([("/physics/solverIterations", "24"), ("/gameObjects/7/components/0/solverIterations", "24")]));
        Assert.That(tried.Work, Is.EqualTo(25.0 / 13).Within(1e-12), "position and velocity iterations");
    }

    // A link has no Rigidbody whose number could be set.
    [Test]
    public void Iterations_OfALinksOwn_AreCalledTheLinks()
    {
        ValidScene arm = Dynamics.Articulations.LinkScene.Scene(
            Dynamics.Articulations.LinkScene.Base, Dynamics.Articulations.LinkScene.Link(ArticulationJointType.Revolute) with { SolverIterations = 12 });
        ChangePart[] parts = [.. ProjectSettings.SolverIterations(arm, 2)!.Parts];
        Assert.That(parts[1].What, Is.EqualTo("ArticulationBody.solverIterations -> 24"));
    }

    [Test]
    public void Bar_HeldByADampedDrive_HasNothingToAdvise()
    {
        AdviceReport advice = StabilityAdvice.Of(new AdviceScene().Configured(1, """{"angularXDrive": {"positionSpring": 100, "positionDamper": 4}}""").Read());
        Assert.That((advice.Findings, advice.Report.Diagnostics, advice.Trials), Is.EqualTo((Array.Empty<AdviceFinding>(), Array.Empty<Diagnostic>(), 0)));
    }

    [Test]
    public void Best_OfSeveralThatAreEnough_IsTheOneOfLeastWork()
    {
        AdviceFinding drift = Single(StabilityAdvice.Of(Mechanism("M29")), DiagnosticCodes.AdviceJointDrifts);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(drift.Best!.Change, Does.Contain("Default Solver Iterations 6 -> 12"));
            Assert.That(drift.Tried.Where(t => t.Score < drift.Best.Score).Select(t => t.Work), Is.Not.Empty.And.All.GreaterThan(drift.Best.Work));
        }
    }

    [Test]
    public void Best_OfCures_IsNotOneThatMakesTheMotionWorse()
    {
        AdviceReport advice = StabilityAdvice.Of(AdviceScene.Parse(Slider), new AdviceOptions { Seconds = 0.5 });

        AdviceFinding masses = Single(advice, DiagnosticCodes.AdviceMassesUnlike);
        AdviceFinding motion = Single(advice, DiagnosticCodes.AdviceMotionDiffers);
        Assert.That((masses.Best, masses.Diagnostic.Severity, masses.Tried.Count), Is.EqualTo(((TriedChange?)null, Severity.Info, 2)));
        foreach (TriedChange cure in masses.Tried)
        {
            Assert.That(cure.Score, Is.LessThan(0.8 * masses.Score), "the joints would stand closer");
            Assert.That(motion.Tried.Single(t => t.Change == cure.Change).Score, Is.GreaterThan(1.1 * motion.Score), "but move still less as they should");
        }
    }

    [Test]
    public void Suspect_WhoseRemovalDoesNotHelp_IsNoWarning()
    {
        AdviceFinding loop = Single(StabilityAdvice.Of(Mechanism("M05")), DiagnosticCodes.AdviceLoopOverConstrained);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(loop.Score, Is.GreaterThan(1), "the loop does drift");
            Assert.That(loop.Diagnostic.Severity, Is.EqualTo(Severity.Info));
            Assert.That(loop.Diagnostic.Remedy, Is.EqualTo("None of 2 changes tried against it helps."));
        }
    }

    [Test]
    public void Findings_OfAnyScene_StandWarningsFirstAndWorstFirst()
    {
        AdviceReport advice = StabilityAdvice.Of(Chain(8, 0.1, 10).Read());
        Assert.That(advice.Findings, Has.Count.GreaterThan(2));
        Assert.That(advice.Findings.Select(f => (f.Diagnostic.Severity == Severity.Info, -f.Score)), Is.Ordered);
    }

    [Test]
    public void Scene_WithoutText_IsRefused()
    {
        ValidScene made = Dynamics.SmallScene.Validate(Dynamics.SmallScene.Document(new HingeJoint(), new Rigidbody(), connected: false));
        Assert.That(() => StabilityAdvice.Of(made), Throws.ArgumentException);
    }

    [TestCase(double.NaN)]
    [TestCase(double.PositiveInfinity)]
    [TestCase(0)]
    [TestCase(-1)]
    public void Seconds_ThatAreNoTime_AreRefused(double seconds) =>
        Assert.That(
            () => StabilityAdvice.Of(new AdviceScene().Hinged(1).Read(), new AdviceOptions { Seconds = seconds }),
            Throws.ArgumentException.With.Property(nameof(ArgumentException.ParamName)).EqualTo("options"));

    [Test]
    public void Trials_OfALimitedNumber_AreRemarked()
    {
        AdviceReport advice = StabilityAdvice.Of(ValidScene.Load(AdviceScene.Lever), new AdviceOptions { MaxTrials = 2 });
        Assert.That(advice.Trials, Is.EqualTo(2));
        Assert.That(advice.Report.Diagnostics[^1].Code, Is.EqualTo(DiagnosticCodes.AdviceTrialsSpent));
    }

    [TestCase(2, false)]
    [TestCase(40, true)]
    public void Rows_OfMoreLoopsThanAreTakenApart_AreRemarked(int bars, bool isCapped)
    {
        // Each bar hangs on two hinges of one axis, which hold five rows twice: joints times rows are 2 n times 5 n.
        var scene = new AdviceScene();
        for (int i = 0; i < bars; i++)
            scene.Hinged(1).Apart();
        JsonNode root = JsonNode.Parse(scene.Text())!;
        foreach (JsonNode? bar in root["gameObjects"]!.AsArray())
            bar!["components"]!.AsArray().Add(bar["components"]![1]!.DeepClone());

        AdviceReport advice = StabilityAdvice.Of(AdviceScene.Parse(root.ToJsonString()), new AdviceOptions { Seconds = 0.2 });

        string[] remarks = advice.Report.Diagnostics.Where(d => d.Code == DiagnosticCodes.AdviceRowsUntried).Select(d => d.Message.Split(' ')[0]).ToArray();
        Assert.That(remarks, Is.EqualTo(isCapped ? ["200"] : Array.Empty<string>()));
        Assert.That(advice.Findings.SelectMany(f => f.Tried).Any(t => t.Change.Contains(" Free", StringComparison.Ordinal)), Is.EqualTo(!isCapped));
    }

    [Test]
    public void Seconds_BeyondAllPatience_AreShortenedAndRemarked()
    {
        var scene = new AdviceScene().Configured(1, """{"angularXDrive": {"positionSpring": 100, "positionDamper": 4}}""");

        AdviceReport advice = StabilityAdvice.Of(scene.Read("""{"fixedTimestep": 1e-9}"""));

        Assert.That(advice.Steps, Is.LessThan(1_000_000));
        Assert.That(advice.Report.Diagnostics.Select(d => d.Code), Is.EqualTo([DiagnosticCodes.AdviceRunShortened]));
    }

    [Test]
    public void Scene_OfThousandsOfMechanisms_ListsTheWorstAndCountsTheRest()
    {
        var scene = new AdviceScene();
        for (int i = 0; i < 2001; i++)
            scene.Hinged(1, """{"useLimits": true, "limits": {"min": -1.5, "max": 1.5}}""").Apart();

        AdviceReport advice = StabilityAdvice.Of(scene.Read(), new AdviceOptions { Seconds = 0.2, MaxTrials = 1 });

        Assert.That(advice.Findings, Has.Count.EqualTo(10));
        Assert.That(
            advice.Report.Diagnostics.Skip(10).Select(d => (d.Code, d.Message.Split(' ').First(w => w.All(char.IsDigit)))),
            Is.EqualTo([(DiagnosticCodes.FindingsOmitted, "1991"), (DiagnosticCodes.AdviceLoopsUncounted, "2001")]));
    }

    [Test]
    public void Scene_BeyondTheRangeOfNumbers_IsSaidToBe()
    {
        AdviceReport advice = StabilityAdvice.Of(Wild());
        Assert.That(advice.Report.Diagnostics.Select(d => d.Code), Does.Contain(DiagnosticCodes.AdviceCannotFollow));
    }

    [Test]
    public void Run_WithoutASolution_EndsThereAndSaysSo()
    {
        // Held to the world where it stands, and by a second joint to a place 5 m away: each step costs a thousand parts.
        const string Locked = """{"type":"ConfigurableJoint","xMotion":"Locked","yMotion":"Locked","zMotion":"Locked","autoConfigureConnectedAnchor":false""";
        string text = $$$"""{"format":"kinefab.scene","version":"1.0","gameObjects":[{"id":"a","name":"a","components":[{"type":"Rigidbody"},{{{Locked}}}},{{{Locked}}},"connectedAnchor":[5,0,0]}]}]}""";
        var told = new List<string>();
        AdviceReport advice = StabilityAdvice.Of(ValidScene.Load(Encoding.UTF8.GetBytes(text)), new AdviceOptions { Progress = new Teller(told) });

        Diagnostic found = advice.Report.Diagnostics.Single(d => d.Code == DiagnosticCodes.AdviceCannotFollow);
        Assert.That(found.Message, Does.Contain("exact").And.Contain("a step has no solution").And.Contain("ended after 0.02 s"));
        Assert.That(told.Take(2), Is.EqualTo("unity exact".Split()));
    }

    private sealed class Teller(List<string> told) : IProgress<string>
    {
        public void Report(string value) => told.Add(value);
    }

    [Test]
    public void ConformanceScenes_All_AreAdvisedOnWithoutAFault()
    {
        string folder = Path.Combine(Conformance.ConformanceCases.Folder, "valid");
        string[] files = Directory.GetFiles(folder, "*.kinefab", SearchOption.AllDirectories).Order(StringComparer.Ordinal).ToArray();
        Assert.That(files, Is.Not.Empty);
        foreach (string file in files)
        {
            AdviceReport advice = StabilityAdvice.Of(ValidScene.Load(file), new AdviceOptions { Seconds = 0.1, MaxTrials = 8 });
            foreach (AdviceFinding finding in advice.Findings)
            {
                Assert.That(double.IsFinite(finding.Score) && finding.Tried.All(t => double.IsFinite(t.Score)), file);
                Assert.That(finding.Diagnostic.Message + finding.Diagnostic.Remedy, Does.Not.Contain("{").And.Not.Contains("NaN"), file);
            }
        }
    }

    internal static AdviceFinding Single(AdviceReport advice, string code) => advice.Findings.Single(f => f.Diagnostic.Code == code);

    internal static AdviceScene Chain(int bars, double mass, double last)
    {
        var scene = new AdviceScene();
        for (int i = 0; i < bars; i++)
            scene.Hinged(i == bars - 1 ? last : mass);
        return scene;
    }

    private static ValidScene Mechanism(string name) =>
        ValidScene.Load(Path.Combine(Path.GetDirectoryName(AdviceScene.Lever)!, "..", "mechanisms", name + ".kinefab"));

    // Its weight throws the bar out of the range of numbers within a step.
    private static ValidScene Wild() => new AdviceScene().Hinged(1).With("inertiaTensor", 1e-38, 1e-38, 1e-38).With("centerOfMass", 1e18, 0, 0).Read();
}
