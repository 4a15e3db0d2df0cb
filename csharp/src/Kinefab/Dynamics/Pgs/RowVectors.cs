using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// The vectors of a row. Velocities are changes since the start of the solve, the angular ones in sqrt(I)-space:
/// w = w_start + I^(-1/2) u, so that one vector per body serves as Jacobian and as response. One linear part does for
/// both bodies: every joint row has Linear0 = Linear1, and combining rows keeps that. While a row is prepared the fourth
/// numbers carry what preprocessing combines along with the vectors; the sweeps never read them.
/// </summary>
internal struct RowVectors
{
    /// <summary>Linear part; C.</summary>
    public Double4 Linear;

    /// <summary>I^(-1/2) Angular0; the target of Cdot.</summary>
    public Double4 Sqrt0;

    /// <summary>I^(-1/2) Angular1; Cdot at the start of the solve.</summary>
    public Double4 Sqrt1;
}

/// <summary>What only rows that are solved in turn have: springs, motors and limits, and all rows of a joint without preprocessing.</summary>
internal struct RowBounds
{
    public double ImpulseMultiplier;
    public double Minimum;
    public double Maximum;
}
