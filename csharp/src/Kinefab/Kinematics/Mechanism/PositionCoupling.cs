using System;
using System.Collections.Generic;
using Kinefab.Document;

namespace Kinefab.Kinematics;

/// <summary>q_driven = sum of ratio_i q_i + offset between a mechanism's coordinates, radians and metres as its rows have them.</summary>
internal readonly struct PositionCoupling
{
    public readonly int Driven;

    /// <summary>The coordinates that it follows.</summary>
    public readonly int[] Terms;

    /// <summary>One for each of the terms.</summary>
    public readonly double[] Ratios;
    public readonly double Offset;

    private PositionCoupling(int driven, int[] terms, double[] ratios, double offset)
    {
        Driven = driven;
        Terms = terms;
        Ratios = ratios;
        Offset = offset;
    }

    /// <summary>The couplings whose joints are all there: those of inactive objects are not.</summary>
    public static PositionCoupling[] Of(IReadOnlyList<Coupling> sources, MechanismCoordinate[] coordinates)
    {
        var places = new Dictionary<(int GameObject, int Component, Coordinate Coordinate), int>();
        for (int i = 0; sources.Count > 0 && i < coordinates.Length; i++)
        {
            places.TryAdd((coordinates[i].GameObject, coordinates[i].Component, coordinates[i].Coordinate), i);
        }

        var couplings = new List<PositionCoupling>();
        foreach (Coupling source in sources)
        {
            if (Make(source, coordinates, places) is PositionCoupling coupling)
            {
                couplings.Add(coupling);
            }
        }

        return couplings.ToArray();
    }

    /// <summary>The same coupling in another list of coordinates.</summary>
    public PositionCoupling Between(int driven, int[] terms) => new(driven, terms, Ratios, Offset);

    private static PositionCoupling? Make(
        Coupling source, MechanismCoordinate[] coordinates, Dictionary<(int GameObject, int Component, Coordinate Coordinate), int> places)
    {
        IReadOnlyList<CouplingTerm> followed = source.Followed;
        if (!places.TryGetValue(Place(source.B), out int driven))
        {
            return null;
        }

        var terms = new int[followed.Count];
        var ratios = new double[followed.Count];
        double offset = source.Offset * Unit(coordinates[driven]) + coordinates[driven].Zero;
        for (int i = 0; i < terms.Length; i++)
        {
            if (!places.TryGetValue(Place(followed[i].Coordinate), out terms[i]))
            {
                return null;
            }

            ratios[i] = followed[i].Ratio * Unit(coordinates[driven]) / Unit(coordinates[terms[i]]);
            offset -= ratios[i] * coordinates[terms[i]].Zero;
        }

        return new PositionCoupling(driven, terms, ratios, offset);
    }

    private static double Unit(MechanismCoordinate coordinate) => coordinate.IsAngle ? Math.PI / 180 : 1;

    private static (int GameObject, int Component, Coordinate Coordinate) Place(JointCoordinate coordinate) =>
        (coordinate.GameObject, coordinate.Component, coordinate.Coordinate);
}
