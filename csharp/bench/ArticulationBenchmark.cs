using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Bench.Peers;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Articulations;
using Kinefab.Dynamics.Pgs;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Bench;

/// <summary>Articulations beside Rigidbodies with joints, here and in other engines: the same driven arms, a step of 1/60 s, by turns.</summary>
internal static class ArticulationBenchmark
{
    private const double Dt = 1.0 / 60;
    private const int Runs = 400;

    // Some engines' time grows with the cube of a chain's length.
    private const int MostLinksOfPeers = 32;
    private static readonly Vector3d Gravity = new(0, -9.81, 0);
    private static readonly int[] Sizes = { 7, 32, 125, 250, 500, 1000 };

    public static void Run()
    {
        Console.WriteLine("| arm | how | us/step | ns/link-step | median | bytes/step |");
        Console.WriteLine("|---|---|---|---|---|---|");
        double small = 0, large = 0;
        foreach (int links in Sizes)
        {
            ArticulationSolver free = Articulation(links, isDriven: false);
            ArticulationSolver driven = Articulation(links, isDriven: true);
            var joints = new PgsSolver(Jointed(links));
            var contenders = new List<Contender>
            {
                new("articulation, no rows", links, () => free.Step(Gravity, Dt, 6, 1)),
                new("articulation, driven", links, () => driven.Step(Gravity, Dt, 6, 1)),
                new("joints in unity, driven", links, () => joints.Step(Dt)),
            };
            List<IPeer> peers = new();
            foreach ((string name, Func<MultibodySystem, IPeer> make) in PeerList.All().Where(_ => links <= MostLinksOfPeers))
            {
                IPeer peer = make(Jointed(links));
                peers.Add(peer);
                contenders.Add(new Contender($"joints in {name}, held by motors", links, () => peer.Step(Dt)));
            }

            for (int run = 0; run < Runs; run++)
            {
                foreach (Contender contender in contenders)
                    contender.Time();
            }

            foreach (Contender contender in contenders)
                contender.Print(links);
            peers.ForEach(peer => peer.Dispose());
            small = links == 125 ? contenders[1].Least : small;
            large = links == 1000 ? contenders[1].Least : large;
        }

        Console.WriteLine(FormattableString.Invariant($"\nExponent from 125 to 1000 driven links: {Math.Log(large / small) / Math.Log(8):0.000}. Processor time of the thread, the least of {Runs} runs in which all took turns. {Machine.Description}."));
    }

    private sealed class Contender
    {
        private readonly string _name;
        private readonly Action _step;
        private readonly int _batch;
        private readonly long _bytes;
        private readonly List<double> _times = new();

        public Contender(string name, int links, Action step)
        {
            _name = name;
            _step = step;
            _batch = Math.Max(1, 700 / links);
            for (int i = 0; i < Math.Max(20, 20000 / links); i++)
                step();
            long before = GC.GetAllocatedBytesForCurrentThread();
            step();
            _bytes = GC.GetAllocatedBytesForCurrentThread() - before;
        }

        /// <summary>us a step.</summary>
        public double Least => _times.Min();

        public void Time()
        {
            double began = ThreadClock.Microseconds;
            for (int i = 0; i < _batch; i++)
                _step();
            _times.Add((ThreadClock.Microseconds - began) / _batch);
        }

        public void Print(int links)
        {
            double median = _times.Order().ElementAt(_times.Count / 2);
            Console.WriteLine(string.Create(CultureInfo.InvariantCulture, $"| {links} links | {_name} | {Least:F2} | {Least * 1000 / links:F0} | {median:F2} | {_bytes} |"));
        }
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
