namespace Kinefab.Dynamics.Rattle;

/// <summary>What a lane has as its row about a hinge's axis.</summary>
internal enum AxisRowKind : byte
{
    /// <summary>Nothing.</summary>
    None,

    /// <summary>A speed held within bounds of torque.</summary>
    Motor,

    /// <summary>The end of its range that the hinge rests on.</summary>
    Limit,

    /// <summary>A spring that the step can follow.</summary>
    Spring,
}

/// <summary>Where the numbers of a row about a hinge's axis stand in its record, each Width lanes wide.</summary>
internal static class AxisLanes
{
    /// <summary>Masks: 1 where a lane has a row, where that is a spring, and where it is a motor; else 0.</summary>
    public const int IsRow = 0;
    public const int IsSpring = 1;
    public const int IsMotor = 2;

    /// <summary>Speed that is asked for, of a spring that at which it gives nothing, rad/s.</summary>
    public const int Target = 3;

    /// <summary>Of a spring, its speed for each unit of the impulse before the drift, 1/(kg m^2).</summary>
    public const int Compliance = 4;

    /// <summary>Bounds of the impulse of the whole step, N m s.</summary>
    public const int Low = 5;
    public const int High = 6;

    /// <summary>J M^-1 J^T, 1/(kg m^2), and J v, rad/s, at the start pose. What stands before them is cleared at the start of each step.</summary>
    public const int Response = 7;
    public const int Speed = 8;

    /// <summary>Of the turn at the start pose, and at the end of the drift.</summary>
    public const int StartCosine = 9;
    public const int StartSine = 10;
    public const int Cosine = 11;
    public const int Sine = 12;

    /// <summary>The end of its range that a hinge rests on, rad, with its cosine and sine.</summary>
    public const int End = 13;
    public const int EndCosine = 14;
    public const int EndSine = 15;

    /// <summary>By how much a driven hinge turns in the drift, rad.</summary>
    public const int Turn = 16;

    public const int Count = 17;
}
