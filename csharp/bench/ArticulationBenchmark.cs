using System;
using System.Diagnostics;
using System.Globalization;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Articulations;
using Kinefab.Dynamics.Pgs;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Bench;

/// <summary>Articulations beside Rigidbodies with joints: the same driven arms, a step of 1/60 s.</summary>
internal static class ArticulationBenchmark
{
    private const double Dt = 1.0 / 60;
    private const int Runs = 400;
    private static readonly Vector3d Gravity = new(0, -9.81, 0);
    private static readonly int[] Sizes = { 7, 32, 125, 250, 500, 1000 };

    public static void Run()
    {
        Console.WriteLine("| scene | how | us/step | ns/link-step | bytes/step |");
        Console.WriteLine("|---|---|---|---|---|");
        double small = 0, large = 0;
        foreach (int links in Sizes)
        {
            ArticulationSolver free = Articulation(links, isDriven: false);
            Row($"chain{links}", "articulation, no rows", links, () => free.Step(Gravity, Dt, 6, 1));
            ArticulationSolver driven = Articulation(links, isDriven: true);
            double time = Row($"chain{links}", "articulation, driven", links, () => driven.Step(Gravity, Dt, 6, 1));
            small = links == 125 ? time : small;
            large = links == 1000 ? time : large;
            var joints = new PgsSolver(Jointed(links));
            Row($"chain{links}", "unity, driven", links, () => joints.Step(Dt));
        }

        Console.WriteLine(FormattableString.Invariant($"\nexponent from 125 to 1000 driven links: {Math.Log(large / small) / Math.Log(8):0.000}"));
    }

    private static double Row(string scene, string name, int links, Action step)
    {
        int steps = Math.Max(20, 20000 / links);
        for (int i = 0; i < steps; i++)
            step();
        long before = GC.GetAllocatedBytesForCurrentThread();
        step();
        long bytes = GC.GetAllocatedBytesForCurrentThread() - before;
        int batch = Math.Max(1, 700 / links);
        double best = double.PositiveInfinity;
        for (int run = 0; run < Runs; run++)
        {
            long began = Stopwatch.GetTimestamp();
            for (int i = 0; i < batch; i++)
                step();
            best = Math.Min(best, Stopwatch.GetElapsedTime(began).TotalMicroseconds / batch);
        }

        Console.WriteLine(string.Format(CultureInfo.InvariantCulture, "| {0} | {1} | {2:F2} | {3:F0} | {4} |", scene, name, best, best * 1000 / links, bytes));
        return best;
    }

    // Links of 0.2 m in a row along X, axes about Z and Y by turns, held straight by drives.
    private static ArticulationSolver Articulation(int links, bool isDriven)
    {
        LinkDefinition[] definitions = Enumerable.Range(0, links + 1).Select(i =>
        {
            Pose frame = new(Vector3d.Zero, AxisX(i));
            var link = new LinkDefinition
            {
                Parent = i - 1,
                Mass = 1,
                Inertia = new Vector3d(0.002, 0.004, 0.004),
                Joint = LinkJointKind.Revolute,
                ParentAnchor = new Pose(new Vector3d(i == 1 ? 0 : 0.1, 0, 0), frame.Rotation),
                Anchor = new Pose(new Vector3d(-0.1, 0, 0), frame.Rotation),
                MaxJointSpeed = 100,
            };
            link.Axes[0] = new LinkAxis { Motion = LinkMotion.Free, Stiffness = isDriven ? 500 : 0, Damping = isDriven ? 50 : 0, ForceLimit = double.PositiveInfinity };
            return link;
        }).ToArray();
        var tree = new ArticulationTree(definitions, Pose.Identity, isFixed: true);
        TreeKinematics.Place(tree);
        return new ArticulationSolver(tree, ArticulationRules.PhysX4);
    }

    private static MultibodySystem Jointed(int links)
    {
        BodyDefinition[] bodies = Enumerable.Range(0, links).Select(i => BodyDefinition.Default with
        {
            Pose = new Pose(new Vector3d(0.1 + 0.2 * i, 0, 0), Quaterniond.Identity),
            Mass = 1,
            Inertia = new Vector3d(0.002, 0.004, 0.004),
        }).ToArray();
        JointModel[] joints = Enumerable.Range(0, links).Select(i => (JointModel)new D6Joint
        {
            Body0 = i - 1,
            Body1 = i,
            Frame0 = new Pose(new Vector3d(i == 0 ? 0 : 0.1, 0, 0), AxisX(i + 1)),
            Frame1 = new Pose(new Vector3d(-0.1, 0, 0), AxisX(i + 1)),
            Twist = AxisMotion.Free,
            DriveTwist = new DriveModel { Stiffness = 500, Damping = 50, ForceLimit = double.PositiveInfinity },
        }).ToArray();
        return new MultibodySystem(new Bodies(bodies), joints, Array.Empty<CoordinateCoupling>()) { Gravity = Gravity };
    }

    private static Quaterniond AxisX(int i) => (i % 2 == 1 ? new Quaterniond(0, -1, 0, 1) : new Quaterniond(0, 0, 1, 1)).Normalized();
}
