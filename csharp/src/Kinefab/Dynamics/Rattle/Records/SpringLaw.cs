using Kinefab.Joints;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// A spring and damper over a step: the force -k C + d (vT - v) taken at the share Theta of the step, C = C0 + Theta h v. See <see cref="ScalarRow"/>.
/// </summary>
internal readonly struct SpringLaw
{
    /// <param name="gains">Stiffness and damping; over the response where they are an acceleration's.</param>
    /// <param name="velocityTarget">vT, m/s or rad/s.</param>
    /// <param name="error">C at the start of the step, m or rad.</param>
    /// <param name="h">Step, s.</param>
    /// <param name="response">J M^-1 J^T, 1/kg or 1/(kg m^2).</param>
    /// <param name="isImplicit">Whether the whole impulse acts before the drift, see <see cref="ProjectedStep"/>.</param>
    public SpringLaw(in DriveModel gains, double velocityTarget, double error, double h, double response, bool isImplicit)
    {
        double perMass = gains.IsAcceleration && response > 0 ? 1 / response : 1;
        double k = gains.Stiffness * perMass;
        double d = gains.Damping * perMass;

        // Half the step's stiffness and damping against the inertia that they move, at most: where the step is too long to
        // follow the spring, its share goes from the midpoint's towards implicit Euler's, so that it decays and does not ring.
        double z = h * (d + h * k) * response;
        Theta = isImplicit ? 1 : z < 1 ? 0.5 : 1 - 0.5 / z;
        CorrectionGain = isImplicit || z <= 1 ? 0 : (z * z - 1) / response;
        ImplicitDamping = h * (d + Theta * h * k);
        RestImpulse = h * (d * velocityTarget - k * error);
        Damping = d;
    }

    public double Theta { get; }

    /// <summary>What the impulse falls by for each unit of speed, kg or kg m^2.</summary>
    public double ImplicitDamping { get; }

    /// <summary>d, of an acceleration spring too, N s/m or N m s/rad.</summary>
    public double Damping { get; }

    /// <summary>Impulse at v = 0, N s or N m s.</summary>
    public double RestImpulse { get; }

    /// <summary>By how much a spring that the step is too long to follow holds its speed at the drift's, see <see cref="StiffSpringCorrection"/>.</summary>
    public double CorrectionGain { get; }
}
