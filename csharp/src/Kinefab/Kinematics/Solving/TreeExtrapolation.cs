using System;
using Kinefab.Joints;

namespace Kinefab.Kinematics;

/// <summary>Moves a state in a straight line over the coordinates of the tree's joints, without closing the loops.</summary>
internal sealed class TreeExtrapolation
{
    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly double[] _step;

    public TreeExtrapolation(Mechanism mechanism, NewtonSolver newton)
    {
        _mechanism = mechanism;
        _newton = newton;
        _step = new double[newton.Motion.Linear.Length];
    }

    /// <summary>Each freedom of a tree joint is moved by what its coordinate shall change; the largest such change is returned.</summary>
    /// <param name="state">Moved; its coordinates are read anew.</param>
    /// <param name="values">For each coordinate where it shall go; those of closing joints do not matter.</param>
    public double Move(MechanismState state, double[] values)
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
            double change = (values[i] - state.Values[i]) / unit;
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
}
