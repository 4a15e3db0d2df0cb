using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Motions among the velocities of a linkage at a pose: each is followed a little way and brought back onto the joints, and only what of it
/// is left counts. A velocity that no motion has is taken back almost wholly.
/// </summary>
internal sealed class TrialSteps
{
    // Shares of its length that a velocity keeps: up to the first it is none, from the last on a motion; in doubt, half of it decides.
    private const double Survives = 0.05;
    private const double Half = 0.5;
    private const double Whole = 0.9;

    // What is left of an obstructed velocity is the root of the closing error, this much at most, whatever the way.
    private const double LeftOfObstructed = 5e-5;

    // Share of a velocity up to which nothing turns in it.
    private const double Still = 1e-6;

    // Times that what is left of velocities is tried, and the mixtures of motions that are.
    private const int Rounds = 3;
    private const int Mixtures = 3;

    // Of a step along a velocity. What is left of one that is obstructed is no share of the way but what the closing error hides: where a
    // steep coupling leaves little of the way to what is obstructed, or a high power of the way obstructs it, a longer one tells.
    private static readonly double[] Lengths = { 0.01, 0.05, 0.2 };

    private readonly NewtonSolver _newton;
    private readonly FineClosing _closing;
    private readonly CancellationToken _cancellation;
    private readonly MechanismState _from;
    private readonly MechanismState _moved;
    private readonly List<double[]> _motions = new();

    /// <summary>Of velocities at a closed state, orthonormal.</summary>
    public TrialSteps(NewtonSolver newton, FineClosing closing, IReadOnlyList<double[]> velocities, MechanismState state, CancellationToken cancellation)
    {
        _newton = newton;
        _closing = closing;
        _cancellation = cancellation;
        _from = state;
        _moved = state.Clone();
        IsSure = Try(velocities);
    }

    /// <summary>Orthonormal directions of motions: where branches of motions meet, of all of them.</summary>
    public IReadOnlyList<double[]> Motions => _motions;

    /// <summary>Whether each velocity is a motion or none beyond doubt.</summary>
    public bool IsSure { get; }

    /// <summary>Whether mixtures of all motions are motions as they are: where branches cross, only what one branch has of them is left.</summary>
    public bool MixturesMove() => MixturesMove(_motions);

    /// <summary>Those of the motions that one branch has: the most found whose mixtures are motions too.</summary>
    public List<double[]> LargestBranch()
    {
        var largest = new List<double[]>();
        for (int first = 0; first < _motions.Count && largest.Count < _motions.Count; first++)
        {
            var branch = new List<double[]> { _motions[first] };
            for (int k = 1; k < _motions.Count; k++)
            {
                branch.Add(_motions[(first + k) % _motions.Count]);
                if (!MixturesMove(branch))
                {
                    branch.RemoveAt(branch.Count - 1);
                }
            }

            largest = branch.Count > largest.Count ? branch : largest;
        }

        return largest;
    }

    private bool MixturesMove(List<double[]> motions)
    {
        for (int round = 0; round < Mixtures && motions.Count > 1; round++)
        {
            var mixture = new double[motions[0].Length];
            for (int k = 0; k < motions.Count; k++)
            {
                DenseVector.Add(mixture, VelocitySpace.Weight(k, round), motions[k]);
            }

            DenseVector.Divide(mixture, DenseVector.Length(mixture));
            double[] left = Followed(mixture, isLast: true, out bool isClosed);
            DenseVector.Add(left, -1, mixture);
            if (!isClosed || DenseVector.Length(left) > 1 - Whole)
            {
                return false;
            }
        }

        return true;
    }

    // An obstructed velocity takes a motion back along with it, or does not come back onto the joints: what is left of velocities that hold
    // both, beside the motions found, is tried again by itself.
    private bool Try(IReadOnlyList<double[]> velocities)
    {
        for (int round = 1; ; round++)
        {
            var rest = new List<double[]>();
            foreach (double[] velocity in velocities)
            {
                _cancellation.ThrowIfCancellationRequested();
                double[] left = Followed(velocity, round == Rounds, out bool isClosed);
                if (!(isClosed && TakeMotion(left, Whole)) && (isClosed || round < Rounds))
                {
                    rest.Add(left);
                }
            }

            foreach (double[] left in rest)
            {
                _motions.ForEach(motion => DenseVector.RemoveAlong(left, motion));
            }

            var values = SingularValues.OfColumns(rest);
            velocities = Directions(rest, values, values.Rank(round < Rounds ? LeftOfObstructed / Lengths[0] : Survives));
            if (velocities.Count == 0)
            {
                return true;
            }

            if (round == Rounds)
            {
                foreach (double[] direction in Directions(rest, values, values.Rank(Half)))
                {
                    TakeMotion(direction, Half);
                }

                return false;
            }
        }
    }

    // Whether what is left of a velocity, beside the motions found, is one more.
    private bool TakeMotion(double[] left, double least)
    {
        if (DenseVector.Length(left) <= least)
        {
            return false;
        }

        var direction = (double[])left.Clone();
        _motions.ForEach(motion => DenseVector.RemoveAlong(direction, motion));
        double length = DenseVector.Length(direction);
        if (length <= Half)
        {
            return false;
        }

        DenseVector.Divide(direction, length);
        _motions.Add(direction);
        return true;
    }

    // What trial steps leave of a velocity, as a share of it, and whether they came back onto the joints; longer ones where one does not tell.
    private double[] Followed(double[] velocity, bool isLast, out bool isClosed)
    {
        var left = velocity;
        isClosed = true;
        foreach (double length in Lengths)
        {
            double[] there = Left(velocity, length);
            isClosed = _closing.IsClosed;
            left = isClosed || length == Lengths[0] ? there : left;
            double share = DenseVector.Length(there);
            bool isInDoubt = share > LeftOfObstructed / length && share < Whole;
            if (!isClosed || (_closing.IsExact && !(isLast && isInDoubt)))
            {
                break;
            }
        }

        return left;
    }

    private double[] Left(double[] velocity, double length)
    {
        _moved.CopyFrom(_from);
        _newton.Motion.Start(_moved.Poses);
        double way = Way(velocity, length);
        var left = new double[velocity.Length];
        DenseVector.Add(left, way, velocity);
        _newton.Motion.Move(_moved.Poses, left);
        _closing.Close(_moved);
        DenseVector.Add(left, 1, _closing.Closing);
        DenseVector.Divide(left, way);
        return left;
    }

    // How far a step of a length goes: until what turns has gone as far as all does, or to the longest. Beside the slide of a steep rack a turn
    // is little, and what its fourth power obstructs a rounding.
    private double Way(double[] velocity, double length)
    {
        double turn = 0;
        for (int i = 0; i < velocity.Length; i++)
        {
            turn = Math.Max(turn, _newton.Motion.Angular[i] == Vector3d.Zero ? 0 : Math.Abs(velocity[i]));
        }

        double largest = DenseVector.Largest(velocity);
        return turn > Still * largest ? Math.Max(length, Math.Min(length * largest / turn, Lengths[Lengths.Length - 1])) : length;
    }

    // The left singular vectors of the first singular values of columns.
    private static List<double[]> Directions(List<double[]> columns, SingularValues values, int count)
    {
        var directions = new List<double[]>();
        for (int k = 0; k < count; k++)
        {
            var direction = new double[columns[0].Length];
            for (int j = 0; j < columns.Count; j++)
            {
                DenseVector.Add(direction, values.Vector(j, k) / values.Values[k], columns[j]);
            }

            directions.Add(direction);
        }

        return directions;
    }
}
