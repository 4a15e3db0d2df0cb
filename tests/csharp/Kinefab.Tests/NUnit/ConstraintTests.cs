using System.IO;
using System.Text;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.NUnit;
using Kinefab.Tests.Advice;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using NUnit.Framework;
using NUnit.Framework.Constraints;
using NUnit.Framework.Internal;
using Constraint = NUnit.Framework.Constraints.Constraint;
using static Kinefab.NUnit.MechanismConstraints;

namespace Kinefab.Tests.Constraints;

/// <summary>The constraints of Kinefab.NUnit on the lever: what holds, what does not, and what a failure says.</summary>
public sealed class ConstraintTests
{
    private const string Crank = "Lever/Crank:1";
    private const string Slide = "Lever/SliderD:1.x";

    private static readonly string Root = Path.GetFullPath(Path.Combine(ConformanceCases.Folder, "..", ".."));
    private static readonly string Lever = Path.Combine(Root, "csharp", "examples", "LeverTests", "lever.kinefab");
    private static readonly string Motion = Path.Combine(Root, "csharp", "examples", "LeverTests", "lever.motion.json");

    [Test]
    public void ValidScene_OfASoundFile_Holds() => Assert.That(Lever, Is.ValidScene);

    [Test]
    public void ValidScene_OfABrokenFile_SaysWhatAndWhereAndTheRemedy()
    {
        string file = Path.Combine(Path.GetTempPath(), Path.GetRandomFileName());
        File.WriteAllText(file, """{"format": "kinefab.scene", "version": "1.0", "gameObjects": [{"id": "a"}]}""");
        try
        {
            Assert.That(Failure(file, SceneConstraints.Valid), Does.Contain("Expected: a scene without errors").And.Contain($"But was:  1 error in {file}").And.Contain("/gameObjects/0").And.Contain("line 1"));
        }
        finally
        {
            File.Delete(file);
        }
    }

    // An exception would show where in the library the reading ended, twice, and not the file.
    [TestCaseSource(nameof(All))]
    public void AnyConstraint_OfABrokenFile_FailsWithItsNameAndFindings(Constraint constraint)
    {
        string file = Path.Combine(Path.GetTempPath(), Path.GetRandomFileName());
        File.WriteAllText(file, """{"format": "kinefab.scene", "version": "1.0", "gameObjects": [{"id": "a"}]}""");
        try
        {
            Assert.That(Failure(file, constraint), Does.Contain($"Expected: {constraint.Description}").And.Contain($"But was:  1 error in {file}").And.Contain("/gameObjects/0").And.Contain("line 1"));
        }
        finally
        {
            File.Delete(file);
        }
    }

    [TestCaseSource(nameof(All))]
    public void AnyConstraint_OfNoFile_FailsWithItsName(Constraint constraint) =>
        Assert.That(Failure("no_such.kinefab", constraint), Does.Contain("But was:  1 error in no_such.kinefab").And.Contain("SCENE_NOT_FOUND"));

    [Test]
    public void ValidScene_OfSomethingElse_IsAWrongCall() => Assert.That(() => SceneConstraints.Valid.ApplyTo(3), Throws.ArgumentException);

    [Test]
    public void Mobility_OfTheLever_IsOne() => Assert.That(Lever, Has.Mobility(1));

    [Test]
    public void ValidSceneAndMobility_BehindOthers_AreTheSame()
    {
        Assert.That(Lever, Is.ValidScene.And.Mobility(1));
        Assert.That(Lever, Is.ValidScene.And.Not.Mobility(2));
        Assert.That(new FileInfo("no_such.kinefab"), Is.Not.ValidScene);
        IResolveConstraint not = Is.Not.ValidScene;
        Assert.That(Failure(Lever, (Constraint)not.Resolve()), Does.Contain("Expected: not a scene without errors"));
    }

    [Test]
    public void Mobility_Another_SaysWhatEachBodyCanDo() => Assert.That(
        Failure(Lever, SceneConstraints.Mobility(2)), Does.Contain("Expected: mobility 2").And.Contain("But was:  mobility 1").And.Contain("Lever/BarC:1: 0 translations, 1 rotation\n"));

    [Test]
    public void Drives_RoundAndBack_MovesTheSlideByTwiceTheRadius()
    {
        Mechanism mechanism = Mechanism.Create(ValidScene.Load(Lever));
        Assert.That(mechanism, Drives(Crank).From(0).To(360).Steps(360).Moving(Slide).By(0.05).Within(1e-6));
        Assert.That(mechanism, Drives(Crank).To(-360).Steps(360).Moving(Slide).By(0.05).Within(1e-6));
    }

    [Test]
    public void Drives_WithAnotherStroke_ShowsTheSeriesInItsUnits() => Assert.That(
        Failure(Lever, Drives(Crank).To(90).Moving(Slide).By(0.07)),
        Does.Contain($"{Slide} moves by 0.0").And.Contain(" m").And.Contain($"{Crank}.angle [degrees]  {Slide} [m]"));

    [Test]
    public void Drives_BeyondADeadCentre_SaysWhereItStops() => Assert.That(
        Failure(Lever, Drives(Slide).To(0.2)), Does.Contain("it stops at 0.0042").And.Contain(" m: a dead centre"));

    [Test]
    public void Drives_AnUnknownName_IsAWrongCallThatNamesWhatThereIs() => Assert.That(
        () => Drives("Shift").ApplyTo(Lever), Throws.ArgumentException.With.Message.Contains(Crank));

    [Test]
    public void Closes_AtTheExportedPose_Holds()
    {
        Assert.That(Lever, Closes.Within(1e-9));
        Assert.That(Failure(Lever, Closes.Within(0)), Does.Contain("m and"));
    }

    [Test]
    public void Energy_OfAPendulum_IsKeptByTheExactSolverAndNotByUnitys()
    {
        ValidScene pendulum = SceneValidator.Validate(SceneFile.Parse(Encoding.UTF8.GetBytes(new AdviceScene().Hinged(1).With("angularDamping", 0).Text())).Document!).Scene!;
        Assert.That(pendulum, Keeps.Energy.Within(2).Percent.For(seconds: 2));
        Assert.That(Failure(pendulum, Keeps.Energy.Within(2).Percent.For(seconds: 2).By(SolverKind.Unity)), Does.Contain("J more after").And.Contain("time [s]  energy [J]"));
        Assert.That(Failure(pendulum, Keeps.Energy.Within(1e-6).For(seconds: 2).By(SolverKind.Unity)), Does.Contain("within 1E-06 J for 2 s"));
    }

    [Test]
    public void Energy_OfAMechanismAtRest_IsKept() => Assert.That(Lever, Keeps.Energy.Within(0.1).Percent.For(seconds: 1));

    [Test]
    public void Trajectory_OfASweep_IsFollowed() => Assert.That(Lever, Matches.Trajectory(Motion).Within(1e-9));

    [Test]
    public void Trajectory_OfAnotherMotion_NamesTheBodyAndThePlace()
    {
        string file = Path.Combine(Path.GetTempPath(), Path.GetRandomFileName());
        string text = File.ReadAllText(Motion);
        int at = text.IndexOf("\"id\":\"Lever/BarC:1\",\"poses\":[[", System.StringComparison.Ordinal);
        Assert.That(at, Is.GreaterThan(0));
        int first = text.IndexOf("[[", at, System.StringComparison.Ordinal) + 2;
        File.WriteAllText(file, text[..first] + "9" + text[text.IndexOf(',', first)..]);
        try
        {
            Assert.That(Failure(Lever, Matches.Trajectory(file)), Does.Contain("Lever/BarC:1 is off by").And.Contain(" at 0"));
            File.WriteAllText(file, "{}");
            Assert.That(Failure(Lever, Matches.Trajectory(file)), Does.Contain($"But was:  {file} is no trajectory of dotnet kinefab: "));
            File.WriteAllText(file, text.Replace("Lever/BarC:1", "Lever/Rod", System.StringComparison.Ordinal));
            Assert.That(Failure(Lever, Matches.Trajectory(file)), Does.Contain($"But was:  {file} is of another scene: this one has no Lever/Rod"));
            File.WriteAllText(file, System.Text.RegularExpressions.Regex.Replace(text, "\"component\": *[0-9]+", "\"component\":77"));
            Assert.That(Failure(Lever, Matches.Trajectory(file)), Does.Contain($"{Crank}[77] has no Angle to drive in this scene"));
        }
        finally
        {
            File.Delete(file);
        }
    }

    // It held of any motion.
    [TestCase("[0, 0.02]", "bodies")]
    [TestCase("[]", "times")]
    public void Trajectory_OfNothing_IsNone(string times, string what)
    {
        string file = Path.Combine(Path.GetTempPath(), Path.GetRandomFileName());
        string bodies = what == "times" ? """{"gameObject": 0, "id": "Lever/Crank:1", "poses": []}""" : "";
        File.WriteAllText(file, $$"""{"format": "kinefab.trajectory", "version": "1.0", "solver": "exact", "step": 0.02, "times": {{times}}, "coordinates": [], "bodies": [{{bodies}}]}""");
        try
        {
            Assert.That(Failure(Lever, Matches.Trajectory(file)), Does.Contain($"But was:  {file} is no trajectory of dotnet kinefab: It has no {what}, and would hold of any motion."));
        }
        finally
        {
            File.Delete(file);
        }
    }

    [TestCase("0")]
    [TestCase("-0.02")]
    [TestCase("1e999")]
    public void Trajectory_OfNoStep_IsNone(string step)
    {
        string file = Path.Combine(Path.GetTempPath(), Path.GetRandomFileName());
        File.WriteAllText(file, $$"""{"format": "kinefab.trajectory", "version": "1.0", "solver": "exact", "step": {{step}}, "times": [0, 0.02], "coordinates": [], "bodies": []}""");
        try
        {
            Assert.That(Failure(Lever, Matches.Trajectory(file)), Does.Contain($"But was:  {file} is no trajectory of dotnet kinefab: Its step is no positive number of seconds."));
        }
        finally
        {
            File.Delete(file);
        }
    }

    [Test]
    public void Trajectory_WithoutItsFile_FailsAndSaysHowItIsRecorded()
    {
        Assert.That(Failure(Lever, Matches.Trajectory("nope.json")), Does.Contain("But was:  there is no file nope.json").And.Contain("dotnet kinefab sweep").And.Not.Contain("   at "));
        Assert.That(Failure(Lever, Matches.Trajectory(Root)), Does.Contain($"But was:  {Root} cannot be read"));
    }

    [Test]
    public void Numbers_ThatNoTestCanBeMadeWith_AreToldWithTheRule()
    {
        Assert.That(() => Keeps.Energy.For(seconds: -10), Throws.InstanceOf<System.ArgumentOutOfRangeException>().With.Message.Contains("seconds above 0").And.Message.Contains("-10"));
        Assert.That(() => Keeps.Energy.Within(-1), Throws.InstanceOf<System.ArgumentOutOfRangeException>().With.Message.Contains("0 or more"));
        Assert.That(() => Closes.Within(double.NaN), Throws.InstanceOf<System.ArgumentOutOfRangeException>().With.Message.Contains("0 or more"));
        Assert.That(() => Drives(Crank).Steps(0), Throws.InstanceOf<System.ArgumentOutOfRangeException>().With.Message.Contains("1 step or more"));
    }

    private static Constraint[] All() => [SceneConstraints.Valid, SceneConstraints.Mobility(1), Drives(Crank), Closes.Within(1e-9), Keeps.Energy.Within(1), Matches.Trajectory(Motion)];

    private static string Failure<T>(T actual, Constraint constraint)
    {
        ConstraintResult result = constraint.ApplyTo(actual);
        Assert.That(result.IsSuccess, Is.False);
        using var writer = new TextMessageWriter();
        result.WriteMessageTo(writer);
        return writer.ToString();
    }
}
