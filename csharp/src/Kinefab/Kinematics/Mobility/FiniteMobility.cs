using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Freedoms of finite motion of one block, which the velocities at one pose only bound from above: after a walk that leaves singular
/// poses, every allowed velocity is followed a little way and brought back onto the joints, and only what of it is left
/// counts. A velocity that no motion has is taken back almost wholly.
/// </summary>
internal sealed class FiniteMobility
{
    private const int WalkSteps = 3;
    private const int MaxOtherWalks = 8;
    private const double WalkLength = 0.2;
    private const double Survives = 0.05;
    private const double Whole = 0.9;

    // What is left of an obstructed velocity is the root of the closing error, this much at most, whatever the way.
    private const double LeftOfObstructed = 5e-5;

    // Times that what is left of velocities is tried again.
    private const int Rounds = 3;

    // Of a step along a velocity. What is left of one that is obstructed is no share of the way but what the closing error hides: where a
    // steep coupling leaves little of the way to what is obstructed, a longer one tells.
    private static readonly double[] ProbeLengths = { 0.01, 0.05, 0.2 };

    private readonly Linkage _linkage;
    private readonly NewtonSolver _newton;
    private readonly FreedomBlocks _blocks;

    /// <summary>Of a linkage all of whose freedoms are one block's.</summary>
    public FiniteMobility(Linkage linkage, NewtonSolver newton, FreedomBlocks blocks)
    {
        _linkage = linkage;
        _newton = newton;
        _blocks = blocks;
    }

    /// <summary>Freedoms of the velocities at poses in general position, the least that Count found.</summary>
    public int AtGeneralPose { get; private set; }

    /// <summary>The finite freedoms.</summary>
    public int Count(MechanismState start, CancellationToken cancellation)
    {
        MechanismState state = start.Clone();
        for (int i = 0; i < WalkSteps; i++)
        {
            cancellation.ThrowIfCancellationRequested();
            Walk(state, i);
        }

        var space = new VelocitySpace(_linkage, _newton, _blocks, state);
        int count = 0;
        foreach (double length in ProbeLengths)
        {
            double[] shares = LeftOf(space.Basis, state, length, cancellation).Values.Values;
            count = Array.FindAll(shares, share => share > Survives).Length;
            if (count == Array.FindAll(shares, share => share > Whole).Length)
            {
                break;
            }
        }

        LookAround(start, space, count, cancellation);
        return count;
    }

    /// <summary>Of the velocities at a state, those directions that a trial step leaves most of, falling.</summary>
    public List<double[]> Kept(VelocitySpace space, MechanismState state, int count, CancellationToken cancellation)
    {
        (List<double[]> left, SingularValues values) = LeftOf(space.Basis, state, ProbeLengths[0], cancellation);
        return Directions(left, values, Math.Min(count, values.Rank(LeftOfObstructed / ProbeLengths[0])));
    }

    // The walk may have taken a branch along which part of the mechanism stays folded: then others are tried.
    private void LookAround(MechanismState start, VelocitySpace space, int finite, CancellationToken cancellation)
    {
        AtGeneralPose = space.Freedoms;
        for (int i = 0; i < MaxOtherWalks && AtGeneralPose > finite; i++)
        {
            cancellation.ThrowIfCancellationRequested();
            MechanismState other = start.Clone();
            for (int k = 0; k < WalkSteps; k++)
            {
                Walk(other, (i + 1) * WalkSteps + k);
            }

            AtGeneralPose = Math.Min(AtGeneralPose, new VelocitySpace(_linkage, _newton, _blocks, other).Freedoms);
        }
    }

    // A step along a mixture of all allowed velocities, the same on every machine; undone when the joints do not close.
    private void Walk(MechanismState state, int round)
    {
        double[] step = new VelocitySpace(_linkage, _newton, _blocks, state).Mixture(round, WalkLength);
        MechanismState before = state.Clone();
        _newton.Motion.Start(state.Poses);
        _newton.Motion.Move(state.Poses, step);
        if (!_newton.Close(state))
        {
            state.CopyFrom(before);
        }
    }

    // What is left of a velocity, as a share of how far it was followed.
    private double[] Probe(MechanismState state, MechanismState moved, double[] vector, double length, out bool isClosed)
    {
        moved.CopyFrom(state);
        var step = new double[vector.Length];
        for (int i = 0; i < step.Length; i++)
        {
            step[i] = length * vector[i];
        }

        _newton.Motion.Start(moved.Poses);
        _newton.Motion.Move(moved.Poses, step);
        var left = new double[step.Length];
        isClosed = _newton.Close(moved);
        for (int i = 0; i < left.Length; i++)
        {
            left[i] = (step[i] + _newton.Closing[i]) / length;
        }

        return left;
    }

    // What is left of velocities, and shares, falling, of the independent directions in it. An obstructed one takes a motion back along with
    // it: what is left of velocities that hold both is tried again by itself.
    private (List<double[]> Left, SingularValues Values) LeftOf(IReadOnlyList<double[]> velocities, MechanismState state, double length, CancellationToken cancellation)
    {
        double gone = LeftOfObstructed / length;
        MechanismState moved = state.Clone();
        for (int round = 1; ; round++)
        {
            var left = new List<double[]>();
            bool areClosed = true;
            foreach (double[] velocity in velocities)
            {
                cancellation.ThrowIfCancellationRequested();
                double[] share = Probe(state, moved, velocity, length, out bool isClosed);

                // What does not come back onto the joints may hold a motion; by itself it has kept nothing.
                left.Add(isClosed || round < Rounds ? share : new double[share.Length]);
                areClosed &= isClosed;
            }

            SingularValues values = Decomposed(left);
            if (round == Rounds || (areClosed && !Array.Exists(values.Values, share => share > gone && share < Whole)))
            {
                return (left, values);
            }

            velocities = Directions(left, values, values.Rank(gone));
        }
    }

    // One column for each velocity, so that their span is counted, not the freedoms they touch.
    private static SingularValues Decomposed(List<double[]> columns)
    {
        var matrix = new double[columns.Count == 0 ? 0 : columns[0].Length, columns.Count];
        for (int j = 0; j < columns.Count; j++)
        {
            for (int i = 0; i < columns[j].Length; i++)
            {
                matrix[i, j] = columns[j][i];
            }
        }

        return new SingularValues(matrix);
    }

    // The left singular vectors of the first singular values.
    private static List<double[]> Directions(List<double[]> columns, SingularValues values, int count)
    {
        var directions = new List<double[]>();
        for (int k = 0; k < count; k++)
        {
            var direction = new double[columns[0].Length];
            for (int j = 0; j < columns.Count; j++)
            {
                double share = values.Vector(j, k) / values.Values[k];
                for (int i = 0; i < direction.Length; i++)
                {
                    direction[i] += share * columns[j][i];
                }
            }

            directions.Add(direction);
        }

        return directions;
    }
}
