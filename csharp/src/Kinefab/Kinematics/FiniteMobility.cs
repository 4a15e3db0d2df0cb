using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Freedoms of finite motion, which the velocities at one pose only bound from above: after a walk that leaves singular
/// poses, every allowed velocity is followed a little way and brought back onto the joints, and only what of it is left
/// counts. A velocity that no motion has is taken back almost wholly.
/// </summary>
internal sealed class FiniteMobility
{
    private const int WalkSteps = 3;
    private const int MaxOtherWalks = 8;
    private const double WalkLength = 0.2;
    private const double ProbeLength = 0.01;
    private const double Survives = 0.05;

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly LoopBlocks _blocks;

    public FiniteMobility(Mechanism mechanism, NewtonSolver newton, LoopBlocks blocks)
    {
        _mechanism = mechanism;
        _newton = newton;
        _blocks = blocks;
    }

    /// <summary>For each block the freedoms of the velocities at poses in general position, the least that Count found.</summary>
    public int[] AtGeneralPose { get; private set; } = Array.Empty<int>();

    /// <summary>The velocities some steps away from the exported pose, where Count looked.</summary>
    public VelocitySpace? Away { get; private set; }

    /// <summary>For each block its finite freedoms.</summary>
    public int[] Count(MechanismState start)
    {
        MechanismState state = start.Clone();
        for (int i = 0; i < WalkSteps; i++)
        {
            Walk(state, i);
        }

        var space = new VelocitySpace(_mechanism, _newton, _blocks, state);
        Away = space;
        var survivors = new List<double[]>[_blocks.Columns.Count];
        for (int b = 0; b < survivors.Length; b++)
        {
            survivors[b] = new List<double[]>();
        }

        MechanismState moved = state.Clone();
        foreach ((int block, double[] vector) in space.Basis)
        {
            if (block >= 0)
            {
                survivors[block].Add(Probe(state, moved, vector));
            }
        }

        var counts = new int[survivors.Length];
        for (int b = 0; b < counts.Length; b++)
        {
            counts[b] = Rank(survivors[b], _blocks.Columns[b]);
        }

        LookAround(start, space, counts);
        return counts;
    }

    // The walk may have taken a branch along which part of the mechanism stays folded: then others are tried.
    private void LookAround(MechanismState start, VelocitySpace space, int[] finite)
    {
        AtGeneralPose = FirstOrder(space);
        for (int i = 0; i < MaxOtherWalks && IsMore(); i++)
        {
            MechanismState other = start.Clone();
            for (int k = 0; k < WalkSteps; k++)
            {
                Walk(other, (i + 1) * WalkSteps + k);
            }

            int[] there = FirstOrder(new VelocitySpace(_mechanism, _newton, _blocks, other));
            for (int b = 0; b < there.Length; b++)
            {
                AtGeneralPose[b] = Math.Min(AtGeneralPose[b], there[b]);
            }
        }

        bool IsMore()
        {
            bool more = false;
            for (int b = 0; b < finite.Length; b++)
            {
                more |= AtGeneralPose[b] > finite[b];
            }

            return more;
        }
    }

    private int[] FirstOrder(VelocitySpace space)
    {
        var freedoms = new int[_blocks.Columns.Count];
        for (int b = 0; b < freedoms.Length; b++)
        {
            freedoms[b] = _blocks.Columns[b].Count - space.Ranks[b];
        }

        return freedoms;
    }

    // A step along a mixture of all allowed velocities, the same on every machine; undone when the joints do not close.
    private void Walk(MechanismState state, int round)
    {
        var space = new VelocitySpace(_mechanism, _newton, _blocks, state);
        var step = new double[_newton.Motion.Linear.Length];
        int k = 0;
        foreach ((int block, double[] vector) in space.Basis)
        {
            k++;
            double weight = block < 0 ? 0 : Math.Sin(12.9898 * k + 4.1414 * round);
            for (int i = 0; i < step.Length; i++)
            {
                step[i] += weight * vector[i];
            }
        }

        double largest = 0;
        foreach (double entry in step)
        {
            largest = Math.Max(largest, Math.Abs(entry));
        }

        for (int i = 0; i < step.Length && largest > 0; i++)
        {
            step[i] *= WalkLength / largest;
        }

        MechanismState before = state.Clone();
        _newton.Motion.Start(state.Poses);
        _newton.Motion.Move(state.Poses, step);
        if (!_newton.Close(state))
        {
            state.CopyFrom(before);
        }
    }

    // What is left of a velocity, as a share of how far it was followed.
    private double[] Probe(MechanismState state, MechanismState moved, double[] vector)
    {
        moved.CopyFrom(state);
        var step = new double[vector.Length];
        for (int i = 0; i < step.Length; i++)
        {
            step[i] = ProbeLength * vector[i];
        }

        _newton.Motion.Start(moved.Poses);
        _newton.Motion.Move(moved.Poses, step);
        _newton.Close(moved);
        var left = new double[step.Length];
        for (int i = 0; i < left.Length; i++)
        {
            left[i] = (step[i] + _newton.Closing[i]) / ProbeLength;
        }

        return left;
    }

    private static int Rank(List<double[]> survivors, IReadOnlyList<int> columns)
    {
        // One column for each survivor, so that their span is counted, not the freedoms they touch.
        var matrix = new double[columns.Count, survivors.Count];
        for (int j = 0; j < survivors.Count; j++)
        {
            for (int i = 0; i < columns.Count; i++)
            {
                matrix[i, j] = survivors[j][columns[i]];
            }
        }

        int rank = 0;
        foreach (double value in new SingularValues(matrix).Values)
        {
            rank += value > Survives ? 1 : 0;
        }

        return rank;
    }
}
