using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Pgs;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>Random scenarios, every step taken anew from PhysX's own state (tests/reference, npm run fuzz).</summary>
public sealed class PhysXFuzzTests
{
    // Position and rotation, linear and angular velocity.
    private const int Numbers = 13;

    // Of the largest speed, m/s and rad/s. PhysX's floats, divided by a step, reach a tenth of it.
    private const double Tolerance = 1e-4;

    // Radians: PhysX takes the twist angle by acos of a float, which is that coarse near 0.
    private const double TwistRounding = 5e-4;

    // A mechanism this fast has exploded.
    private const double TooFast = 300;
    private const int Shakes = 40;

    [Test]
    public void Step_FromPhysXsState_AgreesWithPhysX()
    {
        string path = Path.Combine(Scenario.Folder, "out", "fuzz.json");
        if (!File.Exists(path))
            Assert.Ignore("npm run fuzz, in tests/reference, writes " + path);

        using FileStream file = File.OpenRead(path);
        using JsonDocument document = JsonDocument.Parse(file);
        string[] faults = document.RootElement.EnumerateArray().Select(s => Fault(Scenario.Of(s), States(s))).OfType<string>().ToArray();

        Assert.That(faults, Is.Empty);
    }

    private static double[] States(JsonElement spec) => spec.GetProperty("states").EnumerateArray().Select(v => v.GetDouble()).ToArray();

    /// <summary>The first step whose difference no rounding explains; null when there is none.</summary>
    private static string? Fault(Scenario scenario, double[] states)
    {
        MultibodySystem start = scenario.Build();
        int stride = start.Bodies.Count * Numbers;
        var broken = new bool[start.Joints.Length];
        double[] before = Pack(start.Bodies);
        for (int step = 1; step <= scenario.Steps; step++)
        {
            double[] after = states[((step - 1) * stride)..(step * stride)];
            double scale = Scale(before, after, scenario.Dt);
            if (!(scale < TooFast))
                return null;

            int breaks = scenario.Broken.Count(s => s <= step);
            double limit = Tolerance * scale + TwistRounding / scenario.Dt;
            MultibodySystem ours = Step(scenario, step, before, broken, null);
            double difference = Difference(ours.Bodies, Pack(ours.Bodies), after, scenario.Dt);
            bool sameBreaks = ours.Joints.Count(j => j.IsBroken) == breaks;
            if (!sameBreaks || !(difference <= limit))
            {
                return Explains(scenario, step, before, broken, ours, sameBreaks ? difference : 0, breaks)
                    ? null
                    : $"{scenario.Name} step {step}: {difference:g3} of {scale:g3}";
            }

            broken = ours.Joints.Select(j => j.IsBroken).ToArray();
            before = after;
        }

        return null;
    }

    // Shaken as rounding shakes it, the step reaches about as far as PhysX went, or breaks as many joints.
    private static bool Explains(Scenario scenario, int step, double[] before, bool[] broken, MultibodySystem ours, double difference, int breaks)
    {
        var random = new Random(1);
        double[] result = Pack(ours.Bodies);
        return Enumerable.Range(0, Shakes).Select(_ => Step(scenario, step, before, broken, random)).Any(shaken =>
            difference > 0
                ? Difference(ours.Bodies, Pack(shaken.Bodies), result, scenario.Dt) > 0.4 * difference
                : shaken.Joints.Count(j => j.IsBroken) == breaks);
    }

    private static MultibodySystem Step(Scenario scenario, int step, double[] before, bool[] broken, Random? shake)
    {
        MultibodySystem system = scenario.Build();
        for (int i = 0; i < broken.Length; i++)
            system.Joints[i].IsBroken = broken[i];
        double[] state = before.Select(v => Shaken(v, shake)).ToArray();
        for (int i = 0; i < system.Bodies.Count; i++)
            Unpack(state, i, system.Bodies);
        scenario.Drive(system, step * scenario.Dt);
        new PgsSolver(system).Step(scenario.Dt);
        return system;
    }

    private static double Shaken(double value, Random? shake) =>
        shake == null ? value : value + (shake.NextDouble() * 2 - 1) * 1.5e-7 * Math.Max(0.3, Math.Abs(value));

    private static double[] Pack(Bodies bodies) => Enumerable.Range(0, bodies.Count).SelectMany(i =>
    {
        Vector3d p = bodies.Poses[i].Position, v = bodies.LinearVelocities[i], w = bodies.AngularVelocities[i];
        Quaterniond q = bodies.Poses[i].Rotation;
        return new[] { p.X, p.Y, p.Z, q.X, q.Y, q.Z, q.W, v.X, v.Y, v.Z, w.X, w.Y, w.Z };
    }).ToArray();

    private static void Unpack(double[] state, int body, Bodies bodies)
    {
        bodies.Poses[body] = PoseOf(state, body);
        bodies.LinearVelocities[body] = Vector(state, body * Numbers + 7);
        bodies.AngularVelocities[body] = Vector(state, body * Numbers + 10);
    }

    private static Pose PoseOf(double[] state, int body)
    {
        int i = body * Numbers;
        return new Pose(Vector(state, i), new Quaterniond(state[i + 3], state[i + 4], state[i + 5], state[i + 6]).Normalized());
    }

    private static Vector3d Vector(double[] state, int i) => new(state[i], state[i + 1], state[i + 2]);

    private static double Scale(double[] before, double[] after, double dt)
    {
        double scale = 1;
        for (int body = 0; body < after.Length / Numbers; body++)
        {
            int i = body * Numbers;
            double linear = Math.Max(Vector(before, i + 7).Length, Vector(after, i + 7).Length);
            double angular = Math.Max(Vector(before, i + 10).Length, Vector(after, i + 10).Length);
            double way = Way(PoseOf(before, body), PoseOf(after, body), dt);
            scale = Math.Max(scale, Math.Max(way, Math.Max(linear, angular)));
        }

        return scale;
    }

    // Largest difference of two states as speeds; a kinematic body's velocity means nothing.
    private static double Difference(Bodies bodies, double[] a, double[] b, double dt)
    {
        double difference = 0;
        for (int body = 0; body < bodies.Count; body++)
        {
            if (bodies.IsKinematic[body])
                continue;

            int v = body * Numbers + 7;
            double velocities = Math.Max((Vector(a, v) - Vector(b, v)).Length, (Vector(a, v + 3) - Vector(b, v + 3)).Length);
            double most = Math.Max(velocities, Way(PoseOf(a, body), PoseOf(b, body), dt));
            difference = most <= difference ? difference : most;
        }

        return difference;
    }

    private static double Way(Pose a, Pose b, double dt) =>
        Math.Max((b.Position - a.Position).Length, 2 * (a.Rotation.Conjugate() * b.Rotation).Vector.Length) / dt;
}
