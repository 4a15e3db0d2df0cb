using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Globalization;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Bench;

/// <summary>Time of one warm drive call: the lever, ladders of parallelograms, chains. The best of several rounds.</summary>
internal static class DriveBench
{
    private const int Rounds = 7;

    /// <summary>Prints one line a mechanism and the growth of chains.</summary>
    internal static void Run()
    {
        Report("lever, 5 joints, 1 loop, 2 degrees a call", Lever(), 2, 2000);
        Report("100-bar ladder of parallelograms, 2 degrees", Ladder(50, 100), 2, 50);
        Report("closed loop of 100 bars, 2 degrees", Ring(100), 2, 30);
        double small = 0;
        double large = 0;
        foreach (int bars in new[] { 10, 100, 1000 })
        {
            double time = Report($"open chain of {bars} bars, 2 degrees", Chain(bars), 2, 20_000 / bars);
            small = bars == 10 ? time : small;
            large = time;
        }

        Console.WriteLine(string.Format(CultureInfo.InvariantCulture, "chain exponent 10 to 1000: {0:F2}", Math.Log(large / small) / Math.Log(100)));
    }

    private static double Report(string name, (SceneDocument Scene, int Body, int Component) mechanism, double step, int calls)
    {
        ValidScene scene = SceneValidator.Validate(mechanism.Scene).Scene ?? throw new InvalidOperationException("The benchmark's scene is not valid.");
        Mechanism made = Mechanism.Create(scene);
        int coordinate = made.FindCoordinate(mechanism.Body, mechanism.Component, Coordinate.Angle);
        var solver = new PositionSolver(made);
        MechanismState state = made.NewState();
        double best = double.PositiveInfinity;
        double iterations = 0;
        for (int round = 0; round < Rounds; round++)
        {
            iterations = 0;
            long start = Stopwatch.GetTimestamp();
            for (int i = 0; i < calls; i++)
            {
                // There and back over 40 degrees.
                double phase = i * step % 80;
                DriveResult result = solver.Drive(state, coordinate, phase < 40 ? phase : 80 - phase);
                if (!result.Converged)
                    throw new InvalidOperationException($"{name}: {result.Status}");
                iterations += result.Iterations;
            }

            best = Math.Min(best, Stopwatch.GetElapsedTime(start).TotalMicroseconds / calls);
        }

        Console.WriteLine(string.Format(CultureInfo.InvariantCulture, "{0,-46} {1,9:F1} us a call, {2:F1} iterations", name, best, iterations / calls));
        return best;
    }

    private static (SceneDocument Scene, int Body, int Component) Lever()
    {
        var builder = new PlanarScene();
        Vector3d pin = new(0.25 * Math.Cos(0.5), 0.25 * Math.Sin(0.5), 0);
        Vector3d end = new(pin.X + Math.Sqrt(0.81 - pin.Y * pin.Y), 0, 0);
        int shaft = builder.Body();
        builder.Hinge(shaft, null, Vector3d.Zero);
        int panel = builder.Body();
        builder.Add(panel, new FixedJoint { ConnectedBody = shaft });
        int bar = builder.Body();
        builder.Hinge(bar, panel, pin);
        int slider = builder.Body();
        builder.Add(slider, new ConfigurableJoint
        {
            Anchor = end,
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            AngularXMotion = ConfigurableJointMotion.Locked,
            AngularYMotion = ConfigurableJointMotion.Locked,
            AngularZMotion = ConfigurableJointMotion.Locked,
        });
        builder.Hinge(bar, slider, end, closure: true);
        return (builder.Document(), shaft, 1);
    }

    private static (SceneDocument Scene, int Body, int Component) Ladder(int uprights, int bars)
    {
        var builder = new PlanarScene();
        Vector3d up = new(Math.Cos(1.2), Math.Sin(1.2), 0);
        for (int i = 0; i < uprights; i++)
            builder.Hinge(builder.Body(), null, new Vector3d(i, 0, 0));
        for (int i = 0; uprights + i < bars && i + 1 < uprights; i++)
        {
            int over = builder.Body();
            builder.Hinge(over, i, new Vector3d(i, 0, 0) + up);
            builder.Hinge(over, i + 1, new Vector3d(i + 1, 0, 0) + up, closure: true);
        }

        return (builder.Document(), 0, 1);
    }

    private static (SceneDocument Scene, int Body, int Component) Ring(int bars)
    {
        var builder = new PlanarScene();
        int? previous = null;
        for (int i = 0; i < bars; i++)
        {
            int link = builder.Body();
            builder.Hinge(link, previous, Corner(i));
            previous = link;
        }

        builder.Hinge(previous!.Value, null, Corner(bars), closure: true);
        return (builder.Document(), 0, 1);

        Vector3d Corner(int i)
        {
            double angle = 2 * Math.PI * i / (bars + 1);
            return new Vector3d(Math.Cos(angle), Math.Sin(angle), 0) * (bars / 6.0);
        }
    }

    private static (SceneDocument Scene, int Body, int Component) Chain(int bars)
    {
        var builder = new PlanarScene();
        int? previous = null;
        for (int i = 0; i < bars; i++)
        {
            int link = builder.Body();
            builder.Hinge(link, previous, new Vector3d(i, i % 3 * 0.1, 0));
            previous = link;
        }

        return (builder.Document(), 0, 1);
    }

    /// <summary>Bodies at the origin, so that anchors are world points; hinges about z.</summary>
    private sealed class PlanarScene
    {
        private readonly List<List<Component>> bodies = [];

        internal int Body()
        {
            bodies.Add([new Rigidbody()]);
            return bodies.Count - 1;
        }

        internal void Hinge(int own, int? connected, Vector3d point, bool closure = false) =>
            Add(own, new HingeJoint { ConnectedBody = connected, Anchor = point, Axis = Vector3d.UnitZ, Closure = closure });

        internal void Add(int own, Component joint) => bodies[own].Add(joint);

        internal SceneDocument Document()
        {
            var objects = new List<GameObject>();
            for (int i = 0; i < bodies.Count; i++)
                objects.Add(new GameObject { Id = $"body{i}", Name = $"body{i}", Components = bodies[i] });
            return new SceneDocument { GameObjects = objects };
        }
    }
}
