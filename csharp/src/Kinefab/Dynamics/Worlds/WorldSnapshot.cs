using System.Diagnostics;
using System;

namespace Kinefab.Dynamics;

/// <summary>A state of a <see cref="World"/>, whole: what the solver remembers from step to step is part of it.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class WorldSnapshot
{
    internal WorldSnapshot(object owner, double time, StateTape tape)
    {
        Owner = owner;
        Time = time;
        Tape = tape;
    }

    /// <summary>Seconds of the world when it was taken.</summary>
    public double Time { get; }

    internal object Owner { get; }

    internal StateTape Tape { get; }

    /// <summary>state at 1.5 s.</summary>
    public override string ToString() => FormattableString.Invariant($"state at {Time:0.######} s");
}
