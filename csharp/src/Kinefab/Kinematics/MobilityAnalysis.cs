using System;
using System.Collections.Generic;

namespace Kinefab.Kinematics;

/// <summary>Counts what a mechanism's joints leave free: velocities at the exported pose, finite motions, by island and body.</summary>
public static class MobilityAnalysis
{
    // Length of a row, of about 1 at the start, that has to be left beside the rows before it for it to count.
    private const double IndependentRow = 1e-6;

    /// <summary>Analyses a mechanism at its exported pose, closed as well as it can be. Limits are not looked at.</summary>
    public static MobilityReport Of(Mechanism mechanism)
    {
        if (mechanism is null)
            throw new ArgumentNullException(nameof(mechanism));
        var newton = new NewtonSolver(mechanism);
        MechanismState state = mechanism.NewState();
        newton.Close(state);
        newton.Accepted = Math.Max(newton.Accepted, 4 * newton.Equations.Worst);
        int freedoms = newton.Motion.Linear.Length;
        var blocks = new LoopBlocks(mechanism, newton.Firsts, freedoms);
        var space = new VelocitySpace(mechanism, newton, blocks, state);
        var finiteMobility = new FiniteMobility(mechanism, newton, blocks);
        int[] finite = finiteMobility.Count(state);
        int general = Array.FindAll(blocks.BlockOf, block => block < 0).Length;
        foreach (int freedom in finiteMobility.AtGeneralPose)
        {
            general += freedom;
        }

        Dictionary<int, int> redundant = RedundantOf(mechanism, space);

        var islands = Islands(mechanism, newton, space, finite);
        int mobility = 0;
        int firstOrder = 0;
        int redundantRows = 0;
        foreach (IslandMobility island in islands)
        {
            mobility += island.Mobility;
            firstOrder += island.FirstOrder;
            redundantRows += island.Redundant;
        }

        var bodies = new List<BodyMobility>();
        foreach (int body in mechanism.Tree.Order)
        {
            bodies.Add(space.Of(body));
        }

        bodies.Sort((a, b) => a.GameObject.CompareTo(b.GameObject));
        int rows = 6 * mechanism.Tree.Order.Length - firstOrder + redundantRows;
        return new MobilityReport(mobility, firstOrder, general, rows, redundantRows, space.Gap, islands, bodies, Named(mechanism, redundant), IdleFreedoms.Of(mechanism, space, finiteMobility.Away ?? space, finite));
    }

    private static List<IslandMobility> Islands(Mechanism mechanism, NewtonSolver newton, VelocitySpace space, int[] finite)
    {
        KinematicTree tree = mechanism.Tree;
        var sets = new DisjointSets(mechanism.BodyCount);
        foreach (Joints.Joint joint in mechanism.Joints)
        {
            int a = tree.Moving(joint.Body0);
            int b = tree.Moving(joint.Body1);
            if (a >= 0 && b >= 0)
            {
                sets.Join(a, b);
            }
        }

        foreach (RowPath path in mechanism.Rows.Couplings)
        {
            foreach (int body in path.Bodies)
            {
                sets.Join(path.Bodies[0], body);
            }
        }

        var tallies = new SortedDictionary<int, Tally>();
        foreach (int body in tree.Order)
        {
            if (!tallies.TryGetValue(sets.Find(body), out Tally? tally))
            {
                tallies.Add(sets.Find(body), tally = new Tally());
            }

            tally.GameObjects.Add(mechanism.GameObjects[body]);
            for (int i = 0; i < tree.Freedoms[body]; i++)
            {
                int block = space.Blocks.BlockOf[newton.Firsts[body] + i];
                tally.Free += block < 0 ? 1 : 0;
                if (block >= 0)
                {
                    tally.Blocks.Add(block);
                }
            }
        }

        foreach (int joint in tree.Closures)
        {
            int body = Math.Max(tree.Moving(mechanism.Joints[joint].Body0), tree.Moving(mechanism.Joints[joint].Body1));
            Tally tally = tallies[sets.Find(body)];
            tally.Rows += 6 - FreeTwists.Count(FreeTwists.LockedAxes(mechanism.Joints[joint]));
            tally.Loops++;
        }

        foreach (RowPath path in mechanism.Rows.Couplings)
        {
            tallies[sets.Find(path.Bodies[0])].Rows++;
        }

        var islands = new List<IslandMobility>();
        foreach (Tally tally in tallies.Values)
        {
            int mobility = tally.Free;
            int firstOrder = tally.Free;
            int rank = 0;
            foreach (int block in tally.Blocks)
            {
                mobility += finite[block];
                firstOrder += space.Blocks.Columns[block].Count - space.Ranks[block];
                rank += space.Ranks[block];
            }

            tally.GameObjects.Sort();
            islands.Add(new IslandMobility(tally.GameObjects, mobility, firstOrder, tally.Rows - rank, tally.Loops));
        }

        islands.Sort((a, b) => a.GameObjects[0].CompareTo(b.GameObjects[0]));
        return islands;
    }

    // A row is redundant when nothing of it is left after the rows before it are taken out (Gram-Schmidt, twice).
    private static Dictionary<int, int> RedundantOf(Mechanism mechanism, VelocitySpace space)
    {
        var redundant = new Dictionary<int, int>();
        var kept = new List<double[]>[space.Blocks.Columns.Count];
        for (int b = 0; b < kept.Length; b++)
        {
            kept[b] = new List<double[]>();
        }

        int row = 0;
        foreach (int joint in mechanism.Tree.Closures)
        {
            int rows = 6 - FreeTwists.Count(FreeTwists.LockedAxes(mechanism.Joints[joint]));
            for (int i = 0; i < rows; i++)
            {
                double[] left = (double[])space.Rows.Row(row++).Clone();
                int block = BlockOf(left, space.Blocks.BlockOf);
                for (int pass = 0; pass < 2 && block >= 0; pass++)
                {
                    foreach (double[] other in kept[block])
                    {
                        Subtract(left, other);
                    }
                }

                double rest = Length(left);
                if (block < 0 || rest <= IndependentRow)
                {
                    redundant[joint] = redundant.TryGetValue(joint, out int count) ? count + 1 : 1;
                    continue;
                }

                for (int k = 0; k < left.Length; k++)
                {
                    left[k] /= rest;
                }

                kept[block].Add(left);
            }
        }

        return redundant;
    }

    private static List<RedundantRows> Named(Mechanism mechanism, Dictionary<int, int> redundant)
    {
        var named = new List<RedundantRows>();
        for (int j = 0; j < mechanism.JointPlaces.Length; j++)
        {
            if (redundant.TryGetValue(j, out int count))
            {
                (int gameObject, int component) = mechanism.JointPlaces[j];
                int rows = 6 - FreeTwists.Count(FreeTwists.LockedAxes(mechanism.Joints[j]));
                named.Add(new RedundantRows(gameObject, component, rows, count));
            }
        }

        return named;
    }

    private static int BlockOf(double[] row, int[] blockOf)
    {
        for (int i = 0; i < row.Length; i++)
        {
            if (row[i] != 0)
            {
                return blockOf[i];
            }
        }

        return -1;
    }

    private static double Length(double[] row)
    {
        double sum = 0;
        foreach (double entry in row)
        {
            sum += entry * entry;
        }

        return Math.Sqrt(sum);
    }

    private static void Subtract(double[] row, double[] unit)
    {
        double dot = 0;
        for (int i = 0; i < row.Length; i++)
        {
            dot += row[i] * unit[i];
        }

        for (int i = 0; i < row.Length; i++)
        {
            row[i] -= dot * unit[i];
        }
    }

    private sealed class Tally
    {
        public List<int> GameObjects { get; } = new();

        public SortedSet<int> Blocks { get; } = new();

        public int Free { get; set; }

        public int Rows { get; set; }

        public int Loops { get; set; }
    }
}
