using System;
using System.Collections.Generic;
using System.Diagnostics;
using Kinefab.Json;
using Kinefab.Numerics;

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
[DebuggerDisplay("{ToString(),nq}")]
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

    /// <summary>80 (upper limit of angle); the unit is the coordinate's, degrees or metres.</summary>
    public override string ToString() => FormattableString.Invariant($"{Value:0.######} ({(Limit is ReachedLimit limit ? limit.ToString() : Word)})");

    private string Word => End switch
    {
        RangeEnd.Open => "open",
        RangeEnd.Limit => "limit",
        RangeEnd.Fold => "dead centre",
        RangeEnd.Bifurcation => "branches cross",
        _ => "no pose found beyond",
    };
}

/// <summary>A swept coordinate: the states on the way, and how far it went.</summary>
[DebuggerDisplay("{ToString(),nq}")]
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

    /// <summary>A coordinate in every state: degrees (over any number of turns) or metres, zero at the exported pose.</summary>
    /// <param name="coordinate">Such as Slide or Lever/Crank:1.angle, see <see cref="Mechanism.TryFindCoordinate"/>.</param>
    /// <exception cref="ArgumentException">None answers to the name, or several do: the message says which there are.</exception>
    public IReadOnlyList<double> this[string coordinate]
    {
        get
        {
            int index = States[0].Mechanism.CoordinateNamed(coordinate);
            var column = new double[States.Count];
            for (int i = 0; i < column.Length; i++)
                column[i] = States[i].Coordinate(index);
            return column;
        }
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

    /// <summary>Where a GameObject stands in one of the states; Unity's frame, metres.</summary>
    /// <param name="idOrName">Its id, or a name that no other has: Lever/BarC:1 or BarC:1.</param>
    /// <param name="state">Index into <see cref="States"/>.</param>
    /// <returns>Unity's left-handed frame, metres.</returns>
    /// <exception cref="ArgumentException">None has it, or several have the name: the message says which there are.</exception>
    /// <exception cref="ArgumentOutOfRangeException">There is no such state.</exception>
    public Pose Pose(string idOrName, int state) => (uint)state < (uint)States.Count
        ? States[state].Pose(idOrName)
        : throw new ArgumentOutOfRangeException(nameof(state), $"The sweep has {States.Count} states.");

    /// <summary>Lever/Crank:1.angle 0 to 360 deg in 72 steps; and what stopped it.</summary>
    public override string ToString()
    {
        MechanismCoordinate driven = States[0].Mechanism.Coordinates[Coordinate];
        string stop = Stop is RangeLimit limit ? FormattableString.Invariant($", stopped at {limit} {driven.Unit}") : "";
        string jumps = Jumps.Count > 0 ? FormattableString.Invariant($", on another branch from {Jumps[0]:0.######} {driven.Unit} on") : "";
        return FormattableString.Invariant($"{driven.Name} {Values[0]:0.######} to {Values[Values.Count - 1]:0.######} {driven.Unit} in {Invariant.Counted(States.Count - 1, "step")}{stop}{jumps}; worst gap {WorstErrorMetres:0.0e+0} m, {WorstErrorDegrees:0.0e+0} deg");
    }
}
