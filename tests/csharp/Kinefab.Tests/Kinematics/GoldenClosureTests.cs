using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>
/// The golden scenes, whose closing joints are whole, against those of format 1.0, whose closing joints hold only what their loop needs:
/// the same verdict, the same mobility, the same motion.
/// </summary>
public class GoldenClosureTests
{
    private const double Metres = 1e-6;

    /// <summary>How far a joint is driven either way.</summary>
    private const double Degrees = 20, Length = 0.01;

    private static readonly string Today = Path.Combine(ExportedMechanism.Fixtures, "format_1_1");

    private static IEnumerable<TestCaseData> Scenes() => Directory.GetFiles(Today, "*.kinefab", SearchOption.AllDirectories)
        .Order(StringComparer.Ordinal)
        .Select(path => new TestCaseData(Path.GetRelativePath(Today, path)).SetArgDisplayNames(Path.GetFileNameWithoutExtension(path)));

    [TestCaseSource(nameof(Scenes))]
    public void Scene_OfWholeClosures_MovesAsThatOfTheFewestRows(string path)
    {
        (ValidScene whole, ValidScene fewest) = (ExportedMechanism.Load(Path.Combine(Today, path)), ExportedMechanism.Load(Path.Combine(ExportedMechanism.Fixtures, path)));
        (Mechanism first, Mechanism second) = (Mechanism.Create(whole), Mechanism.Create(fewest));
        (MobilityReport one, MobilityReport other) = (MobilityAnalysis.Of(first), MobilityAnalysis.Of(second));
        using (Assert.EnterMultipleScope())
        {
            Assert.That((one.Mobility, one.FirstOrder, one.AtGeneralPose), Is.EqualTo((other.Mobility, other.FirstOrder, other.AtGeneralPose)));
            Assert.That(Freedoms(whole, one), Is.EquivalentTo(Freedoms(fewest, other)));
            Assert.That(one.Redundant, Is.GreaterThanOrEqualTo(other.Redundant));
        }

        if (one.Mobility != 1)
            return; // Which of several motions follows a drive is a choice.
        foreach (MechanismCoordinate driven in first.Coordinates.Where(c => !c.IsLocked && Tree(whole, c) is { } joint && joint == Tree(fewest, c)).Take(1))
        {
            foreach (double way in new[] { 1, -1 })
                Assert.That(Moved(first, whole, driven, way), Is.EqualTo(Moved(second, fewest, driven, way)).Within(Metres), driven.Name);
        }
    }

    /// <summary>Where all bodies are after a drive, in the order of their ids, and how it ended.</summary>
    private static double[] Moved(Mechanism mechanism, ValidScene scene, MechanismCoordinate driven, double way)
    {
        MechanismState state = mechanism.NewState();
        var target = new CoordinateTarget(mechanism.FindCoordinate(driven.GameObject, driven.Component, driven.Coordinate), way * (driven.IsAngle ? Degrees : Length));
        DriveResult result = new PositionSolver(mechanism).Drive(state, [target]);
        IEnumerable<string> bodies = scene.Document.GameObjects.Where(o => o.Components.OfType<Rigidbody>().Any()).Select(o => o.Id).Order(StringComparer.Ordinal);
        return [result.Converged ? 1 : 0, .. bodies.Select(id => state.Pose(id).Position).SelectMany(p => new[] { p.X, p.Y, p.Z })];
    }

    /// <summary>The joint of a coordinate, where it closes no loop: its object, type and place among the components.</summary>
    private static (string Id, Type Type, int Component)? Tree(ValidScene scene, MechanismCoordinate at)
    {
        GameObject owner = scene.Document.GameObjects[at.GameObject];
        return at.Component < owner.Components.Count && owner.Components[at.Component] is Joint { Closure: false } joint ? (owner.Id, joint.GetType(), at.Component) : null;
    }

    private static IEnumerable<(string Id, int Translations, int Rotations)> Freedoms(ValidScene scene, MobilityReport found) =>
        found.Bodies.Select(b => (scene.Document.GameObjects[b.GameObject].Id, b.Translations, b.Rotations));
}
