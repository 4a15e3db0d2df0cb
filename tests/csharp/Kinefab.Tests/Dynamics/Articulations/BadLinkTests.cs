using System.Collections.Generic;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>Links that Unity refuses or takes otherwise than written are told; those that are no errors run.</summary>
public sealed class BadLinkTests
{
    private static IEnumerable<string> Paths => ConformanceCases.All.Where(entry => entry.Kind == "scene" && entry.Path.StartsWith("invalid/link/")).Select(entry => entry.Path);

    [TestCaseSource(nameof(Paths))]
    public void Step_OnALinkThatWasTold_ThrowsNothing(string path)
    {
        string file = ConformanceCases.All.Single(entry => entry.Path == path).FullPath;
        ValidScene? scene = null;
        Report report;
        try
        {
            scene = ValidScene.Load(file);
            report = scene.Report;
        }
        catch (SceneFormatException e)
        {
            report = e.Report;
        }

        Assert.That(report.Diagnostics, Is.Not.Empty);
        Assert.That(report.Diagnostics.All(d => d.Remedy.Length > 0 && d.Pointer.Length > 0), Is.True);
        if (scene is null)
            return;
        foreach (SolverKind solver in new[] { SolverKind.Unity, SolverKind.Exact })
        {
            World world = World.Create(scene, solver);
            world.Run(0.5);
            Assert.That(world.Bodies.All(body => body.Pose.Position.IsFinite), Is.True);
        }
    }
}
