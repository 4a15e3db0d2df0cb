using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Bench;

/// <summary>The mechanisms that are driven: planar, hinges about z, the first hinge turned by hand.</summary>
internal static class DriveScenes
{
    /// <summary>By the name that the table gives them.</summary>
    internal static readonly IReadOnlyDictionary<string, Func<SceneDocument>> All = new Dictionary<string, Func<SceneDocument>>
    {
        ["planar lever of 5 joints, 1 loop"] = Lever,
        ["ladder of parallelograms, 100 bars"] = () => Ladder(50),
        ["closed ring, 100 bars"] = () => Ring(100),
        ["chain, 10 bars"] = () => Chain(10),
        ["chain, 100 bars"] = () => Chain(100),
        ["chain, 1000 bars"] = () => Chain(1000),
    };

    private static SceneDocument Lever()
    {
        var scene = new PlanarScene();
        Vector3d pin = new(0.25 * Math.Cos(0.5), 0.25 * Math.Sin(0.5), 0);
        Vector3d end = new(pin.X + Math.Sqrt(0.81 - pin.Y * pin.Y), 0, 0);
        int shaft = scene.Body();
        scene.Hinge(shaft, null, Vector3d.Zero);
        int panel = scene.Body();
        scene.Add(panel, new FixedJoint { ConnectedBody = shaft });
        int bar = scene.Body();
        scene.Hinge(bar, panel, pin);
        int slider = scene.Body();
        scene.Add(slider, new ConfigurableJoint
        {
            Anchor = end,
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            AngularXMotion = ConfigurableJointMotion.Locked,
            AngularYMotion = ConfigurableJointMotion.Locked,
            AngularZMotion = ConfigurableJointMotion.Locked,
        });
        scene.Hinge(bar, slider, end, closure: true);
        return scene.Document();
    }

    // As many bars over the uprights as there are uprights, less one.
    private static SceneDocument Ladder(int uprights)
    {
        var scene = new PlanarScene();
        Vector3d up = new(Math.Cos(1.2), Math.Sin(1.2), 0);
        for (int i = 0; i < uprights; i++)
            scene.Hinge(scene.Body(), null, new Vector3d(i, 0, 0));
        for (int i = 0; i + 1 < uprights; i++)
        {
            int over = scene.Body();
            scene.Hinge(over, i, new Vector3d(i, 0, 0) + up);
            scene.Hinge(over, i + 1, new Vector3d(i + 1, 0, 0) + up, closure: true);
        }

        return scene.Document();
    }

    private static SceneDocument Ring(int bars)
    {
        var scene = new PlanarScene();
        int? previous = null;
        for (int i = 0; i < bars; i++)
        {
            int link = scene.Body();
            scene.Hinge(link, previous, Corner(i));
            previous = link;
        }

        scene.Hinge(previous!.Value, null, Corner(bars), closure: true);
        return scene.Document();

        Vector3d Corner(int i)
        {
            double angle = 2 * Math.PI * i / (bars + 1);
            return new Vector3d(Math.Cos(angle), Math.Sin(angle), 0) * (bars / 6.0);
        }
    }

    internal static SceneDocument Chain(int bars)
    {
        var scene = new PlanarScene();
        int? previous = null;
        for (int i = 0; i < bars; i++)
        {
            int link = scene.Body();
            scene.Hinge(link, previous, new Vector3d(i, i % 3 * 0.1, 0));
            previous = link;
        }

        return scene.Document();
    }
}
