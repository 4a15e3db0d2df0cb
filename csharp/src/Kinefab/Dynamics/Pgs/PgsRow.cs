using System.Runtime.CompilerServices;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// A row for Gauss-Seidel sweeps. Velocities are changes since the start of the solve, the angular ones in sqrt(I)-space:
/// w = w_start + I^(-1/2) u, so that one vector per body serves as Jacobian and as response. One linear part does for
/// both bodies: every joint row has Linear0 = Linear1, and combining rows keeps that.
/// While a row is prepared the fourth numbers carry what preprocessing combines along with the vectors; the sweeps never
/// read them. Source: DySolverConstraint1D.h, SolverConstraint1D.
/// </summary>
internal struct PgsRow
{
    /// <summary>Linear part; C.</summary>
    public Double4 Linear;

    /// <summary>I^(-1/2) Angular0; the target of Cdot.</summary>
    public Double4 Sqrt0;

    /// <summary>I^(-1/2) Angular1; Cdot at the start of the solve.</summary>
    public Double4 Sqrt1;

    /// <summary>Angular0 itself, for the reported torque.</summary>
    public Double4 Angular0;

    /// <summary>J M^-1 J^T.</summary>
    public double Response;

    /// <summary>Impulse that the start velocity and the bias ask for.</summary>
    public double Constant;

    /// <summary>The same without bias, for the velocity iterations.</summary>
    public double UnbiasedConstant;
    public double VelocityMultiplier;
    public double ImpulseMultiplier;
    public double Minimum;
    public double Maximum;

    /// <summary>Accumulated impulse.</summary>
    public double Impulse;

    /// <summary>Whether the impulse counts for breaking and for the reported force.</summary>
    public bool Counts;

    /// <summary>Takes a multiple of another row away, with all that is carried along.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public void Subtract(in PgsRow other, double factor)
    {
        Linear -= other.Linear * factor;
        Sqrt0 -= other.Sqrt0 * factor;
        Sqrt1 -= other.Sqrt1 * factor;
        Angular0 -= other.Angular0 * factor;
    }
}
