using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Dynamics.Pgs;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics;
using Kinefab.Tests.Dynamics.Rattle;
using Kinefab.Validation;

namespace Kinefab.Tests.Portability;

/// <summary>
/// One calculation that every runtime must answer alike: poses over a run (metres, unit quaternions) and a state's hash. Covers each PhysX
/// scenario, the benchmarks and loops of the exact solver, exported scenes read from their files, and position kinematics.
/// </summary>
internal sealed class PortableRun
{
    // Poses are noted this many times a run.
    private const int Samples = 10;

    private PortableRun(string name, Func<IEnumerable<double>> numbers)
    {
        Name = name;
        Numbers = numbers;
    }

    public string Name { get; }

    public Func<IEnumerable<double>> Numbers { get; }

    public static IReadOnlyList<PortableRun> All { get; } =
    [
        .. Scenario.All.Select(s => new PortableRun($"unity {s.Name}", () => Run(s))),
        Exact("B1", BenchmarkMechanisms.Pendulum, 4e-4, 2),
        Exact("B2", () => BenchmarkMechanisms.Windows(2), 1e-3, 2),
        Exact("B3", BenchmarkMechanisms.Squeezer, 5e-6, 0.01),
        Exact("B4", BenchmarkMechanisms.Bricard, 2e-3, 2),
        Exact("B5", BenchmarkMechanisms.Governor, 1.6e-4, 0.5),
        Exact("B7", BenchmarkMechanisms.DoublePendulum, 4e-4, 2),
        Exact("B9", BenchmarkMechanisms.Flip, 2e-3, 2),
        Exact("B10", BenchmarkMechanisms.FourBar, 8e-4, 2),
        Exact("B11", BenchmarkMechanisms.Lever, 8e-4, 0.5),
        Exact("fourbars", () => SolverScenes.FourBars(4)),
        Exact("chain64", () => SolverScenes.Chain(64)),
        Exact("slidercrank", SolverScenes.SliderCrank),
        Exact("heavy8", SolverScenes.Heavy8),
        Exact("parallelogram", SolverScenes.Parallelogram),
        .. from file in new[] { "hinge_slider_zup/hinge_slider", "hinge_slider_yup/hinge_slider", "lever/lever" }
           from solver in new[] { SolverKind.Unity, SolverKind.Exact }
           select new PortableRun($"scene {file} {solver}", () => Run(file, solver)),
        new PortableRun("kinematics lever", SweepLever),
    ];

    private static PortableRun Exact(string name, Func<BenchmarkMechanism> make, double dt, double end) => new($"exact {name}", () =>
    {
        BenchmarkMechanism benchmark = make();
        MultibodySystem system = benchmark.MultibodySystem;
        return Run(system, new RattleSolver(system), dt, (int)Math.Round(end / dt), _ => benchmark.Drive(system));
    });

    private static PortableRun Exact(string name, Func<MultibodySystem> make) => new($"exact {name}", () =>
    {
        MultibodySystem system = make();
        return Run(system, new RattleSolver(system), 1.0 / 60, 120, _ => { });
    });

    private static IEnumerable<double> Run(Scenario scenario)
    {
        MultibodySystem system = scenario.Build();
        return Run(system, new PgsSolver(system), scenario.Dt, scenario.Steps, t => scenario.Drive(system, t));
    }

    private static IEnumerable<double> Run(MultibodySystem system, ISolver solver, double dt, int steps, Action<double> beforeStep)
    {
        for (int step = 1; step <= steps; step++)
        {
            beforeStep(step * dt);
            solver.Step(dt);
            if (step % Math.Max(1, steps / Samples) == 0)
            {
                foreach (double number in system.Bodies.Poses.SelectMany(Numbers7))
                    yield return number;
            }
        }
    }

    private static IEnumerable<double> Run(string file, SolverKind solver)
    {
        const int steps = 100;
        World world = World.Create(Load(file), solver);
        for (int step = 1; step <= steps; step++)
        {
            world.Step(0.02);
            if (step % (steps / Samples) == 0)
            {
                foreach (double number in world.Bodies.SelectMany(b => Numbers7(b.Pose)))
                    yield return number;
            }
        }

        yield return BitConverter.Int64BitsToDouble((long)world.StateHash());
    }

    // The crank once round, as the hand lever turns it.
    private static IEnumerable<double> SweepLever()
    {
        ValidScene scene = Load("lever/lever");
        Mechanism mechanism = Mechanism.Create(scene);
        SweepResult sweep = new Sweep(new PositionSolver(mechanism)).Run(mechanism.NewState(), 0, 0, 360, 36);
        return from state in sweep.States
               from gameObject in Enumerable.Range(0, scene.Document.GameObjects.Count)
               from number in Numbers7(state.Pose(gameObject))
               select number;
    }

    private static ValidScene Load(string file) => ValidScene.Load(Path.Combine(Scenario.Folder, "..", "..", "fixtures", file + ".kinefab"));

    private static IEnumerable<double> Numbers7(Pose pose)
    {
        Vector3d p = pose.Position;
        Quaterniond q = pose.Rotation;
        return [p.X, p.Y, p.Z, q.X, q.Y, q.Z, q.W];
    }
}
