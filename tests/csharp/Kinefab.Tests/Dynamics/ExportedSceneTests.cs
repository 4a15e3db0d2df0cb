using System;
using System.IO;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>
/// fixtures/hinge_slider_*: a lid on a hinge about CAD's X at 25 degrees and a carriage on a slide along CAD's -Y at 15 mm, both with
/// the limits -10..80, as exported from a Z-up millimetre and a Y-up metre source. Pushed hard either way they stop where
/// the CAD says. CAD (x, y, z), Z up, is Unity (-x, z, -y).
/// </summary>
public sealed class ExportedSceneTests
{
    private const double Dt = 0.002;

    private static readonly SolverKind[] Solvers = [SolverKind.Unity, SolverKind.Exact];

    [Test]
    public void Hinge_PushedBothWays_StopsAtTheCadLimits(
        [Values("hinge_slider_zup", "hinge_slider_yup")] string fixture, [ValueSource(nameof(Solvers))] SolverKind solver, [Values] bool up)
    {
        World world = Load(fixture, solver);
        WorldBody lid = world.Bodies.Single(b => b.Id == "Box/Lid:1");
        const double exported = 25 * Math.PI / 180;
        // The lid's CAD Y axis, (0, cos, sin) in CAD, at the export.
        Vector3d lidY = lid.Pose.Rotation.InverseRotate(new Vector3d(0, Math.Sin(exported), -Math.Cos(exported)));

        for (int i = 0; i < 1500; i++)
        {
            lid.AddForce(new Vector3d(0, up ? 0.3 : -0.3, 0));
            world.Step(Dt);
        }

        Vector3d y = lid.Pose.Rotation * lidY;
        double angle = Math.Atan2(y.Y, -y.Z) * 180 / Math.PI;
        Assert.That(angle, Is.EqualTo(up ? 80 : -10).Within(0.05));
    }

    [Test]
    public void Slide_PushedBothWays_StopsAtTheCadLimits(
        [Values("hinge_slider_zup", "hinge_slider_yup")] string fixture, [ValueSource(nameof(Solvers))] SolverKind solver, [Values] bool forward)
    {
        World world = Load(fixture, solver);
        WorldBody carriage = world.Bodies.Single(b => b.Id == "Box/Carriage:1");
        // Along CAD's -Y, Unity's +Z, from CAD (40, 5, 25) mm.
        const double zero = -0.005;

        for (int i = 0; i < 1500; i++)
        {
            carriage.AddForce(new Vector3d(0, 0, forward ? 0.05 : -0.05));
            world.Step(Dt);
        }

        Assert.That((carriage.Pose.Position.Z - zero) * 1000, Is.EqualTo(forward ? 80 : -10).Within(0.02), "mm");
        Assert.That(carriage.Pose.Position.X, Is.EqualTo(-0.04).Within(1e-5));
        Assert.That(carriage.Pose.Position.Y, Is.EqualTo(0.025).Within(1e-5));
    }

    private static World Load(string fixture, SolverKind solver) =>
        World.Create(ValidScene.Load(Path.Combine(Scenario.Folder, "..", "..", "fixtures", fixture, "hinge_slider.kinefab")), solver);
}
