using System.Collections.Generic;
using Kinefab.Dynamics;

namespace Kinefab.Cli.Simulation;

/// <summary>A run that can be made again, as schemas/recording.schema.json has it: what went in, and the state's hash along the way.</summary>
/// <param name="Scene">SHA-256 of the scene file's bytes, 64 hexadecimal digits.</param>
/// <param name="Solver">Which of the two.</param>
/// <param name="Step">Seconds.</param>
/// <param name="Steps">How many.</param>
/// <param name="Drives">As they were given on the command line.</param>
/// <param name="Every">Steps between two hashes.</param>
/// <param name="Hashes">Of <see cref="World.StateHash"/>: at the start, after every so many steps, and after the last.</param>
internal sealed record RunRecord(string Scene, SolverKind Solver, double Step, int Steps, IReadOnlyList<string> Drives, int Every, IReadOnlyList<ulong> Hashes)
{
    /// <summary>Number of hashes of a run.</summary>
    internal static int Count(int steps, int every) => 1 + (steps + every - 1) / every;

    /// <summary>Whether a hash is taken after a step.</summary>
    internal bool IsHashed(int step) => step % Every == 0 || step == Steps;

    /// <summary>The hash after a step that has one.</summary>
    internal ulong HashAfter(int step) => Hashes[Count(step, Every) - 1];

    /// <summary>The first step that may have made another hash than the one after a step that has one.</summary>
    internal int FirstSince(int step) => step == 0 ? 0 : (step - 1) / Every * Every + 1;
}
