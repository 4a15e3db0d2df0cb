using System.Globalization;

namespace Kinefab.Cli;

/// <summary>Numbers of things: 1 error, 2 errors.</summary>
internal static class Counted
{
    internal static string Of(int count, string one, string many) => $"{count.ToString(CultureInfo.InvariantCulture)} {(count == 1 ? one : many)}";
}
