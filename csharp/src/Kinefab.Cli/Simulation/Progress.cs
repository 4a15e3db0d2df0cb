using System;

namespace Kinefab.Cli.Simulation;

/// <summary>Says on stderr how far a run is, in tenths; silent when nobody watches or the run is short.</summary>
internal sealed class Progress
{
    private const int Parts = 10;
    private const long Worthwhile = 1000;

    private readonly long steps;
    private long told;

    internal Progress(long steps) => this.steps = steps;

    internal void Report(long step)
    {
        long part = step * Parts / steps;
        if (part == told || steps < Worthwhile || Console.IsErrorRedirected)
            return;
        told = part;
        Console.Error.WriteLine($"{part * 100 / Parts} %");
    }
}
