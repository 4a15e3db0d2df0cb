using System;
using System.Collections.Generic;
using System.Diagnostics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>What stops a driven coordinate where no limit does.</summary>
public enum DeadPointKind
{
    /// <summary>The coordinate turns back: its range ends here (a dead centre).</summary>
    Fold,

    /// <summary>Branches of motion cross: the joints alone lose a rank (a change point).</summary>
    Bifurcation,
}

/// <summary>A pose that a driven coordinate cannot simply pass.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct DeadPoint
{
    internal DeadPoint(DeadPointKind kind, double value)
    {
        Kind = kind;
        Value = value;
    }

    /// <summary>What it is.</summary>
    public DeadPointKind Kind { get; }

    /// <summary>Of the driven coordinate, degrees or metres.</summary>
    public double Value { get; }

    /// <summary>Fold at 90, degrees or metres.</summary>
    public override string ToString() => FormattableString.Invariant($"{Kind} at {Value:0.######}");
}

/// <summary>
/// Finds the pose at which a driven coordinate stops, from a closed pose shortly before it. The tree freedom that moves
/// fastest there is the parameter instead of the driven coordinate q, so that the pose is a regular one; at a fold dq over
/// the parameter passes through zero, and that zero is bisected. Source: Rheinboldt 1980, local parameters.
/// </summary>
internal sealed class DeadPointSearch
{
    private const double Step = 0.01;
    private const int MaxMarch = 300;
    private const int MaxBisections = 80;
    private const int MaxCorrections = 20;
    private const double Damping = 1e-11;

    // Of the driven coordinate, asked to move at 1.
    private const double LeastRate = 0.99;

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly RankDeficiency _singular;
    private readonly MechanismState _here;
    private readonly MechanismState _base;

    public DeadPointSearch(Mechanism mechanism, NewtonSolver newton, RankDeficiency singular)
    {
        _mechanism = mechanism;
        _newton = newton;
        _singular = singular;
        _here = mechanism.NewState();
        _base = mechanism.NewState();
    }

    /// <summary>The dead point ahead of a state; null when the coordinate goes on from here or nothing was found.</summary>
    /// <param name="state">Closed; not changed.</param>
    /// <param name="coordinate">The driven one.</param>
    /// <param name="direction">+1 or -1: which way it was driven.</param>
    public DeadPoint? Find(MechanismState state, int coordinate, double direction)
    {
        _here.CopyFrom(state);
        if (StandsStill(coordinate, direction))
        {
            return new DeadPoint(_singular.Contains(state) ? DeadPointKind.Bifurcation : DeadPointKind.Fold, state.Coordinate(coordinate));
        }

        int freedom = Fastest(coordinate, direction, out int joint, out double sense);
        if (freedom < 0)
        {
            return null;
        }

        double rate = Rate(coordinate, joint, freedom) * direction * sense;
        for (int n = 0; n < MaxMarch && rate > 0; n++)
        {
            _base.CopyFrom(_here);
            if (!Advance(joint, freedom, sense * Step))
            {
                return Singular(state, coordinate);
            }

            double next = Rate(coordinate, joint, freedom) * direction * sense;
            if (next <= 0)
            {
                return Bisect(coordinate, joint, freedom, sense, direction, rate, next);
            }

            rate = next;
        }

        return Singular(state, coordinate);
    }

    private DeadPoint Bisect(int coordinate, int joint, int freedom, double sense, double direction, double rateInside, double rateOutside)
    {
        double inside = 0;
        double outside = Step;
        for (int n = 0; n < MaxBisections && outside - inside > 1e-15; n++)
        {
            // False position would creep at the ends; its guess is kept off them.
            double share = Math.Min(0.95, Math.Max(0.05, rateInside / (rateInside - rateOutside)));
            double middle = inside + (outside - inside) * share;
            _here.CopyFrom(_base);
            if (!Advance(joint, freedom, sense * middle))
            {
                break;
            }

            double rate = Rate(coordinate, joint, freedom) * direction * sense;
            if (rate > 0)
            {
                (inside, rateInside) = (middle, rate);
            }
            else
            {
                (outside, rateOutside) = (middle, rate);
            }

            if (Math.Abs(rate) < 1e-12)
            {
                break;
            }
        }

        DeadPointKind kind = _singular.Contains(_here) ? DeadPointKind.Bifurcation : DeadPointKind.Fold;
        return new DeadPoint(kind, _here.Coordinate(coordinate));
    }

    // Nothing turned back: either the joints lose a rank here, or there is no dead point.
    private DeadPoint? Singular(MechanismState state, int coordinate)
    {
        double[] values = Values(state).Values;
        for (int i = 1; i < values.Length; i++)
        {
            double share = values[i] / values[0];
            if (share > 1e-9 && share < 1e-3)
            {
                return new DeadPoint(DeadPointKind.Bifurcation, state.Coordinate(coordinate));
            }
        }

        return null;
    }

    private SingularValues Values(MechanismState state)
    {
        _newton.ClearDriven();
        _newton.Motion.Start(state.Poses);
        return new SingularValues(_newton.Rows(state).Matrix(_newton.Motion.Linear.Length));
    }

    // At a dead centre the rest of the mechanism moves and the joints do not let the driven coordinate follow; the damping
    // decides how near one is at one: 1e-9 rad of the driven coordinate.
    private bool StandsStill(int coordinate, double direction)
    {
        double[] step = Tangent(coordinate, direction);
        _newton.Equations.Evaluate(coordinate, _here.Poses, _here.Values, out ConstraintRow row);
        return Math.Abs(_newton.Equations.Rate(_mechanism.Coordinates[coordinate].Joint, row, _here.Poses, step)) < LeastRate;
    }

    // The freedom of a tree joint that moves fastest when q does, and its sense.
    private int Fastest(int coordinate, double direction, out int joint, out double sense)
    {
        double[] step = Tangent(coordinate, direction);
        int fastest = -1;
        joint = -1;
        foreach (int body in _mechanism.Tree.Order)
        {
            for (int i = 0; i < _mechanism.Tree.Freedoms[body] && _mechanism.Tree.TreeJoints[body] >= 0; i++)
            {
                int freedom = _newton.Firsts[body] + i;
                if (fastest < 0 || Math.Abs(step[freedom]) > Math.Abs(step[fastest]))
                {
                    fastest = freedom;
                    joint = _mechanism.Tree.TreeJoints[body];
                }
            }
        }

        sense = fastest >= 0 && step[fastest] < 0 ? -1 : 1;
        return fastest;
    }

    private double[] Tangent(int coordinate, double direction)
    {
        _newton.ClearDriven();
        double unit = _mechanism.Coordinates[coordinate].IsAngle ? 1 : _mechanism.Length;
        _newton.Drive(coordinate, _here.Values[coordinate] + direction * unit);
        _newton.Motion.Start(_here.Poses);
        _newton.Assemble(_here);
        return _newton.SolveStep(Damping);
    }

    // dq over the parameter, q in radians or lengths.
    private double Rate(int coordinate, int joint, int freedom)
    {
        _newton.ClearDriven();
        _newton.Motion.Start(_here.Poses);
        _newton.Assemble(_here);
        _newton.Equations.AddFreedom(joint, freedom - _newton.Firsts[_mechanism.Tree.ChildOf[joint]], -1);
        double[] step = _newton.SolveStep(Damping);
        _newton.Equations.Evaluate(coordinate, _here.Poses, _here.Values, out ConstraintRow row);
        return _newton.Equations.Rate(_mechanism.Coordinates[coordinate].Joint, row, _here.Poses, step);
    }

    private bool Advance(int joint, int freedom, double amount)
    {
        _newton.ClearDriven();
        _newton.Motion.Start(_here.Poses);
        double gone = 0;
        int place = freedom - _newton.Firsts[_mechanism.Tree.ChildOf[joint]];
        for (int n = 0; n < MaxCorrections; n++)
        {
            _newton.Iterations++;
            _newton.Assemble(_here);
            _newton.Equations.AddFreedom(joint, place, gone - amount);
            double[] step = _newton.SolveStep(Damping);
            double size = 0;
            foreach (double entry in step)
            {
                size = Math.Max(size, Math.Abs(entry));
            }

            if (!(size < 0.5))
            {
                return false;
            }

            if (size < 1e-13)
            {
                break;
            }

            gone += step[freedom];
            _newton.Motion.Move(_here.Poses, step);
        }

        _newton.Assemble(_here);
        for (int i = 0; i < _here.Values.Length; i++)
        {
            _newton.Equations.Evaluate(i, _here.Poses, _here.Values, out _);
        }

        return _newton.Equations.Worst <= _newton.Accepted;
    }
}
