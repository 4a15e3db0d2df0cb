using System;
using System.Globalization;
using Kinefab.Kinematics;

namespace Kinefab.Cli.Motion;

/// <summary>Values of coordinates, as people read them and as they may be asked for.</summary>
internal static class CoordinateText
{
    /// <summary>Null when a coordinate may be asked to go that far, at once or in a second, else between which the value must lie.</summary>
    internal static string? RangeFault(MechanismCoordinate coordinate, double value, string unit) =>
        Math.Abs(value) <= coordinate.Farthest ? null : $"must lie between -{Number(coordinate.Farthest)} and {Number(coordinate.Farthest)} {unit}";

    /// <summary>As it is written, without the sign that the format gives a negative number that comes to 0.</summary>
    internal static string Number(double value) => (Math.Round(value, 6) + 0.0).ToString("0.######", CultureInfo.InvariantCulture);
}
