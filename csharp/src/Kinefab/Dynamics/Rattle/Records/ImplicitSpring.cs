namespace Kinefab.Dynamics.Rattle;

/// <summary>What a scalar row is as a spring: its law over the step, and what is kept of it beyond the drift.</summary>
internal struct ImplicitSpring
{
    public SpringLaw Law;

    /// <summary>
    /// Of a spring whose C does not change as its row moves, a sine of an angle, that the step can follow: what of the law's implicit damping is its
    /// stiffness', which follows the C of the drift's two ends; else 0.
    /// </summary>
    public double EndShare;

    /// <summary>Length of the drift, s.</summary>
    public double Length;

    /// <summary>
    /// The speed at which a spring that the step is too long to follow holds itself, see <see cref="StiffSpringCorrection"/>, by the impulse that it gave at
    /// it; NaN where it holds none, as at its limit.
    /// </summary>
    public double CorrectionSpeed;

    /// <summary>At the drift's start: J M^-1 J^T, by which an acceleration's gains are divided, 1/kg or 1/(kg m^2), and the speed that is asked for, m/s or rad/s.</summary>
    public double StartResponse;
    public double StartTarget;

    /// <summary>The row's speed in the drift, of a spring without potential, m/s or rad/s.</summary>
    public double DriftSpeed;

    /// <summary>Work of a spring without potential since the account was opened, J.</summary>
    public double Work;
}
