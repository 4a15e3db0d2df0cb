using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Bench;

/// <summary>Scenes whose freedoms are counted: many small mechanisms, by themselves or one on another, in two sizes each.</summary>
internal static class MobilityScenes
{
    /// <summary>Ratio of the two sizes.</summary>
    internal const int Growth = 10;

    /// <summary>What a scene of a size is made of; a size is about the number of its joints.</summary>
    internal static readonly IReadOnlyDictionary<string, Func<int, SceneDocument>> Kinds = new Dictionary<string, Func<int, SceneDocument>>
    {
        ["geared pairs"] = GearedPairs,
        ["doors"] = Doors,
        ["four-bars"] = joints => FourBars(joints / 4, onEachOther: false),
        ["four-bars on each other's rockers"] = joints => FourBars(joints / 4, onEachOther: true),
        ["open chain"] = DriveScenes.Chain,
    };

    private static SceneDocument GearedPairs(int hinges)
    {
        var scene = new PlanarScene();
        for (int i = 0; i < hinges; i++)
        {
            scene.Hinge(scene.Body(), null, new Vector3d(i, 0, 0));
            if (i % 2 == 1)
                scene.Gear(i - 1, i, -2);
        }

        return scene.Document();
    }

    private static SceneDocument Doors(int hinges)
    {
        var scene = new PlanarScene();
        for (int i = 0; i < hinges; i++)
            scene.Hinge(scene.Body(), null, new Vector3d(i, 0, 0));
        return scene.Document();
    }

    private static SceneDocument FourBars(int count, bool onEachOther)
    {
        var scene = new PlanarScene();
        int? ground = null;
        for (int i = 0; i < count; i++)
        {
            Vector3d at = new(1.3 * i, 0, 0);
            int crank = scene.Body(), rod = scene.Body(), rocker = scene.Body();
            scene.Hinge(crank, ground, at);
            scene.Hinge(rod, crank, at + new Vector3d(0.3, 0.4, 0));
            scene.Hinge(rocker, rod, at + new Vector3d(1.4, 0.7, 0));
            scene.Hinge(rocker, ground, at + new Vector3d(1.1, 0, 0), closure: true);
            ground = onEachOther ? rocker : null;
        }

        return scene.Document();
    }
}
