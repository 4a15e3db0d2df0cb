using System.Globalization;

namespace Kinefab.Json;

/// <summary>Numbers as messages show them, whatever the machine's language.</summary>
internal static class Invariant
{
    internal static string Text(long value) => value.ToString(CultureInfo.InvariantCulture);

    internal static string Text(double value) => value.ToString("R", CultureInfo.InvariantCulture);

    internal static bool TryNumber(string text, out double value) => double.TryParse(text, NumberStyles.Float, CultureInfo.InvariantCulture, out value);
}
