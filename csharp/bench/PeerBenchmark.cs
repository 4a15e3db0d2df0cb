using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Globalization;
using System.Linq;
using Kinefab.Bench.Peers;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Pgs;
using Kinefab.Dynamics.Rattle;
using Kinefab.Tests.Dynamics.Rattle;

namespace Kinefab.Bench;

/// <summary>This library's solvers and other engines on the same scenes, by turns in one process: 10 s of motion at 1/60 s, one thread each.</summary>
internal static class PeerBenchmark
{
    private const double Dt = 1.0 / 60;
    private const int Steps = 600;
    private const int Runs = 7;

    // Small scenes are long over before the runtime has compiled them in full.
    private static readonly TimeSpan Enough = TimeSpan.FromSeconds(4);

    public static void Run()
    {
        var many = new List<(string, Func<MultibodySystem, IPeer>)> { Unity };
        foreach (int width in new[] { 1, 4, 8 })
            many.Add(($"Kinefab, exact, {width} lanes", scene => new KinefabPeer(new RattleSolver(scene, width))));
        many.AddRange(PeerList.All());
        Scene("fourbar100", () => SolverScenes.FourBars(100), many, [PeerList.Reference, PeerList.Box3D], 100 * 1.7 * 9.81);
        Scene("dpend1000", () => SolverScenes.DoublePendulums(1000), many, [PeerList.Reference, PeerList.Box3D], 1000 * 9.81 * 2);

        // Alone: no other island shares its lanes. A step of one is so short that the clock would count.
        (string, Func<MultibodySystem, IPeer>)[] alone = [Unity, ("Kinefab, exact", scene => new KinefabPeer(new RattleSolver(scene)))];
        Scene("slidercrank", SolverScenes.SliderCrank, [.. alone, .. PeerList.All().Where(p => p.Name == PeerList.Ode)], [PeerList.Ode], null, 20);
        Scene("chain64", () => SolverScenes.Chain(64), [.. alone, .. PeerList.All()], [PeerList.FineBepu], 64 * 9.81 * 6.4);
        Console.WriteLine($"Processor time of the thread, every step's least of {Runs} runs or more in which the engines took turns; spread: the slowest of the last {Runs} runs over the fastest. {Machine.Description}.");
    }

    private static (string Name, Func<MultibodySystem, IPeer> Make) Unity => ("Kinefab, unity", scene => new KinefabPeer(new PgsSolver(scene)));

    /// <param name="name">In the table.</param>
    /// <param name="make">The scene, anew for every run.</param>
    /// <param name="peers">Who runs it.</param>
    /// <param name="references">Those against which the others' times are divided.</param>
    /// <param name="energyScale">What 100 % of energy is, J; null where a motor does work and the energy says nothing.</param>
    /// <param name="stride">Steps that are timed as one.</param>
    private static void Scene(
        string name, Func<MultibodySystem> make, IEnumerable<(string Name, Func<MultibodySystem, IPeer> Make)> peers, string[] references, double? energyScale, int stride = 1)
    {
        List<Contender> contenders = peers.Select(peer => new Contender(peer.Name, peer.Make, stride)).ToList();
        foreach (Contender contender in contenders)
            contender.Judge(make(), energyScale);
        long began = Stopwatch.GetTimestamp();
        for (int run = 0; run < Runs || Stopwatch.GetElapsedTime(began) < Enough; run++)
        {
            foreach (Contender contender in contenders)
                contender.Time(make());
        }

        int joints = make().Joints.Length;
        Console.WriteLine($"| {name} | ns/joint-step | {string.Concat(references.Select(r => $"of {r} | "))}spread | drift m | energy after 10 s |");
        Console.WriteLine($"|---|---|{string.Concat(references.Select(_ => "---|"))}---|---|---|");
        foreach (Contender c in contenders)
        {
            string shares = string.Concat(references.Select(
                r => contenders.Find(other => other.Name == r) is { } of ? string.Create(CultureInfo.InvariantCulture, $"{c.Least / of.Least:F2} | ") : "not there | "));
            Console.WriteLine(string.Create(
                CultureInfo.InvariantCulture,
                $"| {c.Name} | {c.Least * 1000 / Steps / joints:F0} | {shares}{c.Spread * 100:F0} % | {c.Drift:E1} | {(energyScale is null ? "driven" : $"{c.Energy * 100:F2} %")} |"));
        }

        Console.WriteLine();
    }

    private sealed class Contender
    {
        private readonly Func<MultibodySystem, IPeer> _make;
        private readonly int _stride;
        private readonly double[] _best;
        private readonly List<double> _totals = new();

        public Contender(string name, Func<MultibodySystem, IPeer> make, int stride)
        {
            Name = name;
            _make = make;
            _stride = stride;
            _best = Enumerable.Repeat(double.PositiveInfinity, Steps / stride).ToArray();
        }

        public string Name { get; }

        /// <summary>us of all steps, each undisturbed.</summary>
        public double Least => _best.Sum();

        public double Spread => _totals.TakeLast(Runs).Max() / _totals.TakeLast(Runs).Min() - 1;

        /// <summary>Largest distance of two anchors, m.</summary>
        public double Drift { get; private set; }

        /// <summary>Change over the run, as a share of what 100 % is.</summary>
        public double Energy { get; private set; }

        public void Judge(MultibodySystem scene, double? energyScale)
        {
            double start = MechanismMeasures.Energy(scene);
            using IPeer peer = _make(scene);
            for (int i = 0; i < Steps; i++)
            {
                peer.Step(Dt);
                peer.Write(scene.Bodies);
                Drift = Math.Max(Drift, MechanismMeasures.Drift(scene));
            }

            Energy = (MechanismMeasures.Energy(scene) - start) / (energyScale ?? 1);
        }

        public void Time(MultibodySystem scene)
        {
            using IPeer peer = _make(scene);
            double total = 0;
            for (int i = 0; i < _best.Length; i++)
            {
                double before = ThreadClock.Microseconds;
                for (int step = 0; step < _stride; step++)
                    peer.Step(Dt);
                double time = ThreadClock.Microseconds - before;
                _best[i] = Math.Min(_best[i], time);
                total += time;
            }

            _totals.Add(total);
        }
    }
}
