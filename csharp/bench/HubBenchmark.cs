using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Bench.Peers;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Tests.Dynamics.Rattle;
using Kinefab.Validation;

namespace Kinefab.Bench;

/// <summary>What many joints on one body, between one pair, on a comb and in a grid of closed cells cost, and how that grows.</summary>
internal static class HubBenchmark
{
    private const double Dt = 1.0 / 50;
    private const int Runs = 3;

    // After a call of as many ms no larger scene is tried.
    private const double TooLong = 1500;
    private static readonly int[] Sizes = { 512, 1024, 4096, 16384 };

    private static readonly (string Name, Func<SceneDocument, ValidScene, Action> Make)[] Calls =
    {
        ("validate", (document, _) => () => SceneValidator.Validate(document)),
        ("mobility", (_, scene) => () => MobilityAnalysis.Of(Mechanism.Create(scene))),
        ("unity: create + step", (_, scene) => () => World.Create(scene, SolverKind.Unity).Step(Dt)),
        ("exact: create + step", (_, scene) => () => World.Create(scene, SolverKind.Exact).Step(Dt)),
    };

    public static void Run()
    {
        Console.WriteLine($"Processor time of the thread, the least of {Runs}; a hyphen: the next smaller one took more than {TooLong / 1000} s.\n");
        Console.WriteLine($"| scene | call | {string.Join(" | ", Sizes.Select(size => $"{size} joints, ms"))} | exponent |");
        Console.WriteLine($"|---|---|{string.Concat(Sizes.Select(_ => "---|"))}---|");
        foreach ((string kind, Func<int, SceneDocument> make) in HubScenes.Kinds)
        {
            (SceneDocument Document, ValidScene Scene)[] scenes = Sizes.Select(make).Select(document => (document, SceneValidator.Validate(document).Scene!)).ToArray();
            foreach ((string name, Func<SceneDocument, ValidScene, Action> call) in Calls)
            {
                Time(call(scenes[0].Document, scenes[0].Scene));
                var times = new List<double>();
                foreach ((SceneDocument document, ValidScene scene) in scenes)
                {
                    if (times.Count == 0 || times[^1] < TooLong)
                        times.Add(Time(call(document, scene)));
                }

                double exponent = Math.Log(times[^1] / times[0]) / Math.Log((double)Sizes[times.Count - 1] / Sizes[0]);
                string cells = string.Join(" | ", Sizes.Select((_, i) => i < times.Count ? times[i].ToString("F1", CultureInfo.InvariantCulture) : "-"));
                Console.WriteLine(string.Create(CultureInfo.InvariantCulture, $"| {kind} | {name} | {cells} | {exponent:F2} |"));
            }
        }
    }

    // Processor time, the least of a few: the rest is the compiler's.
    private static double Time(Action call)
    {
        double best = double.PositiveInfinity;
        for (int run = 0; run < Runs; run++)
        {
            double before = ThreadClock.Microseconds;
            call();
            best = Math.Min(best, (ThreadClock.Microseconds - before) * 1e-3);
        }

        return best;
    }
}
