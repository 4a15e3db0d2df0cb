using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// A row ready for Gauss-Seidel sweeps. Velocities are changes since the start of the solve, the angular ones in
/// sqrt(I)-space: w = w_start + I^(-1/2) u, so that one vector per body serves as Jacobian and as response.
/// One linear part does for both bodies: every joint row has Linear0 = Linear1, and combining rows keeps that.
/// Source: DySolverConstraint1D.h, SolverConstraint1D.
/// </summary>
internal struct PgsRow
{
    public Vector3d Linear;
    public Vector3d Angular0;
    public Vector3d Angular1;

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
}
