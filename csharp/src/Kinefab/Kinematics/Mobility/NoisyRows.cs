using System;
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
    // A narrower gap between kept and repeated rows is none of rounding; the same of an error at the start.
    private const double NoisyGap = 1e10;
    private const double Noise = 1e-9;

    // Length of a trial step, radians or lengths.
    private const double Way = 1e-2;

    // Times the noise that the repeated rows may be missed by: it grows along the way, and is spread over the rows.
    private const double Allowed = 8;

    // Steps back onto the rows; each shrinks what is left by about Way.
    private const int Chords = 8;
    private const int Trials = 2;

    /// <summary>Whether there is noise, and all velocities are motions that keep the rows as well as these repeat each other.</summary>
    /// <param name="newton">Of a linkage.</param>
    /// <param name="here">Its velocities at the state.</param>
    /// <param name="state">Closed as well as it can be.</param>
    public static bool Keep(NewtonSolver newton, VelocitySpace here, MechanismState state)
    {
        double[] errors = Errors(newton, state, new double[newton.Motion.Linear.Length], out double[,] rows);
        double worst = Largest(errors);
        if (here.Freedoms == 0 || (here.Gap >= NoisyGap && worst <= Noise))
        {
            return false;
        }

        var values = new SingularValues((double[,])rows.Clone());
        int rank = values.Values.Length - here.Freedoms;
        double allowed = Allowed * (worst + Way * (rank >= 0 ? values.Values[rank] : 0));
        for (int trial = 0; trial < Trials; trial++)
        {
            double[] step = here.Mixture(trial, Way);
            for (int i = 0; i < Chords; i++)
            {
                TakeBack(step, Errors(newton, state, step, out _), rows, values, rank);
            }

            if (!(Largest(Errors(newton, state, step, out _)) <= allowed))
            {
                return false;
            }
        }

        return true;
    }

    // The least step that the rows at the start ask for: by the kept singular values alone.
    private static void TakeBack(double[] step, double[] errors, double[,] rows, SingularValues values, int rank)
    {
        for (int k = 0; k < rank; k++)
        {
            double share = 0;
            for (int r = 0; r < errors.Length; r++)
            {
                double along = 0;
                for (int i = 0; i < step.Length; i++)
                {
                    along += rows[r, i] * values.Vector(i, k);
                }

                share += along * errors[r];
            }

            share /= values.Values[k] * values.Values[k];
            for (int i = 0; i < step.Length; i++)
            {
                step[i] -= share * values.Vector(i, k);
            }
        }
    }

    private static double[] Errors(NewtonSolver newton, MechanismState state, double[] step, out double[,] rows)
    {
        MechanismState moved = state.Clone();
        newton.Motion.Start(moved.Poses);
        newton.Motion.Move(moved.Poses, step);
        var dense = new DenseRows(newton.Firsts, step.Length);
        newton.ClearDriven();
        newton.Equations.Sink = dense;
        newton.Assemble(moved);
        newton.Equations.Sink = null;
        var columns = new int[step.Length];
        for (int i = 0; i < columns.Length; i++)
        {
            columns[i] = i;
        }

        rows = dense.Matrix(columns);
        var errors = new double[dense.Count];
        for (int i = 0; i < errors.Length; i++)
        {
            errors[i] = dense.Errors[i];
        }

        return errors;
    }

    private static double Largest(double[] values)
    {
        double largest = 0;
        foreach (double value in values)
        {
            largest = Math.Max(largest, Math.Abs(value));
        }

        return largest;
    }
}
