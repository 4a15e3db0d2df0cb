using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Tests.Kinematics;

/// <summary>
/// Mechanisms at random: a tree of hinges, slides, balls, universals, pins in slots, with and without limits and cones,
/// some closed to loops (planar ones, so that they move), some coupled. Every joint is closed at the exported pose.
/// </summary>
internal static class RandomScene
{
    public static MechanismScene Make(int seed)
    {
        var random = new Random(seed);
        var scene = new MechanismScene();
        bool isPlanar = random.Next(2) == 0;
        int bodies = random.Next(2, 8);
        var places = new List<Vector3d>();
        var hinges = new List<JointPlace>();
        for (int i = 0; i < bodies; i++)
        {
            int? parent = i == 0 || random.Next(5) == 0 ? null : random.Next(i);
            Vector3d from = parent is int p ? places[p] : Point(random, isPlanar);
            places.Add(from + Point(random, isPlanar));
            int body = scene.Body($"body{i}", places[i]);
            if (isPlanar || random.Next(2) == 0)
            {
                hinges.Add(Hinge(random, scene, body, parent, from, isPlanar));
            }
            else
            {
                Other(random, scene, body, parent, from);
            }
        }

        // A planar loop takes two freedoms of at least three.
        for (int i = 0; isPlanar && bodies > 3 && i < random.Next(3); i++)
        {
            int a = random.Next(bodies);
            int b = random.Next(-1, bodies);
            if (a != b)
            {
                scene.Hinge(a, b < 0 ? null : b, Point(random, isPlanar), Vector3d.UnitZ, closure: true);
            }
        }

        if (hinges.Count > 1 && random.Next(3) == 0)
        {
            scene.Couple(hinges[0], Coordinate.Angle, hinges[^1], Coordinate.Angle, (random.NextDouble() - 0.5) * 4);
        }

        return scene;
    }

    private static JointPlace Hinge(Random random, MechanismScene scene, int body, int? parent, Vector3d from, bool isPlanar)
    {
        (double min, double max) = random.Next(2) == 0 ? (0, 0) : (-5 - 100 * random.NextDouble(), 5 + 100 * random.NextDouble());
        return scene.Hinge(body, parent, from, isPlanar ? Vector3d.UnitZ : Point(random, false), min, max);
    }

    private static void Other(Random random, MechanismScene scene, int body, int? parent, Vector3d from)
    {
        string motions = new[] { "FLLLLL", "MLLLLL", "LLLFFF", "LLLFMM", "LLLMMM", "LLLFLF", "FLLFLL", "LFLFLL", "MMLFLL", "LLLLFF" }[random.Next(10)];
        Vector3d axis = Point(random, false).Normalized();
        scene.Configurable(
            body, parent, from, axis, Vector3d.Perpendicular(axis), motions, linearLimit: 0.1 + random.NextDouble(),
            low: -10 - 100 * random.NextDouble(), high: 10 + 100 * random.NextDouble(),
            limitY: 10 + 60 * random.NextDouble(), limitZ: 10 + 60 * random.NextDouble(), swap: random.Next(3) == 0);
    }

    private static Vector3d Point(Random random, bool isPlanar) =>
        new(random.NextDouble() * 2 - 1, random.NextDouble() * 2 - 1, isPlanar ? 0 : random.NextDouble() * 2 - 1);
}
