using System;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Tests.Kinematics;

/// <summary>Planar mechanisms with known motion; all axes along z, ground pins where the textbook puts them.</summary>
internal static class PlanarMechanisms
{
    public static readonly Vector3d Z = Vector3d.UnitZ;

    public static Vector3d At(double x, double y) => new(x, y, 0);

    public static Vector3d Polar(double radius, double degrees) =>
        At(radius * Math.Cos(degrees * Math.PI / 180), radius * Math.Sin(degrees * Math.PI / 180));

    /// <summary>Slider-crank r, l along x, the slide at y = e; at the crank angle given.</summary>
    public static (MechanismScene Scene, JointPlace Crank, JointPlace Slider, int SliderBody) SliderCrank(double r, double l, double e, double crankDegrees, bool minimalClosure = false)
    {
        var scene = new MechanismScene();
        Vector3d pin = Polar(r, crankDegrees);
        Vector3d end = At(pin.X + Math.Sqrt(l * l - (pin.Y - e) * (pin.Y - e)), e);
        int crank = scene.Body("crank", pin * 0.5);
        int rod = scene.Body("rod", (pin + end) * 0.5);
        int slider = scene.Body("slider", end);
        JointPlace drive = scene.Hinge(crank, null, Vector3d.Zero, Z);
        scene.Hinge(rod, crank, pin, Z);
        JointPlace slide = scene.Slide(slider, null, end, Vector3d.UnitX);
        if (minimalClosure)
        {
            scene.Configurable(rod, slider, end, Vector3d.UnitX, Vector3d.UnitY, "LLFFFF", closure: true);
        }
        else
        {
            scene.Hinge(rod, slider, end, Z, closure: true);
        }

        return (scene, drive, slide, slider);
    }

    /// <summary>Scotch yoke R = 0.3, the slot along y on the yoke.</summary>
    public static (MechanismScene Scene, JointPlace Crank, JointPlace Yoke) ScotchYoke(double crankDegrees)
    {
        var scene = new MechanismScene();
        Vector3d pin = Polar(0.3, crankDegrees);
        int crank = scene.Body("crank", pin);
        int yoke = scene.Body("yoke", At(pin.X, 0));
        JointPlace drive = scene.Hinge(crank, null, Vector3d.Zero, Z);
        JointPlace slide = scene.Slide(yoke, null, At(pin.X, 0), Vector3d.UnitX);
        scene.Configurable(yoke, crank, pin, Z, Vector3d.UnitY, "LFLFLL", closure: true);
        return (scene, drive, slide);
    }

    /// <summary>Oldham coupling, shafts 0.2 apart.</summary>
    public static (MechanismScene Scene, JointPlace In, int Disc, JointPlace Out, Vector3d Centre) Oldham(double inDegrees)
    {
        const double e = 0.2;
        var scene = new MechanismScene();
        Vector3d along = Polar(1, inDegrees);
        Vector3d centre = along * (e * along.X);
        int input = scene.Body("in", Vector3d.Zero);
        int disc = scene.Body("disc", centre);
        int output = scene.Body("out", At(e, 0));
        JointPlace drive = scene.Hinge(input, null, Vector3d.Zero, Z);
        scene.Slide(disc, input, centre, along);
        scene.Slide(disc, output, centre, At(-along.Y, along.X));
        JointPlace driven = scene.Hinge(output, null, At(e, 0), Z, closure: true);
        return (scene, drive, disc, driven, centre);
    }

    /// <summary>One stage of a scissor lift with arms of 1; slots on the ground (the component swaps its bodies) and on the platform.</summary>
    public static (MechanismScene Scene, JointPlace Arm, int Platform) Scissor(double armDegrees)
    {
        var scene = new MechanismScene();
        Vector3d top = Polar(1, armDegrees);
        int arm1 = scene.Body("arm1", top * 0.5);
        int arm2 = scene.Body("arm2", top * 0.5);
        int platform = scene.Body("platform", At(0, top.Y));
        JointPlace drive = scene.Hinge(arm1, null, Vector3d.Zero, Z);
        scene.Hinge(arm2, arm1, top * 0.5, Z);
        scene.Hinge(platform, arm2, At(0, top.Y), Z);
        scene.Configurable(arm2, null, At(top.X, 0), Z, Vector3d.UnitX, "LFLFLL", swap: true, closure: true);
        scene.Configurable(platform, arm1, top, Z, Vector3d.UnitX, "LFLFLL", closure: true);
        return (scene, drive, platform);
    }

    /// <summary>Wedge of 20 degrees: ground slides along x and y, and the slope between.</summary>
    public static (MechanismScene Scene, JointPlace Wedge, JointPlace Follower) Wedge()
    {
        var scene = new MechanismScene();
        int wedge = scene.Body("wedge", Vector3d.Zero);
        int follower = scene.Body("follower", At(0, 0.4));
        JointPlace drive = scene.Slide(wedge, null, Vector3d.Zero, Vector3d.UnitX);
        JointPlace driven = scene.Slide(follower, null, At(0, 0.4), Vector3d.UnitY);
        scene.Slide(follower, wedge, At(0.1, 0.2), Polar(1, 20));
        return (scene, drive, driven);
    }

    /// <summary>Planar five-bar: ground pins at x = 0 and 1.2, two links of 0.7 each side.</summary>
    public static (MechanismScene Scene, JointPlace Left, JointPlace Right, int Link, Vector3d Tip) FiveBar(double leftDegrees, double rightDegrees)
    {
        var scene = new MechanismScene();
        Vector3d a = Polar(0.7, leftDegrees);
        Vector3d b = At(1.2, 0) + Polar(0.7, rightDegrees);
        Vector3d middle = (a + b) * 0.5;
        Vector3d half = (b - a) * 0.5;
        double height = Math.Sqrt(0.64 - half.LengthSquared);
        Vector3d tip = middle + new Vector3d(-half.Y, half.X, 0).Normalized() * height;
        int b1 = scene.Body("b1", a);
        int b2 = scene.Body("b2", tip);
        int b3 = scene.Body("b3", tip);
        int b4 = scene.Body("b4", b);
        JointPlace left = scene.Hinge(b1, null, Vector3d.Zero, Z);
        scene.Hinge(b2, b1, a, Z);
        JointPlace right = scene.Hinge(b4, null, At(1.2, 0), Z);
        scene.Hinge(b3, b4, b, Z);
        scene.Hinge(b3, b2, tip, Z, closure: true);
        return (scene, left, right, b2, tip);
    }

    /// <summary>n square cells in a row: n + 1 links of 1 on ground pins, n links of 1 over them, at an angle of the uprights.</summary>
    public static (MechanismScene Scene, JointPlace First) Ladder(int n, double degrees, bool minimalClosure = false)
    {
        var scene = new MechanismScene();
        Vector3d up = Polar(1, degrees);
        var uprights = new int[n + 1];
        JointPlace first = default;
        for (int i = 0; i <= n; i++)
        {
            uprights[i] = scene.Body($"v{i}", At(i, 0) + up * 0.5);
            JointPlace place = scene.Hinge(uprights[i], null, At(i, 0), Z);
            first = i == 0 ? place : first;
        }

        for (int i = 0; i < n; i++)
        {
            int over = scene.Body($"h{i}", At(i + 0.5, 0) + up);
            scene.Hinge(over, uprights[i], At(i, 0) + up, Z);
            if (minimalClosure)
            {
                scene.Configurable(over, uprights[i + 1], At(i + 1, 0) + up, Vector3d.UnitX, Vector3d.UnitY, "LLFFFF", closure: true);
            }
            else
            {
                scene.Hinge(over, uprights[i + 1], At(i + 1, 0) + up, Z, closure: true);
            }
        }

        return (scene, first);
    }

    /// <summary>Open chain of n links of 0.1, bent a little at each hinge.</summary>
    public static (MechanismScene Scene, JointPlace First, int Last, Vector3d Tip) Chain(int n)
    {
        var scene = new MechanismScene();
        Vector3d at = Vector3d.Zero;
        JointPlace first = default;
        int? previous = null;
        for (int i = 0; i < n; i++)
        {
            Vector3d next = at + Polar(0.1, i % 2 == 0 ? 20 : -15);
            int link = scene.Body($"link{i}", (at + next) * 0.5);
            JointPlace place = scene.Hinge(link, previous, at, Z);
            first = i == 0 ? place : first;
            previous = link;
            at = next;
        }

        return (scene, first, previous ?? 0, at);
    }

    /// <summary>The paper's mechanism: lever, shaft and panel as one body, bar C, slider D; lengths in dm taken for m.</summary>
    public static (MechanismScene Scene, JointPlace Lever, JointPlace Slider) PaperLever(double leverDegrees, bool withParts)
    {
        var scene = new MechanismScene();
        Vector3d pin = Polar(0.25, leverDegrees);
        Vector3d end = At(pin.X + Math.Sqrt(0.81 - pin.Y * pin.Y), 0);
        int shaft = scene.Body("shaft", Vector3d.Zero);
        JointPlace lever = scene.Hinge(shaft, null, new Vector3d(0, 0, 0.1), Z);
        if (withParts)
        {
            scene.Fixed(scene.Body("lever", Polar(1.2, leverDegrees)), shaft);
            int panel = scene.Body("panel", pin);
            scene.Fixed(panel, shaft);
        }

        int bar = scene.Body("bar", (pin + end) * 0.5);
        int slider = scene.Body("slider", end);
        scene.Hinge(bar, withParts ? 2 : shaft, pin, Z);
        JointPlace slide = scene.Slide(slider, null, end, Vector3d.UnitX);
        scene.Configurable(bar, slider, end, Vector3d.UnitX, Vector3d.UnitY, "LLFFFF", closure: true);
        return (scene, lever, slide);
    }
}
