using System;
using System.Collections.Generic;
using System.Globalization;
using Kinefab.Diagnostics;
using Kinefab.Dynamics;

namespace Kinefab.Cli.Simulation;

/// <summary>The state's hashes of a run: kept, and held against a recording's where there is one.</summary>
internal sealed class StateHashes
{
    private readonly World world;
    private readonly RunRecord plan;
    private readonly bool isReplay;
    private readonly List<ulong> hashes = [];
    private int step = -1;

    // Where the state was first another than the recording's, after the step At (0: the start), and the first step that may have made it so.
    private (int From, int At)? difference;

    /// <summary>Of a run as planned; in a replay the plan has the hashes.</summary>
    internal StateHashes(World world, RunRecord plan, bool isReplay)
    {
        this.world = world;
        this.plan = plan;
        this.isReplay = isReplay;
    }

    /// <summary>The plan with the hashes of this run.</summary>
    internal RunRecord Made => plan with { Hashes = hashes };

    /// <summary>Takes note of the start, then of each step done.</summary>
    internal void Note()
    {
        step++;
        if (!plan.IsHashed(step))
            return;
        ulong hash = world.StateHash();
        if (!isReplay)
            hashes.Add(hash);
        else if (difference is null && hash != plan.HashAfter(step))
            difference = (plan.FirstSince(step), step);
    }

    /// <summary>What a replay came to.</summary>
    internal Report Findings(string path)
    {
        if (difference is not (int from, int at))
            return Report.Empty;
        string where = at == 0 ? "The start" : from == at ? Text($"Step {at} ({at * plan.Step:0.######} s)") : Text($"One of the steps {from} to {at} ({at * plan.Step:0.######} s)");
        return new Report([Diagnostic.Of(DiagnosticCodes.RecordingDiffers, "", ("where", where), ("path", path))]);
    }

    private static string Text(FormattableString text) => text.ToString(CultureInfo.InvariantCulture);
}
