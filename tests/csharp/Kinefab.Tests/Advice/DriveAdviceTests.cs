using System;
using System.Linq;
using Kinefab.Advice;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Advice;

/// <summary>Drives that cannot hold and springs that do not come to rest. A bar of 1 kg and 0.2 m weighs 0.981 N m on its hinge.</summary>
public sealed class DriveAdviceTests
{
    private const double Needed = 9.81 * 0.1;

    [TestCase(0.6, 1.2)]
    [TestCase(0.3, 1.2)]
    public void Drive_BelowTheWeight_SinksAndTheFirstDoublingAboveItHolds(double force, double holds)
    {
        AdviceReport advice = StabilityAdvice.Of(Driven(force));

        AdviceFinding weak = StabilityAdviceTests.Single(advice, DiagnosticCodes.AdviceDriveWeak);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(holds, Is.GreaterThan(Needed).And.LessThan(2 * Needed), "the first doubling");
            Assert.That(weak.Diagnostic.Message, Does.Contain(FormattableString.Invariant($"cannot hold the exported pose with {force} N m")));
            Assert.That(weak.Diagnostic.Pointer, Is.EqualTo("/gameObjects/0/components/1/angularXDrive"));
            Assert.That(weak.Before.Angle, Is.GreaterThan(30));
            Assert.That(weak.Best!.Edits.Single().Value, Is.EqualTo(FormattableString.Invariant($"{holds}")));

            // What is left is the spring's own sag: 0.981 / 1000 rad.
            Assert.That(weak.Best.After.Angle, Is.EqualTo(Needed / 1000 * 180 / Math.PI).Within(0.01));
        }
    }

    [TestCase(1.1)]
    [TestCase(1e30)]
    public void Drive_AboveTheWeight_IsNotMentioned(double force) =>
        Assert.That(StabilityAdvice.Of(Driven(force)).Findings.Select(f => f.Diagnostic.Code), Has.None.EqualTo(DiagnosticCodes.AdviceDriveWeak));

    [TestCase(0.9, true)]
    [TestCase(1.1, false)]
    public void Motor_AsBrake_IsWeakJustBelowTheWeight(double force, bool isWeak)
    {
        ValidScene scene = new AdviceScene().Hinged(1, FormattableString.Invariant($$$"""{"useMotor": true, "motor": {"targetVelocity": 0, "force": {{{force}}}}}""")).Read();
        Assert.That(StabilityAdvice.Of(scene).Findings.Any(f => f.Diagnostic.Code == DiagnosticCodes.AdviceDriveWeak), Is.EqualTo(isWeak));
    }

    [Test]
    public void Drives_OfAnArm_AreRaisedWhereTheyAreWeakAlone()
    {
        // Two bars: the shoulder bears 3.924 N m, the elbow 0.981 N m.
        const string drive = """{"angularXDrive": {"positionSpring": 5000, "positionDamper": 100, "maximumForce": 3}}""";

        AdviceFinding weak = StabilityAdvice.Of(new AdviceScene().Configured(1, drive).Configured(1, drive).Read()).Findings
            .Single(f => f.Diagnostic.Code == DiagnosticCodes.AdviceDriveWeak);

        Assert.That(weak.Id, Is.EqualTo("Bar0"));
        Assert.That(weak.Best!.Change, Does.Contain("Maximum Force 3 -> 6 on ConfigurableJoint Bar0 - world"));
    }

    [Test]
    public void Drives_OfManyArms_AreListedWorstFirstAndTheRestCounted()
    {
        // Two weak drives an arm, twelve arms. In the fall of an arm its elbow would bear m g L / 8 = 0.245 N m.
        const string drive = """{"angularXDrive": {"positionSpring": 1000, "positionDamper": 20, "maximumForce": 0.1}}""";
        var scene = new AdviceScene();
        for (int i = 0; i < 12; i++)
            scene.Configured(1, drive).Apart().Configured(1, drive);

        AdviceReport advice = StabilityAdvice.Of(scene.Read(), new AdviceOptions { Seconds = 0.5 });

        AdviceFinding[] weak = advice.Findings.Where(f => f.Diagnostic.Code == DiagnosticCodes.AdviceDriveWeak).ToArray();
        using (Assert.EnterMultipleScope())
        {
            Assert.That(weak, Has.Length.EqualTo(10));
            Assert.That(weak[0].Diagnostic.Message, Does.Contain("within 0.5 s; so does 1 more of its mechanism."));
            Assert.That(weak[0].Best!.Edits, Has.Count.EqualTo(2), "of its own arm alone");
            Assert.That(advice.Report.Diagnostics.Select(d => d.Code), Does.Contain(DiagnosticCodes.FindingsOmitted));
        }
    }

    [TestCase(1, 0, 0)]
    [TestCase(2, 1, 0)]
    [TestCase(4, 1, 2)]
    public void Trials_OfALimitedNumber_BoundTheDrivesToo(int trials, int findings, int doublings)
    {
        // 0.03 N m takes six doublings, and two runs to find out.
        AdviceReport advice = StabilityAdvice.Of(Driven(0.03), new AdviceOptions { MaxTrials = trials });

        AdviceFinding[] weak = advice.Findings.Where(f => f.Diagnostic.Code == DiagnosticCodes.AdviceDriveWeak).ToArray();
        Assert.That((advice.Trials, weak.Length, weak.Sum(f => f.Tried.Count)), Is.EqualTo((trials, findings, doublings)));
        Assert.That(advice.Report.Diagnostics.Select(d => d.Code), Does.Contain(DiagnosticCodes.AdviceTrialsSpent));
    }

    [Test]
    public void Drive_WithoutGravity_HoldsAnything()
    {
        var floating = new AdviceScene().Configured(1, """{"angularXDrive": {"positionSpring": 100, "positionDamper": 4, "maximumForce": 0.01}}""");
        Assert.That(StabilityAdvice.Of(floating.Read("""{"gravity": [0, 0, 0]}""")).Findings, Is.Empty);
    }

    [Test]
    public void Spring_WithoutDamper_RingsAndTheCriticalDamperStopsIt()
    {
        ValidScene scene = new AdviceScene().Configured(1, """{"angularXDrive": {"positionSpring": 2, "positionDamper": 0}}""").Read();

        AdviceFinding rings = StabilityAdviceTests.Single(StabilityAdvice.Of(scene), DiagnosticCodes.AdviceDriveRings);

        // I = m (L^2 / 3 + w^2 / 12) about the hinge; it swings by its spring and its weight: d = 2 k / omega.
        double inertia = 1 * (0.2 * 0.2 / 3 + 0.02 * 0.02 / 12);
        double atRest = RestAngle(2);
        double omega = Math.Sqrt((2 + Needed * Math.Sin(atRest)) / inertia);
        double damper = double.Parse(rings.Best!.Edits.Single().Value, System.Globalization.CultureInfo.InvariantCulture);
        using (Assert.EnterMultipleScope())
        {
            Assert.That(rings.Diagnostic.Message, Does.Contain("goes on swinging by"));
            Assert.That(rings.Best.Edits.Single().Pointer, Is.EqualTo("/gameObjects/0/components/1/angularXDrive/positionDamper"));
            Assert.That(damper, Is.EqualTo(2 * 2 / omega).Within(0.1 * damper), "critical damping, from the measured period");
            Assert.That(rings.Best.After.Angle, Is.LessThan(0.01));
        }
    }

    [Test]
    public void Spring_TooStiffForTheStepToFollow_IsNotReportedSinceUnityDampsIt()
    {
        // omega h = sqrt(5000 / 0.0134) * 0.02 = 12: explicit springs would explode, PhysX's implicit ones come to rest.
        ValidScene scene = new AdviceScene().Configured(1, """{"angularXDrive": {"positionSpring": 5000, "positionDamper": 0}}""").Read();

        Assert.That(StabilityAdvice.Of(scene).Findings, Is.Empty);
        World world = World.Create(scene);
        var angles = new double[100];
        for (int i = 0; i < angles.Length; i++)
        {
            world.Step(0.02);
            angles[i] = world.Joints[0].Coordinate(Coordinate.AngularX);
        }

        Assert.That(angles[^1], Is.EqualTo(angles[50]).Within(1e-9).And.GreaterThan(-1));
    }

    private static ValidScene Driven(double force) => new AdviceScene()
        .Configured(1, FormattableString.Invariant($$$"""{"angularXDrive": {"positionSpring": 1000, "positionDamper": 20, "maximumForce": {{{force}}}}}""")).Read();

    // k q = m g r cos q.
    private static double RestAngle(double spring)
    {
        double q = 0;
        for (int i = 0; i < 100; i++)
            q = Needed * Math.Cos(q) / spring;
        return q;
    }
}
