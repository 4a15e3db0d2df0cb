using System.Collections.Generic;
using System.IO;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Tests.Conformance;
using Kinefab.Tests.Dynamics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>A joint that is switched off is as if it were not there: held against the same scene without it.</summary>
public sealed class DisabledJointTests
{
    private static readonly string Lid = Path.Combine(ConformanceCases.Folder, "valid", "hinge", "switched_off.kinefab");

    [Test]
    public void Mobility_WithAndWithout_IsTheSame()
    {
        MobilityReport off = Mechanism.Create(Scene()).CountMobility();
        MobilityReport without = Mechanism.Create(Without(Scene())).CountMobility();

        Assert.That((off.Mobility, off.Rows, off.Redundant, off.Islands.Count), Is.EqualTo((2, 10, 0, 1)));
        Assert.That((without.Mobility, without.Rows, without.Redundant, without.Islands.Count), Is.EqualTo((2, 10, 0, 1)));
    }

    [Test]
    public void Coordinates_BesideOneThatIsOff_KeepTheirNames() =>
        Assert.That(Mechanism.Create(Scene()).Coordinates.Select(c => c.Name), Is.EqualTo(["Box/Lid:1.angle", "Box/Knob:1.angle"]));

    [Test]
    public void Coordinate_OfOneThatIsOff_IsNone()
    {
        Mechanism mechanism = Mechanism.Create(Scene());

        Assert.That(mechanism.FindCoordinate(1, 1, Coordinate.Angle), Is.EqualTo(-1));
        Assert.That(mechanism.Couplings, Is.Empty, "one that counts by it is none");
    }

    [TestCase(SolverKind.Unity)]
    [TestCase(SolverKind.Exact)]
    public void Run_WithAndWithout_HasTheSameBits(SolverKind solver)
    {
        World off = World.Create(Scene(), solver);
        World without = World.Create(Without(Scene()), solver);

        SmallScene.Run(off, 0.5);
        SmallScene.Run(without, 0.5);

        Assert.That(off.Joints.Select(j => j.Component), Is.EqualTo([2, 1]));
        Assert.That(off.StateHash(), Is.EqualTo(without.StateHash()));
        Assert.That(off.Joints[0].Coordinate(Coordinate.Angle), Is.Not.EqualTo(0).Within(1), "the lid falls");
    }

    [Test]
    public void Save_OneSwitchedOff_IsKeptAndMakesTheFile11()
    {
        SceneDocument document = Scene().Document;
        using var saved = new MemoryStream();
        SceneFile.Save(document with { Couplings = [] }, saved);
        string text = System.Text.Encoding.UTF8.GetString(saved.ToArray());

        Assert.That(text, Does.Contain("\"version\": \"1.1\"").And.Contain("\"enabled\": false").And.Not.Contain("\"enabled\": true"));
    }

    private static ValidScene Scene() => ValidScene.Load(Lid);

    private static ValidScene Without(ValidScene scene)
    {
        var objects = new List<GameObject>();
        foreach (GameObject gameObject in scene.Document.GameObjects)
            objects.Add(gameObject with { Components = gameObject.Components.Where(c => c is not Joint { Enabled: false }).ToArray() });
        return SmallScene.Validate(scene.Document with { GameObjects = objects, Couplings = [] });
    }
}
