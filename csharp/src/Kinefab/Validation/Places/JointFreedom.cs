using System.Diagnostics;
using System;
using Kinefab.Document;

namespace Kinefab.Validation;

/// <summary>
/// One coordinate that a joint leaves to its own body, in the sense of <see cref="JointCoordinate"/>: against the
/// connected body, by Unity's left-hand rule, zero at start-up.
/// </summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct JointFreedom
{
    internal JointFreedom(Coordinate coordinate, double lower, double upper)
    {
        Coordinate = coordinate;
        Lower = lower;
        Upper = upper;
    }

    /// <summary>Which coordinate.</summary>
    public Coordinate Coordinate { get; }

    /// <summary>Degrees or metres; negative infinity: free.</summary>
    public double Lower { get; }

    /// <summary>Degrees or metres; positive infinity: free.</summary>
    public double Upper { get; }

    /// <summary>Whether it has limits.</summary>
    public bool IsLimited => !double.IsInfinity(Lower) || !double.IsInfinity(Upper);

    /// <summary>Whether it is a rotation, in degrees; else it is a translation, in metres.</summary>
    public bool IsAngle => Coordinate is Coordinate.Angle or Coordinate.AngularX or Coordinate.AngularY or Coordinate.AngularZ;

    /// <summary>Angle -10 to 80 deg, or Angle free.</summary>
    public override string ToString() => IsLimited ? FormattableString.Invariant($"{Coordinate} {Lower:0.######} to {Upper:0.######} {(IsAngle ? "deg" : "m")}") : $"{Coordinate} free";
}
