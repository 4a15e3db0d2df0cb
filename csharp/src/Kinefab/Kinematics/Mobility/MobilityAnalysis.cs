using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Counts what a mechanism's joints leave free: velocities at the exported pose, finite motions, by island and body.</summary>
public static class MobilityAnalysis
{
    /// <summary>
    /// Analyses a mechanism at its exported pose, closed as well as it can be. Limits are not looked at. Freedoms that no loop and
    /// no coupling ties to others are their own; what is tied is analysed block by block, each alone.
    /// </summary>
    /// <param name="mechanism">Not changed.</param>
    /// <param name="progress">Told the share of the blocks that is done, 0 to 1; null: nobody is.</param>
    /// <param name="cancellation">Ends the analysis early.</param>
    /// <returns>Freedoms of the whole, of each island and the idle ones among them.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static MobilityReport Of(Mechanism mechanism, IProgress<double>? progress = null, CancellationToken cancellation = default)
    {
        if (mechanism is null)
            throw new ArgumentNullException(nameof(mechanism));
        var newton = new NewtonSolver(mechanism.Linkage, cancellation);
        MechanismState state = mechanism.NewState();
        double open = Open(mechanism, newton, state);
        newton.Close(state);
        newton.Motion.Start(state.Poses);
        var blocks = new FreedomBlocks(mechanism.Linkage, newton.Firsts, newton.Motion.Linear.Length);
        var parts = new IndependentLinkages(mechanism.Linkage, blocks, newton.Firsts);
        var loops = new LoopMobility[parts.Count];
        int[] redundant = RowsThatTieNothing(mechanism);
        double gap = double.PositiveInfinity;
        int inDoubt = 0;
        bool isNoisy = false;
        int general = Array.FindAll(blocks.BlockOf, block => block < 0).Length;
        for (int b = 0; b < loops.Length; b++)
        {
            cancellation.ThrowIfCancellationRequested();
            progress?.Report((double)b / loops.Length);
            loops[b] = new LoopMobility(parts.Make(b, state.Poses), state, cancellation);
            loops[b].CountRedundant(redundant);
            gap = Math.Min(gap, loops[b].Here.Gap);
            inDoubt += loops[b].InDoubt(open);
            isNoisy |= loops[b].IsNoisy(open);
            general += loops[b].AtGeneralPose;
        }

        List<IdleFreedom> idle = IdleFreedoms.Of(mechanism, parts, loops, state, cancellation);
        progress?.Report(1);
        var islands = Islands(mechanism, parts, loops);
        int mobility = 0;
        int firstOrder = 0;
        int redundantRows = 0;
        foreach (IslandMobility island in islands)
        {
            mobility += island.Mobility;
            firstOrder += island.FirstOrder;
            redundantRows += island.Redundant;
        }

        List<BodyMobility> bodies = BodyTwists.Of(mechanism, newton, state.Poses, parts, loops, open, cancellation);
        bodies.Sort((a, b) => a.GameObject.CompareTo(b.GameObject));
        int rows = 6 * mechanism.Tree.Order.Length - firstOrder + redundantRows;
        return new MobilityReport(mobility, firstOrder, general, rows, redundantRows, gap, inDoubt, isNoisy, islands, bodies, Named(mechanism, redundant), idle);
    }

    // What the exported pose is open by: its joints as they stand, and what the exporter says that it missed the source's by, of which a Unity
    // joint that takes its other side from the pose no longer has a trace.
    private static double Open(Mechanism mechanism, NewtonSolver newton, MechanismState state)
    {
        double open = newton.ErrorOf(state);
        if (mechanism.Scene.Document.Analysis?.ClosureGap is Document.ClosureGap stated)
        {
            open = Math.Max(open, Math.Max(stated.Position / mechanism.Length, stated.Angle * Math.PI / 180));
        }

        return open;
    }

    // For each joint the rows that repeat others: at first those of joints between bodies that the tree holds already.
    private static int[] RowsThatTieNothing(Mechanism mechanism)
    {
        var redundant = new int[mechanism.Joints.Length];
        foreach (int joint in mechanism.Tree.Closures)
        {
            redundant[joint] = mechanism.Rows.Joints[joint].Bodies.Length == 0 ? MotionSubspace.Rows(mechanism.Joints[joint]) : 0;
        }

        return redundant;
    }

    private static List<IslandMobility> Islands(Mechanism mechanism, IndependentLinkages parts, LoopMobility[] loops)
    {
        KinematicTree tree = mechanism.Tree;
        var sets = new DisjointSets(mechanism.BodyCount);
        for (int j = 0; j < mechanism.Joints.Length; j++)
        {
            int a = tree.Moving(mechanism.Joints[j].Body0);
            int b = tree.Moving(mechanism.Joints[j].Body1);
            if (a >= 0 && b >= 0 && !mechanism.HoldsNothing[j])
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
            if (parts.BlockOf(body) >= 0)
            {
                tally.Blocks.Add(parts.BlockOf(body));
            }
            else
            {
                tally.Free += tree.Freedoms[body];
            }
        }

        foreach (int joint in tree.Closures)
        {
            if (mechanism.HoldsNothing[joint])
            {
                continue;
            }

            int body = Math.Max(tree.Moving(mechanism.Joints[joint].Body0), tree.Moving(mechanism.Joints[joint].Body1));
            Tally tally = tallies[sets.Find(body)];
            tally.Rows += MotionSubspace.Rows(mechanism.Joints[joint]);
            tally.Loops++;
        }

        for (int i = 0; i < mechanism.Couplings.Length; i++)
        {
            int body = BodyOf(mechanism, i);
            if (body >= 0)
            {
                tallies[sets.Find(body)].Rows++;
            }
        }

        var islands = new List<IslandMobility>();
        foreach (Tally tally in tallies.Values)
        {
            int mobility = tally.Free;
            int firstOrder = tally.Free;
            int rank = 0;
            foreach (int block in tally.Blocks)
            {
                mobility += loops[block].Finite;
                firstOrder += loops[block].FirstOrder;
                rank += loops[block].Rank;
            }

            tally.GameObjects.Sort();
            islands.Add(new IslandMobility(tally.GameObjects, mobility, firstOrder, tally.Rows - rank, tally.Loops));
        }

        islands.Sort((a, b) => a.GameObjects[0].CompareTo(b.GameObjects[0]));
        return islands;
    }

    // A body of a coupling's island; -1 when it counts from joints of bodies at rest alone.
    private static int BodyOf(Mechanism mechanism, int coupling)
    {
        int[] path = mechanism.Rows.Couplings[coupling].Bodies;
        if (path.Length > 0)
        {
            return path[0];
        }

        PositionCoupling source = mechanism.Couplings[coupling];
        int body = Moving(source.Driven);
        foreach (int term in source.Terms)
        {
            body = Math.Max(body, Moving(term));
        }

        return body;

        int Moving(int coordinate)
        {
            Joints.JointModel joint = mechanism.Joints[mechanism.Coordinates[coordinate].Joint];
            return Math.Max(mechanism.Tree.Moving(joint.Body0), mechanism.Tree.Moving(joint.Body1));
        }
    }

    private static List<RedundantRows> Named(Mechanism mechanism, int[] redundant)
    {
        var named = new List<RedundantRows>();
        for (int j = 0; j < mechanism.JointPlaces.Length; j++)
        {
            if (redundant[j] > 0)
            {
                (int gameObject, int component) = mechanism.JointPlaces[j];
                named.Add(new RedundantRows(gameObject, component, MotionSubspace.Rows(mechanism.Joints[j]), redundant[j]));
            }
        }

        return named;
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
