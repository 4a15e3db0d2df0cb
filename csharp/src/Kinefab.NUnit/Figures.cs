using System;
using System.Collections.Generic;
using System.Globalization;
using Kinefab.Kinematics;

namespace Kinefab.NUnit;

/// <summary>Numbers in a message: with their unit, and no more rows of a series than one reads.</summary>
internal static class Figures
{
    private const int MostRows = 13;

    /// <summary>In the coordinate's unit.</summary>
    public static string Of(MechanismCoordinate coordinate, double value) => $"{Number(value)} {UnitOf(coordinate)}";

    /// <summary>Degrees or metres.</summary>
    public static string UnitOf(MechanismCoordinate coordinate) => coordinate.IsAngle ? "degrees" : "m";

    /// <summary>Six digits.</summary>
    public static string Number(double value) => value.ToString("G6", CultureInfo.InvariantCulture);

    /// <summary>For a tolerance that is none.</summary>
    public static ArgumentOutOfRangeException Negative(string parameter, double value) => new(parameter, value, "A tolerance is 0 or more.");

    /// <summary>As many indices of a series as a message shows, first and last among them.</summary>
    public static IEnumerable<int> Rows(int count)
    {
        int shown = Math.Min(count, MostRows);
        for (int i = 0; i < shown; i++)
            yield return shown == 1 ? 0 : (int)Math.Round((double)i * (count - 1) / (shown - 1));
    }
}
