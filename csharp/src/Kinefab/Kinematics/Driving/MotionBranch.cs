using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Linq;

namespace Kinefab.Kinematics;

/// <summary>One of the ways that lead on from a pose, as a small step along it.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class MotionBranch
{
    internal MotionBranch(MechanismState state, IReadOnlyList<double> rates, double bend)
    {
        State = state;
        Rates = rates;
        Bend = bend;
    }

    /// <summary>
    /// A closed pose a little way along the branch. Copied into a state, drives from there keep to the branch.
    /// </summary>
    public MechanismState State { get; }

    /// <summary>For each of the mechanism's coordinates its change by unit of the driven one; degrees and metres.</summary>
    public IReadOnlyList<double> Rates { get; }

    /// <summary>The rates of all coordinates by unit of the driven one, in degrees and metres.</summary>
    public override string ToString() =>
        string.Join(", ", Rates.Select((rate, i) => FormattableString.Invariant($"{State.Mechanism.Coordinates[i].Name} {rate:+0.###;-0.###;0}")));

    /// <summary>How far the second half of twice the step leaves the straight line through the first, as a share of it.</summary>
    internal double Bend { get; }
}
