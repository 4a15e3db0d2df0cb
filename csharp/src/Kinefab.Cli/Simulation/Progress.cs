using System;
using System.Globalization;
using System.IO;

namespace Kinefab.Cli.Simulation;

/// <summary>Says on a terminal how far a run is: one line, renewed each second; silent when nobody watches or the run is short.</summary>
internal sealed class Progress : IProgress<int>
{
    private readonly int steps;
    private readonly TextWriter? target;
    private readonly TimeProvider clock;
    private long last;
    private bool isShown;

    internal Progress(int steps)
        : this(steps, Console.IsErrorRedirected ? null : Console.Error, TimeProvider.System)
    {
    }

    /// <summary>With a target and a clock of the caller's; without a target it is silent.</summary>
    internal Progress(int steps, TextWriter? target, TimeProvider clock)
    {
        this.steps = steps;
        this.target = target;
        this.clock = clock;
        last = clock.GetTimestamp();
    }

    public void Report(int value)
    {
        if (target is null || clock.GetElapsedTime(last) < TimeSpan.FromSeconds(1))
            return;
        last = clock.GetTimestamp();
        isShown = true;
        target.Write(string.Create(CultureInfo.InvariantCulture, $"\r{100L * value / steps,3} % of {steps} steps"));
    }

    /// <summary>Gives the line to what comes next.</summary>
    internal void End()
    {
        if (isShown)
            target!.WriteLine();
    }
}
