using System;
using System.Collections.Generic;
using System.Diagnostics;
using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Dynamics;

/// <summary>What <see cref="World.Run"/> kept: columns over the times at its start and after each of its steps.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class RunResult
{
    private readonly string[] _names;
    private readonly string[] _fullNames;
    private readonly List<double>[] _columns;

    internal RunResult(List<double> times, string[] names, List<double>[] columns, string[] fullNames, bool hasEnded, int stops, Report findings)
    {
        Times = times;
        _names = names;
        _columns = columns;
        _fullNames = fullNames;
        HasEnded = hasEnded;
        Stops = stops;
        Findings = findings;
    }

    /// <summary>A coordinate that was recorded: degrees (over any number of turns) or metres, one for each of <see cref="Times"/>.</summary>
    /// <param name="name">As it was asked for, or in full: Lever/Crank:1.angle.</param>
    /// <exception cref="ArgumentException">It was not recorded; the message says what was.</exception>
    public IReadOnlyList<double> this[string name]
    {
        get
        {
            int found = Array.IndexOf(_names, name ?? throw new ArgumentNullException(nameof(name)));
            if (found < 0)
                found = Array.FindIndex(_fullNames, full => string.Equals(full, name, StringComparison.OrdinalIgnoreCase));
            return found >= 0
                ? _columns[found]
                : throw new ArgumentException($"{name} was not recorded; {(_names.Length == 0 ? "nothing was" : "recorded: " + string.Join(", ", _names))}.", nameof(name));
        }
    }

    /// <summary>Seconds of the world: one more than there were steps.</summary>
    public IReadOnlyList<double> Times { get; }

    /// <summary>What was recorded, by the names that were asked for.</summary>
    public IReadOnlyList<string> Recorded => _names;

    /// <summary>Whether what it should run until has happened, so that it ended early or with its last step.</summary>
    public bool HasEnded { get; }

    /// <summary>How often motion was stopped in the run, see <see cref="World.Stops"/>; 0 unless the solver could not follow.</summary>
    public int Stops { get; }

    /// <summary>What was found in the run alone, see <see cref="World.Findings"/>.</summary>
    public Report Findings { get; }

    /// <summary>500 steps to 10 s, and the last of every column.</summary>
    public override string ToString()
    {
        string ended = HasEnded ? ", ended early" : "";
        string stops = Stops > 0 ? ", " + Invariant.Counted(Stops, "stop") : "";
        string last = "";
        for (int i = 0; i < _names.Length; i++)
            last += FormattableString.Invariant($"; {_names[i]} {_columns[i][_columns[i].Count - 1]:0.######}");
        return FormattableString.Invariant($"{Invariant.Counted(Times.Count - 1, "step")} to {Times[Times.Count - 1]:0.######} s{ended}{stops}{last}");
    }
}
