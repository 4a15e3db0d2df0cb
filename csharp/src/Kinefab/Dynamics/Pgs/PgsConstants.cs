using Kinefab.Joints;

namespace Kinefab.Dynamics.Pgs;

/// <summary>Turns a prepared row into the constants of its sweeps. Source: DySolverConstraint1D.h, setSolverConstants.</summary>
internal static class PgsConstants
{
    /// <summary>Fills a row's constants, multipliers and bounds, and clears its impulse.</summary>
    /// <param name="rows">All rows; the vectors of this one, what they carry must be set.</param>
    /// <param name="i">Which of them.</param>
    /// <param name="response">J M^-1 J^T.</param>
    /// <param name="row">The row as the joint gave it; its error, target and velocity are taken from the vectors, which preprocessing may have changed.</param>
    /// <param name="driveScale">What makes a drive limit an impulse.</param>
    /// <param name="dt">Step, s.</param>
    /// <param name="inverseDt">1/dt.</param>
    /// <remarks>
    /// Rigid: lambda += (VelocityTarget - error/dt - Cdot) / response.
    /// Spring, implicit Euler: a = dt^2 k + dt d, b = dt (d vT - k error);
    /// force mode x = 1/(1 + a response), lambda = x b - x a Cdot + (1 - x) lambda;
    /// acceleration mode x = 1/(1 + a), lambda = (x b - x a Cdot)/response + (1 - x) lambda.
    /// </remarks>
    public static void Set(SweepRows rows, int i, double response, in ConstraintRow row, double driveScale, double dt, double inverseDt)
    {
        ref RowBounds bounds = ref rows.Bounds[i];
        ref RowVectors vectors = ref rows.Vectors[i];
        double error = vectors.Linear.W;
        double target = vectors.Sqrt0.W;
        double velocity = vectors.Sqrt1.W;
        double constant;
        double unbiased;
        double multiplier;
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

            constant = x * scale * b;
            unbiased = constant;
            multiplier = -x * scale * a;
            bounds.ImpulseMultiplier = 1 - x;
        }
        else
        {
            multiplier = -inverseResponse;
            bounds.ImpulseMultiplier = 1;
            if (row.Bounces(-velocity))
            {
                constant = inverseResponse * row.Restitution * -velocity;
                unbiased = constant;
            }
            else
            {
                constant = inverseResponse * (target - error * inverseDt);
                double keptError = row.Has(RowFlags.KeepBias) ? row.GeometricError : 0;
                unbiased = inverseResponse * (target - keptError * inverseDt);
            }
        }

        double start = velocity * multiplier;
        rows.BiasedConstants[i] = constant + start;
        rows.UnbiasedConstants[i] = unbiased + start;
        rows.VelocityMultipliers[i] = multiplier;
        rows.Impulses[i] = 0;
        bounds.Minimum = row.Minimum * driveScale;
        bounds.Maximum = row.Maximum * driveScale;
    }

    /// <summary>The same for an equality that is solved together with others: rigid, without bounds, without bias in the velocity iterations.</summary>
    /// <param name="rows">All rows.</param>
    /// <param name="i">Which of them.</param>
    /// <param name="response">J M^-1 J^T.</param>
    /// <param name="inverseDt">1/dt.</param>
    public static void SetEquality(SweepRows rows, int i, double response, double inverseDt)
    {
        ref RowVectors vectors = ref rows.Vectors[i];
        double target = vectors.Sqrt0.W;
        double inverse = response > 0 ? 1 / response : 0;
        double start = vectors.Sqrt1.W * -inverse;
        rows.BiasedConstants[i] = inverse * (target - vectors.Linear.W * inverseDt) + start;
        rows.UnbiasedConstants[i] = inverse * target + start;
        rows.VelocityMultipliers[i] = -inverse;
        rows.Impulses[i] = 0;
    }
}
