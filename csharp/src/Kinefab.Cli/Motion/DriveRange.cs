using System;
using Kinefab.Kinematics;

namespace Kinefab.Cli.Motion;

/// <summary>How far a coordinate is asked to go at most, at once or in a second: the solvers walk all of the way in small steps.</summary>
internal static class DriveRange
{
    internal const double Degrees = 360_000;
    internal const double Metres = 1000;

    /// <summary>Null when the value lies within, else between which it must lie.</summary>
    internal static string? Fault(MechanismCoordinate coordinate, double value, string unit)
    {
        double most = coordinate.IsAngle ? Degrees : Metres;
        return Math.Abs(value) <= most ? null : $"must lie between -{SweepText.Number(most)} and {SweepText.Number(most)} {unit}";
    }
}
