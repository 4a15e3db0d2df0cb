using System;

namespace Kinefab.Numerics;

/// <summary>Vectors of any length, as arrays; of two both are as long.</summary>
internal static class DenseVector
{
    /// <summary>x . y.</summary>
    public static double Dot(double[] x, double[] y)
    {
        double sum = 0;
        for (int i = 0; i < x.Length; i++)
        {
            sum += x[i] * y[i];
        }

        return sum;
    }

    /// <summary>|x|.</summary>
    public static double Length(double[] x) => Math.Sqrt(Dot(x, x));

    /// <summary>Takes out of x what it has along a vector of length 1 (a step of Gram and Schmidt).</summary>
    public static void RemoveAlong(double[] x, double[] unit)
    {
        double along = Dot(x, unit);
        for (int i = 0; i < x.Length; i++)
        {
            x[i] -= along * unit[i];
        }
    }

    /// <summary>x + share y.</summary>
    public static void Add(double[] x, double share, double[] y)
    {
        for (int i = 0; i < x.Length; i++)
        {
            x[i] += share * y[i];
        }
    }

    /// <summary>The largest |x_i|; 0 of none.</summary>
    public static double Largest(double[] x)
    {
        double largest = 0;
        foreach (double entry in x)
        {
            largest = Math.Max(largest, Math.Abs(entry));
        }

        return largest;
    }

    /// <summary>x / length.</summary>
    public static void Divide(double[] x, double length)
    {
        for (int i = 0; i < x.Length; i++)
        {
            x[i] /= length;
        }
    }
}
