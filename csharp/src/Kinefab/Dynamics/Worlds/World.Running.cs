using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Linq;
using System.Threading;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Dynamics;

/// <content>Many steps in one call.</content>
public sealed partial class World
{
    private const double MostSteps = 100_000_000;

    // Of a step after which the next one is such that it can be cancelled, which costs it what a snapshot does. What comes out is the same.
    private static readonly TimeSpan LongStep = TimeSpan.FromSeconds(0.1);

    /// <summary>Steps on for a time, or until something happens, and keeps what it is asked to.</summary>
    /// <param name="seconds">How long at most; rounded to whole steps, one at least.</param>
    /// <param name="until">Ends the run when true; asked after every step. Null: it runs to its end.</param>
    /// <param name="record">Joint coordinates to keep at the start and after every step, named as in <see cref="this[string]"/>; null: none.</param>
    /// <param name="step">Seconds; null: the scene's fixedTimestep.</param>
    /// <param name="progress">Told the number of steps done after each; null: nobody is.</param>
    /// <param name="cancellation">Ends the run early, amid the first step or one after a step of a tenth of a second or longer too; the world then stands after some step.</param>
    /// <returns>What was kept. What the mechanism did, broken joints and a solver that could not follow among it, is no error.</returns>
    /// <exception cref="ArgumentException">A name answers to no coordinate, or to several (the message says which there are); or a time is no positive finite number.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    /// <example><code>
    /// world.DriveAt("Shaft", 60);
    /// RunResult run = world.Run(10, until: w => w["Slide"] > 0.04, record: new[] { "Shaft", "Slide" });
    /// Console.WriteLine($"{run.Times[^1]} s: {run["Slide"][^1]} m");
    /// </code></example>
    public RunResult Run(double seconds, Func<World, bool>? until = null, IEnumerable<string>? record = null, double? step = null, IProgress<int>? progress = null, CancellationToken cancellation = default)
    {
        double dt = step ?? Scene.Document.Physics.FixedTimestep;
        if (!(dt > 0 && Finite.Is(dt)))
            throw new ArgumentOutOfRangeException(nameof(step), "Not a positive finite number.");
        double count = Math.Max(1, Math.Round(seconds / dt));
        if (!(seconds > 0 && count <= MostSteps))
            throw new ArgumentOutOfRangeException(nameof(seconds), FormattableString.Invariant($"Not a positive number of seconds, or more than {MostSteps} steps."));
        string[] names = record?.ToArray() ?? Array.Empty<string>();
        (WorldJoint Joint, Coordinate Coordinate)[] recorded = Array.ConvertAll(names, Named);
        var times = new List<double> { Time };
        List<double>[] columns = Array.ConvertAll(recorded, c => new List<double> { c.Joint.Coordinate(c.Coordinate) });
        int stops = Stops;
        int said = Findings.Diagnostics.Count;
        bool hasEnded = false;
        bool isLong = true;
        var watch = new Stopwatch();
        for (int i = 1; i <= count && !hasEnded; i++)
        {
            cancellation.ThrowIfCancellationRequested();
            watch.Restart();
            Step(dt, isLong ? cancellation : default);
            isLong = watch.Elapsed > LongStep;
            times.Add(Time);
            for (int c = 0; c < columns.Length; c++)
                columns[c].Add(recorded[c].Joint.Coordinate(recorded[c].Coordinate));
            hasEnded = until?.Invoke(this) == true;
            progress?.Report(i);
        }

        Report findings = Findings.Diagnostics.Count == said ? Report.Empty : new Report(Findings.Diagnostics.Skip(said).ToArray());
        return new RunResult(times, names, columns, Array.ConvertAll(recorded, c => $"{c.Joint.Name}.{c.Coordinate}"), hasEnded, Stops - stops, findings);
    }
}
