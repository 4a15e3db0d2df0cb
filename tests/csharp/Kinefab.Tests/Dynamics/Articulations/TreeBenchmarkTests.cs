using System;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Articulations;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics.Rattle;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>
/// Those of the published benchmarks that are trees, as articulations: PhysX's step is of first order, in position and in energy. The others close
/// loops, which an articulation has joints for. (Exact: BenchmarkTests.)
/// </summary>
public sealed class TreeBenchmarkTests
{
    private static readonly object[] Benchmarks =
    [
        new object[] { "B1", (Func<BenchmarkMechanism>)BenchmarkMechanisms.Pendulum, 2e-4, 4 },
        new object[] { "B7", (Func<BenchmarkMechanism>)BenchmarkMechanisms.DoublePendulum, 1e-4, 1 },
        new object[] { "B9", (Func<BenchmarkMechanism>)BenchmarkMechanisms.Flip, 5e-4, 4 },
    ];

    [TestCaseSource(nameof(Benchmarks))]
    public void Step_HalfTheStep_HalfTheError(string id, object make, double dt, double end)
    {
        double[] errors = [Error(dt), Error(dt / 2), Error(dt / 4)];
        TestContext.Out.WriteLine($"{id}: {string.Join(" ", errors.Select(e => e.ToString("0.0e+00")))}");
        Assert.That(errors[0] / errors[1], Is.EqualTo(2).Within(0.2), id);
        Assert.That(errors[1] / errors[2], Is.EqualTo(2).Within(0.2), id);

        double Error(double step)
        {
            BenchmarkMechanism benchmark = ((Func<BenchmarkMechanism>)make)();
            return BenchmarkReferences.Deviation(benchmark, new TreeSolver(benchmark.MultibodySystem), step, end);
        }
    }

    [TestCaseSource(nameof(Benchmarks))]
    public void Step_HalfTheStep_HalfTheErrorOfTheEnergy(string id, object make, double dt, double end)
    {
        double coarse = Error(dt), fine = Error(dt / 2);
        Assert.That(coarse / fine, Is.EqualTo(2).Within(0.2), $"{id}: {coarse} {fine} J");

        double Error(double step)
        {
            MultibodySystem system = ((Func<BenchmarkMechanism>)make)().MultibodySystem;
            var solver = new TreeSolver(system);
            double start = MechanismMeasures.Energy(system);
            for (int i = 0; i < (int)Math.Round(end / step); i++)
                solver.Step(step);
            return Math.Abs(MechanismMeasures.Energy(system) - start);
        }
    }

    /// <summary>A system of hinges without loops as one articulation, which the world holds where one of its hinges does.</summary>
    private sealed class TreeSolver : ISolver
    {
        private readonly MultibodySystem _system;
        private readonly ArticulationSolver _solver;
        private readonly int _before;

        public TreeSolver(MultibodySystem system)
        {
            _system = system;
            bool isFixed = system.Joints.Length > 0;
            _before = isFixed ? 1 : 0;
            LinkDefinition[] links = [.. Enumerable.Range(0, system.Bodies.Count).Select(Link)];
            ArticulationTree tree = new(isFixed ? [new LinkDefinition(), .. links] : links, isFixed ? Pose.Identity : system.Bodies.Poses[0], isFixed);
            for (int i = 0; i < system.Bodies.Count; i++)
            {
                tree.Poses[i + _before] = system.Bodies.Poses[i];
                tree.Motions[i + _before] = new Twist(system.Bodies.AngularVelocities[i], system.Bodies.LinearVelocities[i]);
            }

            TreeKinematics.Read(tree);
            _solver = new ArticulationSolver(tree, ArticulationRules.PhysX4);
        }

        public void Step(double dt)
        {
            _solver.Step(_system.Gravity, dt, 6, 1);
            for (int i = 0; i < _system.Bodies.Count; i++)
            {
                _system.Bodies.Poses[i] = _solver.Tree.Poses[i + _before];
                _system.Bodies.LinearVelocities[i] = _solver.Tree.Motions[i + _before].Linear;
                _system.Bodies.AngularVelocities[i] = _solver.Tree.Motions[i + _before].Angular;
            }
        }

        public void Exchange(StateTape tape)
        {
        }

        private LinkDefinition Link(int body)
        {
            Vector3d inverse = _system.Bodies.InverseInertias[body];
            var link = new LinkDefinition { Mass = 1 / _system.Bodies.InverseMasses[body], Inertia = new Vector3d(1 / inverse.X, 1 / inverse.Y, 1 / inverse.Z) };
            if (_system.Joints.FirstOrDefault(j => j.Body1 == body) is not RevoluteJoint hinge)
                return link;
            link.Parent = hinge.Body0 + 1;
            link.Joint = LinkJointKind.Revolute;
            link.ParentAnchor = hinge.Frame0;
            link.Anchor = hinge.Frame1;
            link.Axes[0].Motion = LinkMotion.Free;
            return link;
        }
    }
}
