using Kinefab.Diagnostics;
using Kinefab.Json;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>Numbers that are wrong by themselves.  Every comparison is written so that NaN fails it.</summary>
internal static class NumberRules
{
    internal static void Positive(in Place at, string field, double value)
    {
        if (!(value > 0 && value < double.PositiveInfinity))
            OutOfRange(at, field, value, "above 0");
        else
            NotVanishing(at, field, value);
    }

    /// <summary>What has to be above 0 is so as a 32-bit float too, in which Unity computes.</summary>
    internal static void NotVanishing(in Place at, string field, double value)
    {
        if (value > 0 && Vanishes(value))
            at.Report(field, DiagnosticCodes.NumberBelowFloat32, ("number", Invariant.Text(value)));
    }

    /// <summary>Whether a number is 0 as a 32-bit float, in which Unity computes.</summary>
    internal static bool Vanishes(double value) => (float)value == 0;

    /// <summary>Whether a vector has no length as 32-bit floats.</summary>
    internal static bool Vanishes(Vector3d value) => Vanishes(value.X) && Vanishes(value.Y) && Vanishes(value.Z);

    /// <summary>Infinity stands for "without limit".</summary>
    internal static void PositiveOrUnlimited(in Place at, string field, double value)
    {
        if (!(value > 0))
            OutOfRange(at, field, value, "above 0");
    }

    internal static void NotNegative(in Place at, string field, double value)
    {
        if (!(value >= 0 && value < double.PositiveInfinity))
            OutOfRange(at, field, value, "0 or above");
    }

    /// <summary>Infinity stands for "without limit".</summary>
    internal static void NotNegativeOrUnlimited(in Place at, string field, double value)
    {
        if (!(value >= 0))
            OutOfRange(at, field, value, "0 or above");
    }

    internal static void Share(in Place at, string field, double value)
    {
        if (!(value is >= 0 and <= 1))
            OutOfRange(at, field, value, "between 0 and 1");
    }

    internal static void Between(in Place at, string field, long value, long least, long most)
    {
        if (value < least || value > most)
            OutOfRange(at, field, value, $"between {Invariant.Text(least)} and {Invariant.Text(most)}");
    }

    internal static void AtLeast(in Place at, string field, long value, long least)
    {
        if (value < least)
            OutOfRange(at, field, value, $"{Invariant.Text(least)} or above");
    }

    internal static void Finite(in Place at, string field, double value)
    {
        if (!Numerics.Finite.Is(value))
            at.Report(field, DiagnosticCodes.NumberNotFinite, ("number", Invariant.Text(value)));
    }

    internal static void Finite(in Place at, string field, Vector3d value)
    {
        if (!value.IsFinite)
            at.Report(field, DiagnosticCodes.NumberNotFinite, ("number", value.ToString()));
    }

    /// <summary>Rotations that are further from length 1 than rounding to float32 explains would be scaled silently.</summary>
    internal static void Unit(in Place at, string field, Quaterniond value)
    {
        if (!IsUnit(value))
            at.Report(field, DiagnosticCodes.QuaternionNotUnit, ("length", Invariant.Text(System.Math.Sqrt(value.LengthSquared))));
    }

    internal static bool IsUnit(Quaterniond value)
    {
        const double tolerance = 2e-4;
        double squared = value.LengthSquared;
        return squared > 1 - tolerance && squared < 1 + tolerance;
    }

    /// <summary>Whether an index points into a list of that many.</summary>
    internal static bool Reference(in Place at, string field, int index, string list, int count)
    {
        if ((uint)index < (uint)count)
            return true;
        at.Report(
            field,
            DiagnosticCodes.ReferenceUnresolved,
            ("index", Invariant.Text(index)),
            ("list", list),
            ("count", Invariant.Text(count)));
        return false;
    }

    private static void OutOfRange(in Place at, string field, double value, string range) =>
        at.Report(field, DiagnosticCodes.NumberOutOfRange, ("value", Invariant.Text(value)), ("range", range));
}
