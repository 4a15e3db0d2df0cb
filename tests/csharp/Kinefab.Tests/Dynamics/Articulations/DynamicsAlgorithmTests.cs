using System;
using System.Linq;
using Kinefab.Dynamics.Articulations;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Articulations;

public sealed class DynamicsAlgorithmTests
{
    private static readonly Vector3d Gravity = new(0.3, -9.81, 0.2);

    [Test]
    public void ForwardAndInverse_OnRandomTrees_Agree()
    {
        double worst = 0;
        int freedoms = 0;
        for (int seed = 0; seed < 1000; seed++)
        {
            ArticulationTree tree = RandomTree.Make(seed);
            var random = new Random(seed);
            double[] forces = Enumerable.Range(0, tree.Freedoms).Select(_ => RandomTree.Between(random, -5, 5)).ToArray();
            var forward = new ForwardDynamics(tree);
            forward.Update();
            forward.FindInertias();
            forward.Accelerate(NetWrenches(tree), forces);
            var inverse = new InverseDynamics(tree);
            double[] back = new double[tree.Freedoms];
            inverse.Forces(forward.Accelerations[0], forward.JointAccelerations, Gravity, back);
            double scale = 1 + forward.JointAccelerations.Select(Math.Abs).Append(0).Max() + forces.Select(Math.Abs).Append(0).Max();
            for (int f = 0; f < forces.Length; f++)
                worst = Math.Max(worst, Math.Abs(forces[f] - back[f]) / scale);
            if (!tree.IsFixed)
                worst = Math.Max(worst, Math.Max(inverse.RootWrench.Force.Length, inverse.RootWrench.Torque.Length) / scale);
            freedoms += tree.Freedoms;
        }

        Assert.That(freedoms, Is.GreaterThan(5000));
        Assert.That(worst, Is.LessThan(1e-12));
        TestContext.Out.WriteLine($"worst of 1000: {worst:0.0e+00}");
    }

    [Test]
    public void Speeds_OfRandomTrees_AreTheDerivativeOfPositions()
    {
        // One revolute and prismatic chain: a spherical joint's speeds are no derivatives of its positions.
        for (int seed = 0; seed < 200; seed++)
        {
            ArticulationTree tree = RandomTree.Make(seed);
            for (int i = 1; i < tree.Count; i++)
            {
                if (tree.Links[i].Joint == LinkJointKind.Spherical)
                    tree.Speeds.AsSpan(tree.FirstFreedom[i], tree.FirstFreedom[i + 1] - tree.FirstFreedom[i]).Clear();
            }

            TreeKinematics.Move(tree);
            Twist[] motions = tree.Motions.ToArray();
            const double h = 1e-6;
            Pose root = tree.Poses[0];
            Vector3d[] before = At(tree, root, motions[0], -h);
            Vector3d[] after = At(tree, root, motions[0], h);
            for (int i = 0; i < tree.Count; i++)
                Assert.That(((after[i] - before[i]) * (0.5 / h) - motions[i].Linear).Length, Is.LessThan(1e-6 * (1 + motions[i].Linear.Length)), $"seed {seed}, link {i}");
        }
    }

    [Test]
    public void Response_OfAnInertia_IsItsInverse()
    {
        var random = new Random(7);
        for (int i = 0; i < 100; i++)
        {
            SpatialMatrix inertia = SpatialMatrix.Inertia(RandomTree.Between(random, 0.1, 5), new Vector3d(0.2, 0.3, 0.4), TreeKinematics.Turn(RandomTree.Vector(random, 2))).From(RandomTree.Vector(random, 1));
            inertia.AddFrom(SpatialMatrix.Inertia(1, new Vector3d(0.1, 0.1, 0.1), Quaterniond.Identity), RandomTree.Vector(random, 1));
            var motion = new Twist(RandomTree.Vector(random, 1), RandomTree.Vector(random, 1));
            Twist back = inertia.Response().Times(inertia.Times(motion));
            Assert.That((back.Angular - motion.Angular).Length + (back.Linear - motion.Linear).Length, Is.LessThan(1e-12));
        }
    }

    /// <summary>Few freedoms are swept by a matrix, many (and with other joints on the links) through the tree: the same numbers but for rounding.</summary>
    [TestCase(true)]
    [TestCase(false)]
    public void Sweeps_ByTheMatrixAndThroughTheTree_Agree(bool isPhysX5)
    {
        ArticulationRules rules = isPhysX5 ? ArticulationRules.PhysX5 : ArticulationRules.PhysX4;
        int compared = 0;
        double worst = 0;
        for (int seed = 0; seed < 300; seed++)
        {
            var byMatrix = new ArticulationSolver(WithRows(seed), rules);
            var throughTree = new ArticulationSolver(WithRows(seed), rules);
            if (byMatrix.Tree.Freedoms is 0 or > JointSpaceResponse.MostFreedoms)
                continue;
            compared++;
            for (int step = 0; step < 3; step++)
            {
                Step(byMatrix, false);
                Step(throughTree, true);
            }

            for (int i = 0; i < byMatrix.Tree.Count; i++)
            {
                double scale = 1 + throughTree.Tree.Motions[i].Linear.Length + throughTree.Tree.Motions[i].Angular.Length;
                worst = Math.Max(worst, (byMatrix.Tree.Poses[i].Position - throughTree.Tree.Poses[i].Position).Length / scale);
                worst = Math.Max(worst, (byMatrix.Tree.Motions[i].Angular - throughTree.Tree.Motions[i].Angular).Length / scale);
            }
        }

        Assert.That(compared, Is.GreaterThan(150));
        Assert.That(worst, Is.LessThan(1e-9));

        static ArticulationTree WithRows(int seed)
        {
            ArticulationTree tree = RandomTree.Make(seed, 9);
            var random = new Random(seed);
            for (int i = 1; i < tree.Count; i++)
            {
                tree.Links[i].Friction = random.Next(3) == 0 ? 0.1 : 0;
                tree.Links[i].MaxJointSpeed = random.Next(4) == 0 ? 2 : 100;
                foreach (ref LinkAxis axis in tree.Links[i].Axes.AsSpan())
                {
                    axis.Stiffness = random.Next(2) * 200;
                    axis.Damping = random.Next(2) * 5;
                    axis.ForceLimit = random.Next(2) == 0 ? 20 : double.PositiveInfinity;
                    axis.Target = 0.4;
                    (axis.Lower, axis.Upper) = (-0.7, 0.8);
                    if (axis.Motion == LinkMotion.Free && random.Next(3) == 0)
                        axis.Motion = LinkMotion.Limited;
                }
            }

            return tree;
        }

        static void Step(ArticulationSolver solver, bool hasJoints)
        {
            solver.Begin(Gravity, 0.005, hasJoints);
            for (int i = 0; i < 6; i++)
                solver.Sweep(isVelocityIteration: false);
            solver.EndPositionIterations();
            solver.Sweep(isVelocityIteration: true);
            solver.Finish();
        }
    }

    [Test]
    public void DepthFirst_OfParents_KeepsBranchesTogetherAndChildrenInOrder()
    {
        int[] parents = [-1, 0, 0, 1, 2, 1];
        int[] order = [0, 1, 3, 5, 2, 4];
        Assert.That(ArticulationTree.DepthFirst(parents), Is.EqualTo(order));
    }

    private static Vector3d[] At(ArticulationTree tree, in Pose root, in Twist rootMotion, double h)
    {
        double[] kept = tree.Positions.ToArray();
        for (int f = 0; f < tree.Freedoms; f++)
            tree.Positions[f] += h * tree.Speeds[f];
        tree.Poses[0] = new Pose(root.Position + rootMotion.Linear * h, TreeKinematics.Turn(rootMotion.Angular * h) * root.Rotation);
        TreeKinematics.Place(tree);
        Vector3d[] found = tree.Poses.Select(p => p.Position).ToArray();
        kept.CopyTo(tree.Positions, 0);
        return found;
    }

    internal static Wrench[] NetWrenches(ArticulationTree tree) => Enumerable.Range(0, tree.Count).Select(i =>
    {
        LinkDefinition link = tree.Links[i];
        Quaterniond q = tree.Poses[i].Rotation;
        Vector3d w = q.InverseRotate(tree.Motions[i].Angular);
        Vector3d spin = q * Vector3d.Cross(w, Vector3d.Scale(link.Inertia, w));
        return new Wrench(link.UseGravity ? Gravity * link.Mass : Vector3d.Zero, -spin);
    }).ToArray();
}
