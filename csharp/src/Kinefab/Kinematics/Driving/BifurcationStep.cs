using System;

namespace Kinefab.Kinematics;

/// <summary>
/// Passes a pose where branches of motion cross, such as a parallelogram lying flat. Newton's method cannot tell the
/// branches apart there, the way travelled so far can: it is continued in a straight line over the coordinates of the
/// tree's joints, and Newton's method only mends what little is off on the other side.
/// </summary>
internal sealed class BifurcationStep
{
    // Radians, or lengths of the mechanism.
    private static readonly double[] Sizes = { 0.01, 0.03, 0.1 };
    private const double LeastTrail = 1e-8;
    private const double LargestCorrection = 0.2;

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly MechanismState _start;
    private readonly MechanismState _predicted;
    private readonly TreeExtrapolation _straight;
    private readonly double[] _values;

    public BifurcationStep(Mechanism mechanism, NewtonSolver newton, TreeExtrapolation straight)
    {
        _mechanism = mechanism;
        _newton = newton;
        _start = mechanism.NewState();
        _predicted = mechanism.NewState();
        _straight = straight;
        _values = new double[mechanism.Coordinates.Count];
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
            for (int i = 0; i < _values.Length; i++)
            {
                _values[i] = _start.Values[i] + factor * (_start.Values[i] - _start.Trail[i]);
            }

            double moved = _straight.Move(state, _values);
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

    /// <summary>Moves a state along a share of the straight way to another one.</summary>
    /// <param name="state">Unchanged on false.</param>
    /// <param name="towards">On the branch to follow.</param>
    /// <param name="share">0 to 1.</param>
    /// <param name="driven">Driven coordinates.</param>
    /// <param name="targets">Their values there.</param>
    public bool TryAlong(MechanismState state, MechanismState towards, double share, ReadOnlySpan<int> driven, double[] targets)
    {
        _start.CopyFrom(state);
        for (int i = 0; i < _values.Length; i++)
        {
            _values[i] = state.Values[i] + share * (towards.Values[i] - state.Values[i]);
        }

        double moved = _straight.Move(state, _values);
        _predicted.CopyFrom(state);
        _newton.ClearDriven();
        for (int i = 0; i < driven.Length; i++)
        {
            _newton.Drive(driven[i], targets[i]);
        }

        if (_newton.Track(state) && Correction(state) <= LargestCorrection * moved)
        {
            return true;
        }

        state.CopyFrom(_start);
        return false;
    }

    /// <summary>Whether the driven coordinates have moved on the way here.</summary>
    public static bool HasTrail(MechanismState state, ReadOnlySpan<int> driven)
    {
        foreach (int coordinate in driven)
        {
            if (Math.Abs(state.Values[coordinate] - state.Trail[coordinate]) > LeastTrail)
            {
                return true;
            }
        }

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
