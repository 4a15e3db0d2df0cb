using System;
using System.Diagnostics;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Runtime.CompilerServices;
using KinefabUnity;
using UnityEngine;

namespace Kinefab.Bench;

/// <summary>
/// A frame of the Unity package's KinefabMechanism on the stand-ins: Drive by a degree, which places every part. What Unity's own objects cost is not in it.
/// </summary>
internal static class PackageBenchmark
{
    // Short ones, of which some are not interrupted by other programs.
    private const int Runs = 1000;
    private const int Frames = 100;

    public static void Run()
    {
        Console.WriteLine("| mechanisms | moved by | us/frame | us/frame and mechanism | bytes/frame |");
        Console.WriteLine("|---|---|---|---|---|");
        foreach (int count in new[] { 1, 100 })
        {
            Row(count, KinefabPhysics.None, "KinefabMechanism alone");
            Row(count, KinefabPhysics.AsExported, "kinematic Rigidbodies");
        }
    }

    private static void Row(int count, KinefabPhysics physics, string how)
    {
        Player.Play(true);
        string lever = Path.Combine(Path.GetDirectoryName(ThisFile())!, "..", "examples", "LeverTests", "lever.kinefab");
        GameObject[] roots = Enumerable.Range(0, count).Select(_ => KinefabScene.Instantiate(lever, null, new KinefabSettings { physics = physics }, [])).ToArray();
        KinefabMechanism[] all = roots.Select(root => root.GetComponent<KinefabMechanism>()).ToArray();
        int shaft = all[0].Freedoms.ToList().FindIndex(freedom => freedom.Name == "Shaft");
        Action[] steps = physics == KinefabPhysics.None ? [] : all.Select(mechanism => (Action)Delegate.CreateDelegate(typeof(Action), mechanism, "FixedUpdate")).ToArray();
        double angle = 0;
        int frames = Frames / count;
        double best = double.PositiveInfinity;
        long bytes = 0;
        for (int run = 0; run < Runs; run++)
        {
            long allocated = GC.GetAllocatedBytesForCurrentThread();
            long began = Stopwatch.GetTimestamp();
            for (int frame = 0; frame < frames; frame++)
            {
                angle++;
                foreach (KinefabMechanism mechanism in all)
                    mechanism.Drive(shaft, angle);
                foreach (Action step in steps)
                    step();
            }

            best = Math.Min(best, Stopwatch.GetElapsedTime(began).TotalMicroseconds / frames);
            bytes = (GC.GetAllocatedBytesForCurrentThread() - allocated) / frames;
        }

        Console.WriteLine(string.Format(CultureInfo.InvariantCulture, "| {0} | {1} | {2:F1} | {3:F2} | {4} |", count == 1 ? "a lever" : $"{count} levers", how, best, best / count, bytes));
        foreach (GameObject root in roots)
            UnityEngine.Object.DestroyImmediate(root);
        Player.Play(false);
    }

    private static string ThisFile([CallerFilePath] string path = "") => path;
}
