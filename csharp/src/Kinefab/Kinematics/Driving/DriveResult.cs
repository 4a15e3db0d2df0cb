using System.Diagnostics;
using System;
using Kinefab.Document;
using Kinefab.Json;

namespace Kinefab.Kinematics;

/// <summary>How a drive or drag ended.</summary>
public enum DriveStatus
{
    /// <summary>At the target.</summary>
    Reached,

    /// <summary>A joint's limit stops it on the way; the state is at the limit.</summary>
    StoppedByLimit,

    /// <summary>No pose is found beyond: a dead point, or out of reach; the state is the last closed one.</summary>
    OutOfReach,

    /// <summary>The joints could not be closed at the start; the state holds the best poses found.</summary>
    NotClosed,
}

/// <summary>A limit of a joint.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct ReachedLimit
{
    internal ReachedLimit(int gameObject, int component, Coordinate coordinate, bool isUpper)
    {
        GameObject = gameObject;
        Component = component;
        Coordinate = coordinate;
        IsUpper = isUpper;
    }

    /// <summary>Index of the GameObject that carries the joint.</summary>
    public int GameObject { get; }

    /// <summary>Index of the joint in its components.</summary>
    public int Component { get; }

    /// <summary>The limited coordinate; of a cone, disc or ball the first one that it limits.</summary>
    public Coordinate Coordinate { get; }

    /// <summary>The upper end of the coordinate's range.</summary>
    public bool IsUpper { get; }

    /// <summary>upper limit of angle of components[1] of object 3.</summary>
    public override string ToString() => FormattableString.Invariant($"{(IsUpper ? "upper" : "lower")} limit of {Coordinate} of components[{Component}] of object {GameObject}");
}

/// <summary>What a drive or drag came to.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct DriveResult
{
    internal DriveResult(DriveStatus status, double fraction, int iterations, double errorMetres, double errorDegrees, int branches, ReachedLimit? limit)
    {
        Status = status;
        Fraction = fraction;
        Iterations = iterations;
        ErrorMetres = errorMetres;
        ErrorDegrees = errorDegrees;
        Branches = branches;
        Limit = limit;
    }

    /// <summary>How it ended.</summary>
    public DriveStatus Status { get; }

    /// <summary>Whether the target was reached.</summary>
    public bool Converged => Status == DriveStatus.Reached;

    /// <summary>Share of the way from the start to the targets that was gone, 0 to 1.</summary>
    public double Fraction { get; }

    /// <summary>Newton iterations in all.</summary>
    public int Iterations { get; }

    /// <summary>Worst distance left in a joint or coupling, metres.</summary>
    public double ErrorMetres { get; }

    /// <summary>Worst angle left in a joint or coupling, degrees.</summary>
    public double ErrorDegrees { get; }

    /// <summary>
    /// How many ways lead on from the start, where that is a pose at which branches of motion meet and nothing travelled so
    /// far tells which to take: the straightest is taken (see <see cref="PositionSolver.Branches"/>). 0 everywhere else.
    /// </summary>
    public int Branches { get; }

    /// <summary>The limit that stopped it, or that it rests against; null: none.</summary>
    public ReachedLimit? Limit { get; }

    /// <summary>StoppedByLimit after 62.5 % of the way, by the upper limit; what is left open in metres and degrees.</summary>
    public override string ToString()
    {
        string way = Converged ? "" : FormattableString.Invariant($" after {100 * Fraction:0.###} % of the way");
        string limit = Limit is ReachedLimit reached ? $", {reached}" : "";
        string branches = Branches > 1 ? FormattableString.Invariant($", the straightest of {Branches} ways") : "";
        return FormattableString.Invariant($"{Status}{way}{limit}{branches}; worst gap {ErrorMetres:0.0e+0} m, {ErrorDegrees:0.0e+0} deg; {Invariant.Counted(Iterations, "iteration")}");
    }
}

/// <summary>A value that a coordinate shall take.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct CoordinateTarget
{
    /// <summary>From parts.</summary>
    /// <param name="coordinate">Index into the mechanism's coordinates.</param>
    /// <param name="value">Degrees or metres.</param>
    public CoordinateTarget(int coordinate, double value)
    {
        Coordinate = coordinate;
        Value = value;
    }

    /// <summary>Index into the mechanism's coordinates.</summary>
    public int Coordinate { get; }

    /// <summary>Degrees or metres.</summary>
    public double Value { get; }

    /// <summary>Coordinate 2 to 90, degrees or metres.</summary>
    public override string ToString() => FormattableString.Invariant($"coordinate {Coordinate} to {Value}");
}
