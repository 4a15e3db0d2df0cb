using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Threading.Tasks;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Dynamics.Pgs;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>No scene, however unkind, makes a number that is none, or energy from nothing; one that cannot be followed says so.</summary>
internal sealed class RobustnessTests
{
    private const int Scenes = 10_000;
    private const int Steps = 2;
    private const int LongScenes = 150;
    private const int LongSteps = 200;

    // Shorter steps that decide whether a scene that stops has a motion.
    private const int Finer = 64;
    private const double MostOpen = 1e-8;

    // Above what is there at the start and what gravity adds.
    private const double MostGain = 0.005;

    [Test]
    public void Step_ExactInRandomScenes_FiniteClosedAndWithoutGain() => AssertTrue(0, Scenes, Steps);

    /// <summary>KINEFAB_RANDOM_SCENES sets how many are run, KINEFAB_FIRST_SCENE the first seed.</summary>
    [Test]
    public void Step_ExactInRandomScenes_GoesOnWhereAMotionExists() =>
        AssertTrue(LimitedSceneTests.Setting("KINEFAB_FIRST_SCENE", 0), LimitedSceneTests.Setting("KINEFAB_RANDOM_SCENES", LongScenes), LongSteps);

    private static void AssertTrue(int first, int count, int steps)
    {
        var faults = new ConcurrentDictionary<int, string>();
        var stopped = new ConcurrentQueue<int>();
        var moving = new ConcurrentQueue<int>();
        Parallel.For(first, first + count, seed =>
        {
            MultibodySystem m = Run(seed, steps, 1, fault => faults[seed] = $"seed {seed}: {fault}");
            if (m.Stops > 0)
            {
                stopped.Enqueue(seed);
                if (m.Unsolved.Count == 0)
                {
                    faults[seed] = $"seed {seed}: stopped without a reason";
                }
                else if (Run(seed, steps, Finer, _ => { }).Stops == 0)
                {
                    moving.Enqueue(seed);
                }
            }
        });
        TestContext.Progress.WriteLine($"{count} scenes: {stopped.Count} stop ({string.Join(' ', stopped)}), with a motion {string.Join(' ', moving)}");
        Assert.That(faults, Is.Empty);
        Assert.That(moving, Is.Empty);
    }

    // Until it stops.
    private static MultibodySystem Run(int seed, int steps, int finer, Action<string> tell)
    {
        var scene = new RandomScene(seed);
        MultibodySystem m = scene.System;
        double dt = StepOf(seed) / finer;
        bool isWhole = scene.IsWhole();
        double start = MechanismMeasures.Kinetic(m) + scene.Stored();
        double height = MechanismMeasures.Potential(m);

        // Looking for inconsistent loops takes most of a small scene's time.
        RattleSolver solver = seed % 10 == 0 ? new RattleSolver(m) : new RattleSolver(m, new List<InconsistentLoop>());
        for (int i = 1; i <= steps * finer && m.Stops == 0; i++)
        {
            solver.Step(dt);
            double gain = MechanismMeasures.Kinetic(m) + MechanismMeasures.Potential(m) - height - start;
            if (scene.IsPassive && isWhole && !(gain <= MostGain * (start + MechanismMeasures.FallEnergy(m, i * dt))))
            {
                tell($"{gain} J more than {start} J");
            }
        }

        double open = isWhole && m.Stops == 0 ? MechanismMeasures.Drift(m) : 0;
        if (!MechanismMeasures.IsFinite(m) || !(open <= MostOpen))
        {
            tell($"open by {open} m");
        }

        return m;
    }

    [Test]
    public void Step_UnityInRandomScenes_StayFinite()
    {
        var faults = new ConcurrentQueue<string>();
        Parallel.For(0, Scenes, seed =>
        {
            MultibodySystem m = new RandomScene(seed).System;
            var solver = new PgsSolver(m);
            for (int i = 0; i < Steps; i++)
            {
                solver.Step(StepOf(seed));
            }

            if (!MechanismMeasures.IsFinite(m))
            {
                faults.Enqueue($"seed {seed}");
            }
        });
        Assert.That(faults, Is.Empty);
    }

    [TestCase(1e-4)]
    [TestCase(0.1)]
    public void Step_MassesFromGramToTonne_StayFiniteAndClosed(double dt)
    {
        var b = new MechanismBuilder();
        int last = JointModel.World;
        double[] masses = { 1e-3, 1e3, 1, 1e-3, 1e3 };
        for (int i = 0; i < masses.Length; i++)
        {
            int bar = b.Bar(new Vector3d(0.5 * i, 0, 0), new Vector3d(0.5 * (i + 1), 0, 0), masses[i]);
            b.Hinge(last, bar, new Vector3d(0.5 * i, 0, 0), Vector3d.UnitZ);
            last = bar;
        }

        MultibodySystem m = b.Build();
        var solver = new RattleSolver(m);
        for (int i = 0; i < 200; i++)
        {
            solver.Step(dt);
        }

        Assert.That(MechanismMeasures.IsFinite(m), Is.True);
        Assert.That(MechanismMeasures.Drift(m), Is.LessThanOrEqualTo(1e-8));
        if (dt < 0.01)
        {
            Assert.That(m.Stops, Is.Zero);
        }
    }

    // 0.1 ms to 0.1 s.
    private static double StepOf(int seed) => Math.Pow(10, -4 + 3 * new Random(seed).NextDouble());
}
