using System;
using System.Collections.Generic;
using Kinefab.Document;

namespace Kinefab.Kinematics;

/// <summary>q_B = Ratio q_A + Offset between two of a mechanism's coordinates, radians and metres as its rows have them.</summary>
internal readonly struct PositionCoupling
{
    public readonly int A;
    public readonly int B;
    public readonly double Ratio;
    public readonly double Offset;

    private PositionCoupling(int a, int b, double ratio, double offset)
    {
        A = a;
        B = b;
        Ratio = ratio;
        Offset = offset;
    }

    /// <summary>The couplings whose joints are both there: those of inactive objects are not.</summary>
    public static PositionCoupling[] Of(IReadOnlyList<Coupling> sources, MechanismCoordinate[] coordinates)
    {
        var places = new Dictionary<(int GameObject, int Component, Coordinate Coordinate), int>();
        for (int i = 0; sources.Count > 0 && i < coordinates.Length; i++)
        {
            places.TryAdd((coordinates[i].GameObject, coordinates[i].Component, coordinates[i].Coordinate), i);
        }

        var couplings = new List<PositionCoupling>();
        for (int i = 0; i < sources.Count; i++)
        {
            if (!places.TryGetValue(Place(sources[i].A), out int a) || !places.TryGetValue(Place(sources[i].B), out int b))
            {
                continue;
            }

            double ratio = sources[i].Ratio * Unit(coordinates[b]) / Unit(coordinates[a]);
            double offset = sources[i].Offset * Unit(coordinates[b]) + coordinates[b].Zero - ratio * coordinates[a].Zero;
            couplings.Add(new PositionCoupling(a, b, ratio, offset));
        }

        return couplings.ToArray();
    }

    /// <summary>The same coupling in another list of coordinates.</summary>
    public PositionCoupling Between(int a, int b) => new(a, b, Ratio, Offset);

    private static double Unit(MechanismCoordinate coordinate) => coordinate.IsAngle ? Math.PI / 180 : 1;

    private static (int GameObject, int Component, Coordinate Coordinate) Place(JointCoordinate coordinate) =>
        (coordinate.GameObject, coordinate.Component, coordinate.Coordinate);
}
