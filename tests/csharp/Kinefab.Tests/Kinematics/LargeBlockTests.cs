using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics.Rattle;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>Blocks of more freedoms than are decomposed whole: the same counts, from what each row leaves.</summary>
public sealed class LargeBlockTests
{
    // Plates that turn against their neighbours, all by one angle. Each cell is 5 rows, and all freedoms but one are taken.
    [TestCase(8)]
    [TestCase(12)]
    [TestCase(30)]
    public void Count_GridOfClosedCells_IsOneFreedom(int cells)
    {
        MobilityReport report = MobilityAnalysis.Of(Mechanism.Create(SceneValidator.Validate(HubScenes.Grid(cells)).Scene!));
        int hinges = 2 * cells * (cells + 1);
        int bodies = (cells + 1) * (cells + 1) - 1;
        Assert.That((report.Mobility, report.FirstOrder, report.AtGeneralPose), Is.EqualTo((1, 1, 1)));
        Assert.That(report.Redundant, Is.EqualTo(5 * hinges - (6 * bodies - 1)));
        Assert.That(report.Bodies.Select(b => b.Translations + b.Rotations), Is.All.EqualTo(1).Or.EqualTo(0).Or.EqualTo(2));
        Assert.That(report.Gap, Is.GreaterThan(1e9));
    }

    // Five-bars in a row, each on the last two of the one before, all different and turned in space: two freedoms, and one for each further one.
    [TestCase(25)]
    [TestCase(60)]
    public void Count_RowOfPentagons_IsOneFreedomForEachAndOneMore(int cells)
    {
        var scene = new MechanismScene();
        var random = new Random(7);
        Vector3d axis = new Vector3d(0.3, -0.5, 0.8).Normalized();
        Vector3d x = Vector3d.Cross(axis, Vector3d.UnitX).Normalized();
        Vector3d y = Vector3d.Cross(axis, x);
        Vector3d At(double u, double v) => new Vector3d(0.1, 0.2, 0.3) + x * (u + 0.2 * random.NextDouble()) + y * (v + 0.2 * random.NextDouble());

        // Rungs stand across; between two of them one bar below and two bars above.
        int? rung = null;
        Vector3d below = At(0, 0);
        Vector3d above = At(0, 1);
        for (int i = 0; i < cells; i++)
        {
            Vector3d nextBelow = At(i + 1, 0);
            Vector3d nextAbove = At(i + 1, 1);
            Vector3d knee = At(i + 0.5, 1.4);
            int low = scene.Body($"low{i}", below);
            int left = scene.Body($"left{i}", above);
            int right = scene.Body($"right{i}", knee);
            int next = scene.Body($"rung{i}", nextBelow);
            scene.Hinge(low, rung, below, axis);
            scene.Hinge(next, low, nextBelow, axis);
            scene.Hinge(left, rung, above, axis);
            scene.Hinge(right, left, knee, axis);
            scene.Hinge(next, right, nextAbove, axis);
            (rung, below, above) = (next, nextBelow, nextAbove);
        }

        MobilityReport report = MobilityAnalysis.Of(scene.Mechanism());
        Assert.That((report.Mobility, report.FirstOrder, report.Redundant), Is.EqualTo((2 * cells, 2 * cells, 3 * cells)));
    }

    [Test]
    public void Take_RowsInAnyOrder_LeavesTheirNullSpace()
    {
        var random = new Random(11);
        for (int round = 0; round < 50; round++)
        {
            int freedoms = random.Next(1, 30);
            var rows = new List<double[]>();
            int count = random.Next(0, 40);
            while (rows.Count < count)
            {
                double[] row = new double[freedoms];
                for (int entry = 0; entry < 3; entry++)
                    row[random.Next(freedoms)] = random.NextDouble() - 0.5;
                rows.Add(rows.Count > 2 && random.Next(4) == 0 ? rows[^1].Zip(rows[^2], (a, b) => a - 2 * b).ToArray() : row);
            }

            int[] columns = Enumerable.Range(0, freedoms).ToArray();
            var elimination = new RowElimination(freedoms);
            int taken = rows.Count(row => elimination.Take(columns, row, 1e-9) > 1e-9);
            var matrix = new double[count, freedoms];
            for (int r = 0; r < count; r++)
            {
                for (int i = 0; i < freedoms; i++)
                    matrix[r, i] = rows[r][i];
            }

            List<double[]> basis = elimination.Basis();
            Assert.That((taken, elimination.Motions, basis.Count), Is.EqualTo((new SingularValues(matrix).Rank(1e-9), freedoms - taken, freedoms - taken)));
            foreach (double[] motion in basis)
            {
                Assert.That(rows.Select(row => Math.Abs(row.Zip(motion, (a, b) => a * b).Sum())), Is.All.LessThan(1e-7));
                Assert.That(basis.Select(other => other.Zip(motion, (a, b) => a * b).Sum() - (other == motion ? 1 : 0)), Is.All.EqualTo(0).Within(1e-13));
            }

            Assert.That(rows.SelectMany(row => elimination.Along(columns, row)), Is.All.EqualTo(0).Within(1e-7));
        }
    }
}
