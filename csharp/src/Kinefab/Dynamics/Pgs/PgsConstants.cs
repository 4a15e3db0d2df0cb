using Kinefab.Joints;

namespace Kinefab.Dynamics.Pgs;

/// <summary>Turns a prepared row into the constants of its sweeps. Source: DySolverConstraint1D.h, setSolverConstants.</summary>
internal static class PgsConstants
{
    /// <summary>Fills a row's constants.</summary>
    /// <param name="result">Its vectors, what they carry and its response must be set.</param>
    /// <param name="row">The row as the joint gave it; its error, target and velocity are taken from the result, which preprocessing may have changed.</param>
    /// <param name="keptError">The row's own error before preprocessing when it keeps its bias, else 0.</param>
    /// <param name="driveScale">What makes a drive limit an impulse.</param>
    /// <param name="dt">Step, s.</param>
    /// <param name="inverseDt">1/dt.</param>
    /// <remarks>
    /// Rigid: lambda += (VelocityTarget - error/dt - Cdot) / response.
    /// Spring, implicit Euler: a = dt^2 k + dt d, b = dt (d vT - k error);
    /// force mode x = 1/(1 + a response), lambda = x b - x a Cdot + (1 - x) lambda;
    /// acceleration mode x = 1/(1 + a), lambda = (x b - x a Cdot)/response + (1 - x) lambda.
    /// </remarks>
    public static void Set(ref PgsRow result, in ConstraintRow row, double keptError, double driveScale, double dt, double inverseDt)
    {
        double response = result.Response;
        double error = result.Linear.W;
        double target = result.Sqrt0.W;
        double velocity = result.Sqrt1.W;
        double inverseResponse = response > 0 ? 1 / response : 0;
        if (row.Has(RowFlags.Spring))
        {
            double a = dt * dt * row.Stiffness + dt * row.Damping;
            double b = dt * (row.Damping * target - row.Stiffness * error);
            double x;
            double scale;
            if (row.Has(RowFlags.AccelerationSpring))
            {
                x = 1 / (1 + a);
                scale = inverseResponse;
            }
            else
            {
                x = response > 0 ? 1 / (1 + a * response) : 0;
                scale = 1;
            }

            result.Constant = x * scale * b;
            result.UnbiasedConstant = result.Constant;
            result.VelocityMultiplier = -x * scale * a;
            result.ImpulseMultiplier = 1 - x;
        }
        else
        {
            result.VelocityMultiplier = -inverseResponse;
            result.ImpulseMultiplier = 1;
            if (row.Has(RowFlags.Restitution) && -velocity > row.BounceThreshold)
            {
                result.Constant = inverseResponse * row.Restitution * -velocity;
                result.UnbiasedConstant = result.Constant;
            }
            else
            {
                result.Constant = inverseResponse * (target - error * inverseDt);
                result.UnbiasedConstant = inverseResponse * (target - keptError * inverseDt);
            }
        }

        double start = velocity * result.VelocityMultiplier;
        result.Constant += start;
        result.UnbiasedConstant += start;
        result.Minimum = row.Minimum * driveScale;
        result.Maximum = row.Maximum * driveScale;
        result.Impulse = 0;
    }
}
