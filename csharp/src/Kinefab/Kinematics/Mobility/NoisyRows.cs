using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Motions of a mechanism whose repeated rows do not quite repeat each other. A four-bar with axes that are 1e-6 rad off is locked by the
/// letter of its equations, and no one means that. Moved along its velocities, and brought back onto the rows that count, it may miss the
/// others by their small singular value times the way. Where a velocity is obstructed, as at a dead centre, it misses them by the way's
/// square. The same as kinefab/analysis/freedom/noise.py.
/// </summary>
internal static class NoisyRows
{
    // A narrower gap between kept and repeated rows is none of rounding.
    private const double NoisyGap = 1e10;

    // Length of a trial step, radians or lengths.
    private const double Way = 5e-2;

    // Times the noise that the repeated rows may be missed by: it grows along the way, and is spread over the rows.
    private const double Allowed = 8;

    // Steps back onto the rows; each shrinks what is left by about Way.
    private const int Chords = 8;
    private const int Trials = 2;

    // Against the square of a kept singular value; what is left of a step falls by their ratio with each chord.
    private const double Damping = 1e-12;

    /// <summary>Whether an error, or a singular value that does not count, is more than rounding makes.</summary>
    public static bool IsNoise(double error) => error > FineClosing.LargestRounding;

    /// <summary>Whether there is noise, and all velocities are motions that keep the rows as well as these repeat each other.</summary>
    /// <param name="newton">Of a linkage.</param>
    /// <param name="here">Its velocities at the state.</param>
    /// <param name="state">Closed as well as it can be.</param>
    public static bool Keep(NewtonSolver newton, VelocitySpace here, MechanismState state)
    {
        PackedRows rows = Rows(newton, state, new double[newton.Motion.Linear.Length]);
        double worst = Largest(rows.Errors);
        if (here.Freedoms == 0 || (here.Gap >= NoisyGap && worst <= FineClosing.LargestRounding))
        {
            return false;
        }

        double allowed = Allowed * (worst + Way * here.Dropped);
        for (int trial = 0; trial < Trials; trial++)
        {
            double[] step = here.Mixture(trial, Way);
            for (int i = 0; i < Chords; i++)
            {
                TakeBack(step, rows, Rows(newton, state, step).Errors, newton, here);
            }

            if (!(Largest(Rows(newton, state, step).Errors) <= allowed))
            {
                return false;
            }
        }

        return true;
    }

    // The least step that the rows at the start ask for, without what it has of the velocities: by the kept singular values alone.
    private static void TakeBack(double[] step, PackedRows rows, IReadOnlyList<double> errors, NewtonSolver newton, VelocitySpace here)
    {
        newton.Factor(rows, Damping);
        double[] back = newton.Answer(rows, errors);
        foreach (double[] velocity in here.Basis)
        {
            DenseVector.RemoveAlong(back, velocity);
        }

        for (int i = 0; i < step.Length; i++)
        {
            step[i] += back[i];
        }
    }

    private static PackedRows Rows(NewtonSolver newton, MechanismState state, double[] step)
    {
        MechanismState moved = state.Clone();
        newton.Motion.Start(moved.Poses);
        newton.Motion.Move(moved.Poses, step);
        newton.ClearDriven();
        return newton.Rows(moved);
    }

    private static double Largest(IReadOnlyList<double> values)
    {
        double largest = 0;
        foreach (double value in values)
        {
            largest = Math.Max(largest, Math.Abs(value));
        }

        return largest;
    }
}
