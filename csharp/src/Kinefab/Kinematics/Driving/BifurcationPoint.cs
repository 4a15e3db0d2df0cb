using System;

namespace Kinefab.Kinematics;

/// <summary>
/// The pose at which branches cross, from those before and behind it on the branch travelled. Newton's method finds it to
/// half the digits only, the root being double; the poses around it are regular, and their mean is as good as they are.
/// </summary>
internal sealed class BifurcationPoint
{
    // Radians, or lengths of the mechanism: the mean's own error goes with the fourth power.
    private const double Step = 4e-3;
    private const double LargestChange = 1e-2;
    private const int MaxApproaches = 30;

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly TreeExtrapolation _straight;
    private readonly MechanismState _before;
    private readonly MechanismState _nearBefore;
    private readonly MechanismState _nearBehind;
    private readonly MechanismState _behind;
    private readonly double[] _values;

    public BifurcationPoint(Mechanism mechanism, NewtonSolver newton, TreeExtrapolation straight)
    {
        _mechanism = mechanism;
        _newton = newton;
        _straight = straight;
        _before = mechanism.NewState();
        _nearBefore = mechanism.NewState();
        _nearBehind = mechanism.NewState();
        _behind = mechanism.NewState();
        _values = new double[mechanism.Coordinates.Count];
    }

    /// <summary>Puts a state that Newton's method left near the crossing onto it; unchanged when that is not possible.</summary>
    /// <param name="state">Near the crossing; its trail is set to a pose shortly before.</param>
    /// <param name="from">A regular state on the branch travelled.</param>
    /// <param name="driven">Driven coordinates.</param>
    /// <param name="targets">Their values at the crossing.</param>
    /// <param name="rates">Their changes by length of the way.</param>
    /// <param name="distance">Length of the way between the two.</param>
    public void Refine(MechanismState state, MechanismState from, ReadOnlySpan<int> driven, double[] targets, double[] rates, double distance)
    {
        _before.CopyFrom(from);
        if (!Approach(-distance / Step, -2, driven, targets, rates))
        {
            return;
        }

        _nearBefore.CopyFrom(_before);
        if (!Track(_nearBefore, driven, targets, rates, -1)
            || !Follow(_nearBehind, _nearBefore, _before, 2, driven, targets, rates, 1)
            || !Follow(_behind, _nearBehind, _nearBefore, 0.5, driven, targets, rates, 2))
        {
            return;
        }

        for (int i = 0; i < _values.Length; i++)
        {
            _values[i] = (4 * (_nearBefore.Values[i] + _nearBehind.Values[i]) - (_before.Values[i] + _behind.Values[i])) / 6;
            double unit = _mechanism.Coordinates[i].IsAngle ? 1 : _mechanism.Length;
            if (!(Math.Abs(_values[i] - state.Values[i]) < LargestChange * unit))
            {
                return;
            }
        }

        state.CopyFrom(_nearBefore);
        _straight.Move(state, _values);
        Array.Copy(_nearBefore.Values, state.Trail, state.Trail.Length);
        Array.Copy(_values, state.Values, _values.Length);
        Aim(driven, targets, rates, 0);
        _newton.Assemble(state);
    }

    // Newton's method shrinks from further away the further the crossing is.
    private bool Approach(double at, double end, ReadOnlySpan<int> driven, double[] targets, double[] rates)
    {
        double next = end;
        for (int n = 0; n < MaxApproaches && at != end; n++)
        {
            _nearBefore.CopyFrom(_before);
            if (Track(_nearBefore, driven, targets, rates, next))
            {
                _before.CopyFrom(_nearBefore);
                at = next;
                next = end;
            }
            else
            {
                next = (at + next) / 2;
            }
        }

        return at == end;
    }

    private bool Follow(
        MechanismState next, MechanismState near, MechanismState far, double times, ReadOnlySpan<int> driven, double[] targets, double[] rates, double steps)
    {
        next.CopyFrom(near);
        for (int i = 0; i < _values.Length; i++)
        {
            _values[i] = near.Values[i] + times * (near.Values[i] - far.Values[i]);
        }

        _straight.Move(next, _values);
        return Track(next, driven, targets, rates, steps);
    }

    private bool Track(MechanismState state, ReadOnlySpan<int> driven, double[] targets, double[] rates, double steps)
    {
        Aim(driven, targets, rates, steps);
        return _newton.Track(state, acceptsDoubleRoot: false);
    }

    private void Aim(ReadOnlySpan<int> driven, double[] targets, double[] rates, double steps)
    {
        _newton.ClearDriven();
        for (int i = 0; i < driven.Length; i++)
        {
            _newton.Drive(driven[i], targets[i] + steps * Step * rates[i]);
        }
    }
}
