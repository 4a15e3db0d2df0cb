using System.Collections.Generic;
using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Finds the ways that lead on from a pose where branches of motion meet and nothing travelled so far tells which to take,
/// such as a parallelogram exported flat. The velocities at such a pose are more than the motions; the motions are found by
/// closing the joints a small step away from many mixtures of the velocities. The straightest comes first: on a
/// parallelogram, whichever of its bars is driven, that is the parallelogram and not its crossed twin. Of branches that are
/// straight alike the one on which most joints move comes first, since bars that only fold onto others are not meant.
/// </summary>
internal sealed class BranchSearch
{
    // Radians, or lengths of the mechanism.
    private const double FarthestStart = 0.5;
    private const double FarthestPose = 1;
    private const double LeastRate = 1e-3;

    // Shares of the step.
    private const double SamePose = 0.05;
    private const double SameBend = 1e-7;
    private const double SameRate = 1e-3;
    private const int CirclePoints = 24;
    private const int SpherePoints = 64;

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly RankDeficiency _singular;
    private readonly FreedomBlocks _blocks;

    public BranchSearch(Mechanism mechanism, NewtonSolver newton, RankDeficiency singular)
    {
        _mechanism = mechanism;
        _newton = newton;
        _singular = singular;
        _blocks = new FreedomBlocks(mechanism.Linkage, newton.Firsts, newton.Motion.Linear.Length);
    }

    /// <summary>All branches found, the straightest first, then those on which most joints move, then those that change least.</summary>
    /// <param name="at">A closed state; not changed.</param>
    /// <param name="driven">Driven coordinates.</param>
    /// <param name="step">Their change along the first step, radians or metres.</param>
    public List<MotionBranch> Find(MechanismState at, ReadOnlySpan<int> driven, ReadOnlySpan<double> step)
    {
        var found = new List<MotionBranch>();
        double size = Size(driven, step);
        if (size == 0)
        {
            return found;
        }

        MechanismState state = at.Clone();
        bool isSingular = _singular.Contains(state);
        Target(at, driven, step, 1);
        if (!isSingular && _newton.Track(state, acceptsDoubleRoot: false))
        {
            Add(found, at, state, driven, step, size);
            return found;
        }

        foreach (double[] start in Starts(at, driven, step))
        {
            state.CopyFrom(at);
            _newton.Motion.Start(state.Poses);
            _newton.Motion.Move(state.Poses, start);
            Target(at, driven, step, 1);
            if (_newton.Close(state) && Change(at, state) < FarthestPose)
            {
                Add(found, at, state, driven, step, size);
            }
        }

        _newton.ClearDriven();
        found.Sort(ByBend);
        return found;
    }

    // Rounded to what the search can tell apart, so that branches alike in all stand in the order of their rates.
    private static int ByBend(MotionBranch a, MotionBranch b)
    {
        int moving = 0;
        double squares = 0;
        int order = 0;
        for (int i = 0; i < a.Rates.Count; i++)
        {
            double rateA = Math.Round(a.Rates[i] / SameRate);
            double rateB = Math.Round(b.Rates[i] / SameRate);
            moving += (rateB != 0 ? 1 : 0) - (rateA != 0 ? 1 : 0);
            squares += rateA * rateA - rateB * rateB;
            order = order != 0 ? order : rateB.CompareTo(rateA);
        }

        int bends = Math.Round(a.Bend / SameBend).CompareTo(Math.Round(b.Bend / SameBend));
        return bends != 0 ? bends : moving != 0 ? moving : squares != 0 ? Math.Sign(squares) : order;
    }

    private double Size(ReadOnlySpan<int> driven, ReadOnlySpan<double> step)
    {
        double size = 0;
        for (int i = 0; i < driven.Length; i++)
        {
            size = Math.Max(size, Math.Abs(step[i]) / Unit(driven[i]));
        }

        return size;
    }

    private void Target(MechanismState at, ReadOnlySpan<int> driven, ReadOnlySpan<double> step, double times)
    {
        _newton.ClearDriven();
        for (int i = 0; i < driven.Length; i++)
        {
            _newton.Drive(driven[i], at.Values[driven[i]] + times * step[i]);
        }
    }

    // Mixtures of the velocities of all blocks that a driven coordinate stands in, as long as the driven step asks for.
    private List<double[]> Starts(MechanismState at, ReadOnlySpan<int> driven, ReadOnlySpan<double> step)
    {
        var space = new VelocitySpace(_mechanism.Linkage, _newton, _blocks, at);
        int first = 0;
        for (int i = 1; i < driven.Length; i++)
        {
            first = Math.Abs(step[i]) / Unit(driven[i]) > Math.Abs(step[first]) / Unit(driven[first]) ? i : first;
        }

        double wanted = step[first] / Unit(driven[first]);
        var vectors = new List<double[]>();
        var rates = new List<double>();
        _newton.Equations.Evaluate(driven[first], at.Poses, at.Values, out ConstraintRow row);
        int joint = _mechanism.Coordinates[driven[first]].Joint;
        foreach (double[] vector in space.Basis)
        {
            vectors.Add(vector);
            rates.Add(_newton.Equations.Rate(joint, row, at.Poses, vector));
        }

        var starts = new List<double[]>();
        foreach (double[] mixture in Mixtures(vectors.Count))
        {
            double rate = 0;
            for (int k = 0; k < mixture.Length; k++)
            {
                rate += mixture[k] * rates[k];
            }

            // At a dead centre the driven coordinate stands still to first order and gives way with the square.
            double length = Math.Abs(rate) > LeastRate ? wanted / rate : Math.Sqrt(Math.Abs(wanted));
            if (Math.Abs(length) > FarthestStart)
            {
                continue;
            }

            var start = new double[_newton.Motion.Linear.Length];
            for (int k = 0; k < mixture.Length; k++)
            {
                for (int i = 0; i < start.Length; i++)
                {
                    start[i] += length * mixture[k] * vectors[k][i];
                }
            }

            starts.Add(start);
        }

        return starts;
    }

    // Unit vectors: all of a line, a circle's, or the axes and as many more as make a sphere dense, the same on every machine.
    private static IEnumerable<double[]> Mixtures(int dimension)
    {
        if (dimension == 2)
        {
            for (int i = 0; i < CirclePoints; i++)
            {
                double angle = 2 * Math.PI * i / CirclePoints;
                yield return new[] { Trigonometry.Cos(angle), Trigonometry.Sin(angle) };
            }

            yield break;
        }

        for (int i = 0; i < 2 * dimension; i++)
        {
            var axis = new double[dimension];
            axis[i / 2] = i % 2 == 0 ? 1 : -1;
            yield return axis;
        }

        uint seed = 1;
        for (int i = 0; dimension > 2 && i < SpherePoints; i++)
        {
            var mixture = new double[dimension];
            double squares = 0;
            for (int k = 0; k < dimension; k++)
            {
                // Linear congruential generator. Source: Knuth, The Art of Computer Programming 2, 3.3.4.
                seed = unchecked((seed * 1664525) + 1013904223);
                mixture[k] = (seed / 2147483648.0) - 1;
                squares += mixture[k] * mixture[k];
            }

            for (int k = 0; k < dimension; k++)
            {
                mixture[k] /= Math.Sqrt(squares);
            }

            yield return mixture;
        }
    }

    private void Add(List<MotionBranch> found, MechanismState at, MechanismState pose, ReadOnlySpan<int> driven, ReadOnlySpan<double> step, double size)
    {
        foreach (MotionBranch other in found)
        {
            if (Change(other.State, pose) < SamePose * size)
            {
                return;
            }
        }

        MechanismState kept = pose.Clone();
        Array.Copy(at.Values, kept.Trail, kept.Trail.Length);
        MechanismCoordinate first = _mechanism.Coordinates[driven[0]];
        double unit = first.ToExternal(kept.Values[driven[0]]) - first.ToExternal(at.Values[driven[0]]);
        var rates = new double[at.Values.Length];
        for (int i = 0; i < rates.Length; i++)
        {
            rates[i] = (kept.Coordinate(i) - at.Coordinate(i)) / unit;
        }

        found.Add(new MotionBranch(kept, rates, Bend(at, pose, driven, step)));
    }

    // A second step as long as the first: what it changes otherwise than the first did.
    private double Bend(MechanismState at, MechanismState pose, ReadOnlySpan<int> driven, ReadOnlySpan<double> step)
    {
        MechanismState further = pose.Clone();
        Target(at, driven, step, 2);
        if (!_newton.Track(further))
        {
            return double.PositiveInfinity;
        }

        double bend = 0;
        double change = 0;
        for (int i = 0; i < at.Values.Length; i++)
        {
            double unit = Unit(i);
            double once = (pose.Values[i] - at.Values[i]) / unit;
            double twice = (further.Values[i] - at.Values[i]) / unit;
            bend += (twice - 2 * once) * (twice - 2 * once);
            change += once * once;
        }

        return Math.Sqrt(bend / change);
    }

    private double Change(MechanismState a, MechanismState b)
    {
        double change = 0;
        for (int i = 0; i < a.Values.Length; i++)
        {
            change = Math.Max(change, Math.Abs(a.Values[i] - b.Values[i]) / Unit(i));
        }

        return change;
    }

    private double Unit(int coordinate) => _mechanism.Coordinates[coordinate].IsAngle ? 1 : _mechanism.Length;
}
