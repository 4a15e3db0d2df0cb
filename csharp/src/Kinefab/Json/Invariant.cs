using System.Globalization;

namespace Kinefab.Json;

/// <summary>Numbers as messages show them, whatever the machine's language.</summary>
internal static class Invariant
{
    internal static string Text(long value) => value.ToString(CultureInfo.InvariantCulture);

    internal static string Text(double value) => value.ToString("R", CultureInfo.InvariantCulture);

    /// <summary>What is computed from a file's numbers, without what rounding adds.</summary>
    internal static string Measured(double value) => value.ToString("G6", CultureInfo.InvariantCulture);

    /// <summary>1 joint, 2 joints.</summary>
    internal static string Counted(int count, string one) => Counted(count, one, one + "s");

    internal static string Counted(int count, string one, string many) => Text(count) + " " + (count == 1 ? one : many);

    internal static bool TryNumber(string text, out double value) => double.TryParse(text, NumberStyles.Float, CultureInfo.InvariantCulture, out value);
}
