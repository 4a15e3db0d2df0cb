namespace Kinefab.Dynamics.Rattle;

/// <summary>What keeps a drive without limit of force from its speed.</summary>
internal struct DriveStall
{
    /// <summary>Whether the joints hold it, alone or with other such drives: see <see cref="HeldDrives"/>.</summary>
    public bool IsHeld;

    /// <summary>Whether it is one of those other drives.</summary>
    public bool IsOpposing;

    /// <summary>Whether it gave, in the last piece of a part, all that <see cref="ScalarRow.BoundForce"/> leaves it.</summary>
    public bool IsStalled;
}
