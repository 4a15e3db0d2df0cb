namespace Kinefab.Dynamics.Rattle;

/// <summary>How well an island's loops close along their motion.</summary>
internal enum LoopConsistency : byte
{
    /// <summary>As far as motion shows, or there is none.</summary>
    Exact,

    /// <summary>Axes are off by what files may round: held as hard as an exact loop's they would brake the motion.</summary>
    Rounded,

    /// <summary>Axes are off by so much that closing the loop to the letter would lock it.</summary>
    Inconsistent,
}

/// <summary>The joints of an island with a loop that is not exact, as indices into the mechanism's.</summary>
internal readonly struct InconsistentLoop
{
    public readonly int[] Joints;
    public readonly LoopConsistency Consistency;

    public InconsistentLoop(int[] joints, LoopConsistency consistency)
    {
        Joints = joints;
        Consistency = consistency;
    }
}
