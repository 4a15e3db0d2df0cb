using System.Collections.Generic;

namespace Kinefab.Kinematics;

/// <summary>Why a driven coordinate goes no further.</summary>
public enum RangeEnd
{
    /// <summary>It does: a whole turn, or as far as was looked.</summary>
    Open,

    /// <summary>A joint's limit.</summary>
    Limit,

    /// <summary>A dead centre: the coordinate turns back.</summary>
    Fold,

    /// <summary>Branches of motion cross and none could be told for the right one.</summary>
    Bifurcation,

    /// <summary>No pose was found, for no reason that was found.</summary>
    Unknown,
}

/// <summary>One end of a coordinate's true range.</summary>
public readonly struct RangeLimit
{
    internal RangeLimit(RangeEnd end, double value, ReachedLimit? limit)
    {
        End = end;
        Value = value;
        Limit = limit;
    }

    /// <summary>What ends it.</summary>
    public RangeEnd End { get; }

    /// <summary>Degrees or metres.</summary>
    public double Value { get; }

    /// <summary>The limit, where one ends it.</summary>
    public ReachedLimit? Limit { get; }
}

/// <summary>A swept coordinate: the states on the way, and how far it went.</summary>
public sealed class SweepResult
{
    internal SweepResult(int coordinate, List<double> values, List<MechanismState> states, List<double> jumps, IReadOnlyList<MotionBranch> branches, RangeLimit? stop, double worstMetres, double worstDegrees)
    {
        Coordinate = coordinate;
        Values = values;
        States = states;
        Jumps = jumps;
        Branches = branches;
        Stop = stop;
        WorstErrorMetres = worstMetres;
        WorstErrorDegrees = worstDegrees;
    }

    /// <summary>Index of the driven coordinate.</summary>
    public int Coordinate { get; }

    /// <summary>Its value in each state, degrees or metres.</summary>
    public IReadOnlyList<double> Values { get; }

    /// <summary>One for each value.</summary>
    public IReadOnlyList<MechanismState> States { get; }

    /// <summary>Values at which the mechanism came to another branch: driven back, it did not come where it had been.</summary>
    public IReadOnlyList<double> Jumps { get; }

    /// <summary>
    /// The ways that led on from the start, where that is a pose at which branches of motion meet; the first was taken.
    /// Empty elsewhere.
    /// </summary>
    public IReadOnlyList<MotionBranch> Branches { get; }

    /// <summary>What stopped the sweep early; null when it went all the way.</summary>
    public RangeLimit? Stop { get; }

    /// <summary>Worst distance left in any joint in any state, metres.</summary>
    public double WorstErrorMetres { get; }

    /// <summary>Worst angle left in any joint in any state, degrees.</summary>
    public double WorstErrorDegrees { get; }
}
