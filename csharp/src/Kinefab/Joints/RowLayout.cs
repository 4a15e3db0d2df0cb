namespace Kinefab.Joints;

/// <summary>
/// Which rows a joint may ever have, at whatever pose: what <see cref="JointModel.Prepare"/> writes at most. Axes are bits as in
/// <see cref="CoordinateAxis"/>: frame 0's X, Y, Z, then twist and the two swings.
/// </summary>
internal readonly struct RowLayout
{
    private const int Angular = 0b111000;
    private const int Swings = 0b110000;

    public RowLayout(int locked, int limited, int linearDrives, int angularDrives, bool isSlerp)
    {
        Locked = locked;
        Limited = limited;
        LinearDrives = linearDrives;
        AngularDrives = angularDrives;
        IsSlerp = isSlerp;
    }

    /// <summary>Axes that are held: one rigid row each.</summary>
    public int Locked { get; }

    /// <summary>Axes with a limit.</summary>
    public int Limited { get; }

    /// <summary>Rows of drives, which stand before all others: the linear ones first.</summary>
    public int LinearDrives { get; }

    public int AngularDrives { get; }

    /// <summary>The angular drives are the slerp drive's three.</summary>
    public bool IsSlerp { get; }

    public int Drives => LinearDrives + AngularDrives;

    /// <summary>Both swings share one row.</summary>
    public bool HasCone => (Limited & Swings) == Swings;

    /// <summary>Rows of a single swing's ends, lower and upper.</summary>
    public int SwingLimits => !HasCone && (Limited & Swings) != 0 ? 2 : 0;

    /// <summary>Rows of the twist's ends, lower and upper.</summary>
    public int TwistLimits => (Limited & (1 << (int)CoordinateAxis.AngularX)) != 0 ? 2 : 0;

    /// <summary>All limited linear axes share one row: of a slide, disc or ball.</summary>
    public bool HasDistance => (Limited & ~Angular) != 0;

    /// <summary>Rows of limits: cone or swing, twist, distance.</summary>
    public int Limits => (HasCone ? 1 : 0) + SwingLimits + TwistLimits + (HasDistance ? 1 : 0);

    /// <summary>Whether the joint never has a row: it only keeps bodies from colliding, or lends its coordinates to a coupling.</summary>
    public bool IsEmpty => (Locked | Limited) == 0 && Drives == 0;

    /// <summary>The same number for the same rows.</summary>
    public int Signature => Locked | (Limited << 6) | (LinearDrives << 12) | (AngularDrives << 16) | (IsSlerp ? 1 << 20 : 0);
}
