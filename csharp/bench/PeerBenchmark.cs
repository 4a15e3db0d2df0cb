using System;
using System.Collections.Generic;
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

    public static void Run()
    {
        Scene("fourbar100", () => SolverScenes.FourBars(100), 100 * 1.7 * 9.81);
        Console.WriteLine();
        Scene("dpend1000", () => SolverScenes.DoublePendulums(1000), 1000 * 9.81 * 2);
        Console.WriteLine($"\nProcessor time of the thread, every step's least of {Runs} runs in which the engines took turns; spread: the slowest run over the fastest. {Machine.Description}.");
    }

    /// <param name="name">In the table.</param>
    /// <param name="make">The scene, anew for every run.</param>
    /// <param name="energyScale">What 100 % of energy is, J.</param>
    private static void Scene(string name, Func<MultibodySystem> make, double energyScale)
    {
        var contenders = new List<Contender> { new("Kinefab, unity", scene => new KinefabPeer(new PgsSolver(scene))) };
        foreach (int width in new[] { 1, 4, 8 })
            contenders.Add(new Contender($"Kinefab, exact, {width} lanes", scene => new KinefabPeer(new RattleSolver(scene, width))));
        contenders.AddRange(PeerList.All().Select(peer => new Contender(peer.Name, peer.Make)));
        foreach (Contender contender in contenders)
            contender.Judge(make(), energyScale);
        for (int run = 0; run < Runs; run++)
        {
            foreach (Contender contender in contenders)
                contender.Time(make());
        }

        int joints = make().Joints.Length;
        double? reference = contenders.Find(c => c.Name == PeerList.Reference)?.Least;
        Console.WriteLine($"| {name} | ns/joint-step | of {PeerList.Reference} | spread | drift m | energy after 10 s |");
        Console.WriteLine("|---|---|---|---|---|---|");
        foreach (Contender c in contenders)
        {
            string share = reference is { } least ? (c.Least / least).ToString("F2", CultureInfo.InvariantCulture) : "not there";
            Console.WriteLine(string.Create(
                CultureInfo.InvariantCulture,
                $"| {c.Name} | {c.Least * 1000 / Steps / joints:F0} | {share} | {c.Spread * 100:F0} % | {c.Drift:E1} | {c.Energy * 100:F2} % |"));
        }
    }

    private sealed class Contender
    {
        private readonly Func<MultibodySystem, IPeer> _make;
        private readonly double[] _best = Enumerable.Repeat(double.PositiveInfinity, Steps).ToArray();
        private readonly List<double> _totals = new();

        public Contender(string name, Func<MultibodySystem, IPeer> make)
        {
            Name = name;
            _make = make;
        }

        public string Name { get; }

        /// <summary>us of all steps, each undisturbed.</summary>
        public double Least => _best.Sum();

        public double Spread => _totals.Max() / _totals.Min() - 1;

        /// <summary>Largest distance of two anchors, m.</summary>
        public double Drift { get; private set; }

        /// <summary>Change over the run, as a share of what 100 % is.</summary>
        public double Energy { get; private set; }

        public void Judge(MultibodySystem scene, double energyScale)
        {
            double start = MechanismMeasures.Energy(scene);
            using IPeer peer = _make(scene);
            for (int i = 0; i < Steps; i++)
            {
                peer.Step(Dt);
                peer.Write(scene.Bodies);
                Drift = Math.Max(Drift, MechanismMeasures.Drift(scene));
            }

            Energy = (MechanismMeasures.Energy(scene) - start) / energyScale;
        }

        public void Time(MultibodySystem scene)
        {
            using IPeer peer = _make(scene);
            double total = 0;
            for (int i = 0; i < Steps; i++)
            {
                double before = ThreadClock.Microseconds;
                peer.Step(Dt);
                double time = ThreadClock.Microseconds - before;
                _best[i] = Math.Min(_best[i], time);
                total += time;
            }

            _totals.Add(total);
        }
    }
}
