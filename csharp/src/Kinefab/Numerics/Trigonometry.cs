using System;

namespace Kinefab.Numerics;

/// <summary>
/// Sines, cosines and arctangents of the same bits everywhere. <see cref="Math"/> asks the C library, whose last bit differs between
/// libraries and, in glibc, between processors with and without fused multiplication. Here are only + - * / and the square root, which
/// IEEE 754 rounds in one way; results are within one unit in the last place of the true value.
/// </summary>
internal static class Trigonometry
{
    // Pi / 2 in three parts; a product of the first two with a whole number below 2^20 is exact.
    private const double Quarter1 = 1.5707963267341256;
    private const double Quarter2 = 6.077100506303966e-11;
    private const double Quarter3 = 2.0222662487959506e-21;
    private const double MostQuarters = 1 << 20;

    // Pi / 2 rounded, and what the rounding took.
    private const double HalfPi = 1.5707963267948966;
    private const double HalfPiRest = 6.123233995736766e-17;

    private const double LargeLength = 1.3407807929942597e154;

    // Arctangents of 0, 1/4, 1/2, 3/4 and 1, and what their rounding took.
    private static readonly double[] Arctangents = { 0, 0.24497866312686414, 0.4636476090008061, 0.6435011087932844, 0.7853981633974483 };
    private static readonly double[] ArctangentRests = { 0, 1.0698755618734451e-17, 2.2698777452961687e-17, 1.5834785051444286e-17, 3.061616997868383e-17 };

    /// <summary>Of an angle in radians.</summary>
    public static double Sin(double angle) =>
        Math.Abs(angle) <= Math.PI / 4 ? SinNearZero(angle) : SinOf(Reduced(angle, out int quarter), quarter);

    /// <summary>Of an angle in radians.</summary>
    public static double Cos(double angle) =>
        Math.Abs(angle) <= Math.PI / 4 ? CosNearZero(angle) : SinOf(Reduced(angle, out int quarter), quarter + 1);

    /// <summary>Of an angle in radians.</summary>
    public static double Tan(double angle) => Sin(angle) / Cos(angle);

    /// <summary>The angle of a point, -pi to pi; signed zeros and infinities as <see cref="Math.Atan2"/> has them.</summary>
    public static double Atan2(double y, double x)
    {
        if (double.IsNaN(x) || double.IsNaN(y))
            return double.NaN;
        (double across, double along) = (Math.Abs(y), Math.Abs(x));
        if (double.IsInfinity(across) || double.IsInfinity(along))
            (across, along) = (double.IsInfinity(across) ? 1 : 0, double.IsInfinity(along) ? 1 : 0);
        // So that no sum of the two is infinite.
        if (across > LargeLength || along > LargeLength)
            (across, along) = (across / LargeLength, along / LargeLength);
        double angle = across <= along
            ? along == 0 ? 0 : OfSlope(across, along)
            : HalfPi - (OfSlope(along, across) - HalfPiRest);
        if (IsNegative(x))
            angle = 2 * HalfPi - (angle - 2 * HalfPiRest);
        return IsNegative(y) ? -angle : angle;
    }

    /// <summary>The angle of a slope, -pi / 2 to pi / 2.</summary>
    public static double Atan(double slope) => Atan2(slope, 1);

    /// <summary>The angle of a sine, -pi / 2 to pi / 2; no number outside of -1 to 1.</summary>
    public static double Asin(double sine) => Atan2(sine, Math.Sqrt((1 - sine) * (1 + sine)));

    private static double SinOf(double rest, int quarter) => (quarter & 3) switch
    {
        0 => SinNearZero(rest),
        1 => CosNearZero(rest),
        2 => -SinNearZero(rest),
        _ => -CosNearZero(rest),
    };

    // What is left of an angle by whole quarters of a turn, at most pi / 4 either way. Beyond half a million turns of the angle less than its own
    // last place is lost.
    private static double Reduced(double angle, out int quarter)
    {
        double quarters = Math.Round(angle / HalfPi);
        if (!(Math.Abs(quarters) < MostQuarters))
        {
            angle = Math.IEEERemainder(angle, 4 * HalfPi);
            quarters = Math.Round(angle / HalfPi);
        }

        quarter = double.IsNaN(quarters) ? 0 : (int)quarters & 3;
        double near = angle - quarters * Quarter1;
        double second = quarters * Quarter2;
        double nearer = near - second;
        return nearer - (quarters * Quarter3 - (near - nearer - second));
    }

    // Taylor's series to x^17.
    private static double SinNearZero(double x)
    {
        double z = x * x;
        double sum = -1.0 / 1307674368000 + z / 355687428096000;
        sum = 1.0 / 6227020800 + z * sum;
        sum = -1.0 / 39916800 + z * sum;
        sum = 1.0 / 362880 + z * sum;
        sum = -1.0 / 5040 + z * sum;
        sum = 1.0 / 120 + z * sum;
        sum = -1.0 / 6 + z * sum;
        return x + x * z * sum;
    }

    // Taylor's series to x^16; 1 - z / 2 with what its rounding took.
    private static double CosNearZero(double x)
    {
        double z = x * x;
        double sum = -1.0 / 87178291200 + z / 20922789888000;
        sum = 1.0 / 479001600 + z * sum;
        sum = -1.0 / 3628800 + z * sum;
        sum = 1.0 / 40320 + z * sum;
        sum = -1.0 / 720 + z * sum;
        sum = 1.0 / 24 + z * sum;
        double half = 0.5 * z;
        double rounded = 1 - half;
        return rounded + (1 - rounded - half + z * z * sum);
    }

    // Of across / along from 0 to 1: the nearest quarter's arctangent, and the series of what is left, at most 1/8 either way.
    private static double OfSlope(double across, double along)
    {
        int nearest = (int)(4 * (across / along) + 0.5);
        double known = 0.25 * nearest;
        double t = nearest == 0 ? across / along : (across - known * along) / (along + known * across);
        double z = t * t;
        double sum = -1.0 / 15 + z / 17;
        sum = 1.0 / 13 + z * sum;
        sum = -1.0 / 11 + z * sum;
        sum = 1.0 / 9 + z * sum;
        sum = -1.0 / 7 + z * sum;
        sum = 1.0 / 5 + z * sum;
        sum = -1.0 / 3 + z * sum;
        return Arctangents[nearest] + (t + (ArctangentRests[nearest] + t * z * sum));
    }

    private static bool IsNegative(double value) => BitConverter.DoubleToInt64Bits(value) < 0;
}
