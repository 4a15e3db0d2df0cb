using System;
using Kinefab.Joints;

namespace Kinefab.Kinematics;

/// <summary>
/// Passes a pose where branches of motion cross, such as a parallelogram lying flat. Newton's method cannot tell the
/// branches apart there, the way travelled so far can: it is continued in a straight line over the coordinates of the
/// tree's joints, and Newton's method only mends what little is off on the other side.
/// </summary>
internal sealed class BranchLeap
{
    // Radians, or lengths of the mechanism.
    private static readonly double[] Sizes = { 0.01, 0.03, 0.1 };
    private const double LeastTrail = 1e-7;
    private const double LargestCorrection = 0.2;

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly MechanismState _start;
    private readonly MechanismState _predicted;
    private readonly double[] _step;

    public BranchLeap(Mechanism mechanism, NewtonSolver newton)
    {
        _mechanism = mechanism;
        _newton = newton;
        _start = mechanism.NewState();
        _predicted = mechanism.NewState();
        _step = new double[newton.Motion.Linear.Length];
    }

    /// <summary>Moves the state from s over a crossing; false when there is none or nothing tells the way.</summary>
    /// <param name="state">At s; unchanged on false.</param>
    /// <param name="driven">Driven coordinates.</param>
    /// <param name="from">Their values at s = 0.</param>
    /// <param name="to">Their values at s = 1.</param>
    /// <param name="s">Where on the way.</param>
    /// <param name="way">Length of the way.</param>
    /// <param name="reached">The new s.</param>
    public bool TryOver(MechanismState state, ReadOnlySpan<int> driven, double[] from, double[] to, double s, double way, out double reached)
    {
        reached = s;
        _start.CopyFrom(state);
        foreach (double size in Sizes)
        {
            double next = Math.Min(1, s + size / way);
            if (Factor(driven, from, to, next - s) is not double factor)
            {
                return false;
            }

            state.CopyFrom(_start);
            double moved = Predict(state, factor);
            _predicted.CopyFrom(state);
            _newton.ClearDriven();
            for (int i = 0; i < driven.Length; i++)
            {
                _newton.Drive(driven[i], from[i] + next * (to[i] - from[i]));
            }

            if (_newton.Track(state) && Correction(state) <= LargestCorrection * moved)
            {
                reached = next;
                return true;
            }
        }

        state.CopyFrom(_start);
        return false;
    }

    // How many times the last step the new one is, by the driven coordinate that moved most in it.
    private double? Factor(ReadOnlySpan<int> driven, double[] from, double[] to, double share)
    {
        double most = LeastTrail;
        double? factor = null;
        for (int i = 0; i < driven.Length; i++)
        {
            double moved = _start.Values[driven[i]] - _start.Trail[driven[i]];
            if (Math.Abs(moved) > most)
            {
                most = Math.Abs(moved);
                factor = share * (to[i] - from[i]) / moved;
            }
        }

        return factor;
    }

    // Each freedom of a tree joint is moved by what its coordinate shall change; the largest such change is returned.
    private double Predict(MechanismState state, double factor)
    {
        Array.Clear(_step, 0, _step.Length);
        _newton.Motion.Start(state.Poses);
        double largest = 0;
        int place = 0;
        for (int i = 0; i < state.Values.Length; i++)
        {
            MechanismCoordinate coordinate = _mechanism.Coordinates[i];
            place = i > 0 && _mechanism.Coordinates[i - 1].Joint == coordinate.Joint ? place + 1 : 0;
            int body = _mechanism.Tree.ChildOf[coordinate.Joint];
            if (body < 0 || coordinate.IsLocked)
            {
                continue;
            }

            double unit = coordinate.IsAngle ? 1 : _mechanism.Length;
            double change = factor * (state.Values[i] - state.Trail[i]) / unit;
            // The coordinate is of actor 1 against actor 0 or the reverse; the freedom is of the child against its parent.
            bool same = coordinate.IsAlongRows != _mechanism.Tree.ChildIsBody0[body];
            _step[_newton.Firsts[body] + place] = same ? change : -change;
            largest = Math.Max(largest, Math.Abs(change));
        }

        _newton.Motion.Move(state.Poses, _step);
        for (int i = 0; i < state.Values.Length; i++)
        {
            _newton.Equations.Evaluate(i, state.Poses, state.Values, out ConstraintRow _);
        }

        return largest;
    }

    private double Correction(MechanismState state)
    {
        double largest = 0;
        for (int i = 0; i < state.Values.Length; i++)
        {
            MechanismCoordinate coordinate = _mechanism.Coordinates[i];
            if (_mechanism.Tree.ChildOf[coordinate.Joint] >= 0)
            {
                double unit = coordinate.IsAngle ? 1 : _mechanism.Length;
                largest = Math.Max(largest, Math.Abs(state.Values[i] - _predicted.Values[i]) / unit);
            }
        }

        return largest;
    }
}
