namespace Kinefab.Dynamics.Rattle;

/// <summary>What a scalar row is as a spring: its law over the step, and what is kept of it beyond the drift.</summary>
internal struct ImplicitSpring
{
    public SpringLaw Law;

    /// <summary>
    /// The speed at which a spring that the step is too long to follow holds itself, see <see cref="StiffSpringCorrection"/>, by the impulse that it gave at
    /// it; NaN where it holds none, as at its limit.
    /// </summary>
    public double CorrectionSpeed;

    /// <summary>Work of a spring without potential since the account was opened, J.</summary>
    public double Work;
}
