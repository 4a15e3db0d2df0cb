using System;
using System.Globalization;
using System.Linq;
using System.Text.RegularExpressions;
using System.Threading;
using Kinefab.Advice;
using Kinefab.Collisions;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Collisions;

/// <summary>Which pairs are told, and how deep they overlap, in scenes whose answer is known; the export's own check: test_overlaps_in_both_languages.py.</summary>
public sealed class StartOverlapsTests
{
    private static readonly BoxCollider Cube = new() { Size = new Vector3d(0.2, 0.2, 0.2) };

    [Test]
    public void Boxes_ThatOverlap_AreToldWithTheirDepth() => Assert.That(Depth(Body("A", Cube), Body("B", Cube, 0.15)), Is.EqualTo(0.05).Within(1e-9));

    [Test]
    public void Finding_OfAPair_NamesBothAndThePlace()
    {
        Diagnostic told = Told(Body("A", Cube), Body("B", Cube, 0.15)).Single();
        Assert.Multiple(() =>
        {
            Assert.That(told.Code, Is.EqualTo(DiagnosticCodes.CollidersOverlap));
            Assert.That(told.Severity, Is.EqualTo(Severity.Warning));
            Assert.That(told.Pointer, Is.EqualTo("/gameObjects/0"));
            Assert.That(told.Message, Does.StartWith("The colliders of A and B overlap by 0.05 m"));
        });
    }

    // Shallower than 2 % of the smaller one, 4 mm, or than the contact offset of 10 mm.
    [TestCase(0.197, false)]
    [TestCase(0.195, true)]
    [TestCase(0.25, false)]
    public void Boxes_ByTheirDistance_AreToldBeyondWhatIsTolerated(double distance, bool isTold) =>
        Assert.That(Told(Body("A", Cube), Body("B", Cube, distance)), isTold ? Has.Length.EqualTo(1) : Is.Empty);

    [TestCase(0.15, 0.05)]
    [TestCase(0.0, 0.2)]
    public void Balls_ThatOverlap_DoSoByTheirRadii(double distance, double depth) =>
        Assert.That(Depth(Body("A", new SphereCollider { Radius = 0.1 }), Body("B", new SphereCollider { Radius = 0.1 }, distance)), Is.EqualTo(depth).Within(1e-9));

    // The cube's nearest face is 0.1 from its middle.
    [TestCase(0.0, 0.15)]
    [TestCase(0.12, 0.03)]
    public void Ball_InACube_IsPushedOutThroughTheNearestFace(double distance, double depth) =>
        Assert.That(Depth(Body("A", Cube), Body("B", new SphereCollider { Radius = 0.05 }, distance)), Is.EqualTo(depth).Within(1e-9));

    [Test]
    public void Capsules_ThatCross_DoSoByTheirRadii() => Assert.That(
        Depth(Body("A", new CapsuleCollider { Radius = 0.05, Height = 0.4, Direction = Axis.Y }), Body("B", new CapsuleCollider { Radius = 0.03, Height = 0.4, Direction = Axis.Z }, 0.06)),
        Is.EqualTo(0.02).Within(1e-9));

    [Test]
    public void Capsule_UnderAScale_HasUnitysRadiusAndHeight()
    {
        // Along Y: 2 times the radius by the larger of X and Z, half the height: both caps meet in a ball of 0.1.
        GameObject scaled = Body("A", new CapsuleCollider { Radius = 0.05, Height = 0.4 });
        scaled = scaled with { Transform = scaled.Transform with { LocalScale = new Vector3d(2, 0.5, 1) } };
        Assert.That(Depth(scaled, Body("B", new SphereCollider { Radius = 0.1 }, 0.17)), Is.EqualTo(0.03).Within(1e-9));
    }

    [Test]
    public void Pairs_ThatAJointConnects_AreNotTold()
    {
        GameObject joined = Body("B", Cube, 0.15, new FixedJoint { ConnectedBody = 0 });
        GameObject colliding = Body("B", Cube, 0.15, new FixedJoint { ConnectedBody = 0, EnableCollision = true });
        Assert.Multiple(() =>
        {
            Assert.That(Told(Body("A", Cube), joined), Is.Empty);
            Assert.That(Told(Body("A", Cube), colliding), Has.Length.EqualTo(1));
            Assert.That(Told(Body("A", Cube), Body("B", Cube, 0.15, new FixedJoint { ConnectedBody = 0, Enabled = false })), Has.Length.EqualTo(1));
        });
    }

    [Test]
    public void Pairs_ThatTheSourceIgnores_AreNotTold()
    {
        // The rule names the body, the colliders stand below it.
        GameObject[] objects = [Body("A", null), Child("a", 0, Cube), Body("B", Cube, 0.15)];
        Assert.Multiple(() =>
        {
            Assert.That(Told(Scene(objects)), Has.Length.EqualTo(1));
            Assert.That(Told(Scene(objects) with { IgnoredCollisions = [new IgnoredCollision { A = 2, B = 0 }] }), Is.Empty);
        });
    }

    [Test]
    public void Pairs_ThatNothingMoves_AreNotTold()
    {
        GameObject led = Body("A", Cube) with { Components = [Cube, new Rigidbody { IsKinematic = true }] };
        GameObject scenery = new() { Id = "floor", Name = "floor", Components = [Cube] };
        Assert.Multiple(() =>
        {
            Assert.That(Told(led, scenery), Is.Empty);
            Assert.That(Told(Body("A", Cube, 0.15), scenery), Has.Length.EqualTo(1));
        });
    }

    [Test]
    public void Colliders_ThatTouchNothing_AreNotTold() => Assert.Multiple(() =>
    {
        Assert.That(Told(Body("A", Cube), Body("B", Cube with { IsTrigger = true }, 0.15)), Is.Empty);
        Assert.That(Told(Body("A", Cube), Body("B", Cube with { Enabled = false }, 0.15)), Is.Empty);
        Assert.That(Told(Body("A", Cube), Body("B", Cube, 0.15) with { Active = false }), Is.Empty);
        Assert.That(Told(Body("A", Cube), Body("B", Cube with { Size = Vector3d.Zero }, 0.15)), Is.Empty);
    });

    [Test]
    public void Links_OfOneArticulation_PassTheOneAboveAlone()
    {
        GameObject root = new() { Id = "root", Name = "root", Components = [new ArticulationBody(), Cube] };
        GameObject Link(string id, int parent, double x) => new()
        {
            Id = id,
            Name = id,
            Parent = parent,
            Transform = Transform.Default with { LocalPosition = new Vector3d(x, 0, 0) },
            Components = [new ArticulationBody { JointType = ArticulationJointType.Revolute }, Cube],
        };
        string[] told = Told(root, Link("first", 0, 0.15), Link("second", 1, -0.1)).Select(d => d.Message).ToArray();
        Assert.That(told, Is.EqualTo(new[] { told[0] }).And.All.StartsWith("The colliders of root and second overlap by 0.15 m"));
    }

    [Test]
    public void Advice_OfAScene_TellsThem()
    {
        string text = new Advice.AdviceScene().Hinged(1).Hinged(1).Loose(1).Text();
        ValidScene scene = ValidScene.Load(System.Text.Encoding.UTF8.GetBytes(WithBalls(text)));
        string[] told = StabilityAdvice.Of(scene).Report.Diagnostics.Where(d => d.Code == DiagnosticCodes.CollidersOverlap).Select(d => d.Message).ToArray();
        Assert.That(told, Is.Not.Empty.And.EqualTo(StartOverlaps.Of(scene).Diagnostics.Select(d => d.Message)));
    }

    [Test]
    public void Of_Cancelled_Ends() => Assert.That(
        () => StartOverlaps.Of(Valid(Scene(Body("A", Cube), Body("B", Cube, 0.15))), new CancellationToken(true)), Throws.InstanceOf<OperationCanceledException>());

    // One body's colliders give no pair to look at, however many there are.
    [Test]
    public void Of_OneBodysColliders_CancelledOnTheWayToThePairs_Ends() => Assert.That(
        () => StartOverlaps.Of(Valid(Scene(Body("A", Cube), Child("B", 0, Cube))), new CancellationToken(true)), Throws.InstanceOf<OperationCanceledException>());

    private static string WithBalls(string text) =>
        text.Replace("\"components\":[", "\"components\":[{\"type\":\"SphereCollider\",\"radius\":0.15},", StringComparison.Ordinal);

    private static double Depth(params GameObject[] objects) =>
        double.Parse(Regex.Match(Told(objects).Single().Message, @"overlap by (\S+) m").Groups[1].Value, CultureInfo.InvariantCulture);

    private static Diagnostic[] Told(params GameObject[] objects) => Told(Scene(objects));

    private static Diagnostic[] Told(SceneDocument scene) => StartOverlaps.Of(Valid(scene)).Diagnostics.ToArray();

    private static SceneDocument Scene(params GameObject[] objects) => new() { GameObjects = objects };

    private static ValidScene Valid(SceneDocument scene)
    {
        SceneValidation done = SceneValidator.Validate(scene);
        Assert.That(done.Scene, Is.Not.Null, string.Join("\n", done.Report.Diagnostics));
        return done.Scene!;
    }

    private static GameObject Body(string id, Component? collider, double x = 0, params Component[] more) => new()
    {
        Id = id,
        Name = id,
        Transform = Transform.Default with { LocalPosition = new Vector3d(x, 0, 0) },
        Components = [.. new[] { collider, new Rigidbody() }.OfType<Component>(), .. more],
    };

    private static GameObject Child(string id, int parent, Component collider) => new() { Id = id, Name = id, Parent = parent, Components = [collider] };
}
