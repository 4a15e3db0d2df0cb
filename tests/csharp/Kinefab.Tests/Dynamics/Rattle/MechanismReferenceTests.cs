using System;
using System.Collections.Generic;
using System.IO;
using System.Text;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Mechanisms against their motion in minimal coordinates, tests/reference/dynamics/mechanisms.json.</summary>
internal sealed class MechanismReferenceTests
{
    private const double Dt = 2e-3;

    // Below this the seven decimals of the file are seen, not the step.
    private const double Floor = 1e-6;

    // Largest error at half of Dt, m or rad; about twice what it is, so that a worse rule shows.
    [TestCase("heavy top", 1e-4)]
    [TestCase("moving pivot", 2.5e-6)]
    [TestCase("bead on hoop", 4e-5)]
    [TestCase("rott", 4.5e-4)]
    [TestCase("ladder", 3e-5)]
    [TestCase("gimbals", 1e-3)]
    [TestCase("furuta", 1.4e-4)]
    [TestCase("watt", 2.5e-4)]
    [TestCase("double fourbar", 2e-4)]
    [TestCase("bennett", 1e-5)]
    [TestCase("governor", 5e-5)]
    [TestCase("slider crank", 6e-5)]
    [TestCase("cardan", 1.5e-5)]
    [TestCase("planet gear", 2e-5)]
    [TestCase("screw", 1.4e-5)]
    [TestCase("hinge spring", 1.3e-5)]
    [TestCase("cart and pole", 1.2e-5)]
    [TestCase("elastic pendulum", 1e-5)]
    [TestCase("chain of ten", 1e-5)]
    public void Step_AtTwoSteps_NearsTheReferenceAtSecondOrder(string name, double tolerance)
    {
        JsonElement mechanism = Find(name);
        double[] coarse = Errors(mechanism, Dt);
        double[] fine = Errors(mechanism, Dt / 2);
        TestContext.Out.WriteLine($"{name}: {string.Join(" ", fine)}, ratio {string.Join(" ", Ratios(coarse, fine))}");
        for (int i = 0; i < fine.Length; i++)
        {
            Assert.That(fine[i], Is.LessThanOrEqualTo(tolerance));
            if (fine[i] > Floor)
            {
                Assert.That(coarse[i] / fine[i], Is.EqualTo(4).Within(0.6));
            }
        }
    }

    private static IEnumerable<string> Ratios(double[] coarse, double[] fine)
    {
        for (int i = 0; i < fine.Length; i++)
        {
            yield return (coarse[i] / fine[i]).ToString("0.00", System.Globalization.CultureInfo.InvariantCulture);
        }
    }

    // Largest error of any body at each time: way of its centre of mass in m, angle of its rotation in rad.
    private static double[] Errors(JsonElement mechanism, double dt)
    {
        byte[] text = Encoding.UTF8.GetBytes(mechanism.GetProperty("scene").GetRawText());
        SceneReading reading = SceneFile.Parse(text);
        Assert.That(reading.Document, Is.Not.Null, string.Join("; ", reading.Report.Diagnostics));
        SceneValidation validation = SceneValidator.Validate(reading.Document!);
        Assert.That(validation.Scene, Is.Not.Null, string.Join("; ", validation.Report.Diagnostics));
        World world = World.Create(validation.Scene!, SolverKind.Exact);
        JsonElement start = mechanism.GetProperty("start");
        for (int i = 0; i < world.Bodies.Count; i++)
        {
            world.Bodies[i].LinearVelocity = Vector(start[i], 0);
            world.Bodies[i].AngularVelocity = Vector(start[i], 3);
        }

        JsonElement times = mechanism.GetProperty("times");
        var errors = new double[times.GetArrayLength()];
        int done = 0;
        for (int t = 0; t < errors.Length; t++)
        {
            for (int target = (int)Math.Round(times[t].GetDouble() / dt); done < target;)
            {
                done++;
                Drive(world, mechanism, done * dt);
                world.Step(dt);
            }

            JsonElement states = mechanism.GetProperty("states")[t];
            for (int i = 0; i < world.Bodies.Count; i++)
            {
                Quaterniond q = world.Bodies[i].Pose.Rotation;
                var expected = new Quaterniond(states[i][3].GetDouble(), states[i][4].GetDouble(), states[i][5].GetDouble(), states[i][6].GetDouble());
                double way = (world.Bodies[i].CenterOfMass - Vector(states[i], 0)).Length;
                errors[t] = Math.Max(errors[t], Math.Max(way, 2 * (q.Conjugate() * expected).Vector.Length));
            }
        }

        Assert.That(world.Stops, Is.Zero);
        return errors;
    }

    // A kinematic body turns about the origin at a constant rate.
    private static void Drive(World world, JsonElement mechanism, double time)
    {
        if (mechanism.TryGetProperty("kinematic", out JsonElement k))
        {
            Quaterniond rotation = Quaterniond.AxisAngle(Vector(k.GetProperty("axis"), 0), k.GetProperty("rate").GetDouble() * time);
            world.Bodies[k.GetProperty("body").GetInt32()].KinematicTarget = new Pose(Vector3d.Zero, rotation);
        }
    }

    private static JsonElement Find(string name)
    {
        string path = Path.Combine(BenchmarkReferences.Root(), "tests", "reference", "dynamics", "mechanisms.json");
        using JsonDocument file = JsonDocument.Parse(File.ReadAllBytes(path));
        foreach (JsonElement mechanism in file.RootElement.EnumerateArray())
        {
            if (mechanism.GetProperty("name").GetString() == name)
            {
                return mechanism.Clone();
            }
        }

        throw new KeyNotFoundException(name);
    }

    private static Vector3d Vector(JsonElement numbers, int first) =>
        new(numbers[first].GetDouble(), numbers[first + 1].GetDouble(), numbers[first + 2].GetDouble());
}
