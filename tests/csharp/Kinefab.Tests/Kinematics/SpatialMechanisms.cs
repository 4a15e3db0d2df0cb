using System;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Tests.Kinematics;

/// <summary>Spatial mechanisms with known motion.</summary>
internal static class SpatialMechanisms
{
    private const double Radians = Math.PI / 180;

    /// <summary>Sarrus: two folding legs of 1 + 1, hinges along x and along y; leg 1 stands at phi from the ground.</summary>
    public static (MechanismScene Scene, JointPlace Leg, int Platform) Sarrus(double phi)
    {
        var scene = new MechanismScene();
        double c = Math.Cos(phi * Radians);
        double s = Math.Sin(phi * Radians);
        int platform = scene.Body("platform", new Vector3d(0, 0, 2 * s));
        JointPlace drive = Leg(Vector3d.UnitX, Vector3d.UnitY, "1");
        Leg(-Vector3d.UnitY, Vector3d.UnitX, "2");
        return (scene, drive, platform);

        // A positive turn about the axis lifts the knee that lies outwards.
        JointPlace Leg(Vector3d axis, Vector3d outwards, string name)
        {
            Vector3d foot = outwards * 0.5;
            Vector3d knee = foot + outwards * c + new Vector3d(0, 0, s);
            Vector3d head = foot + new Vector3d(0, 0, 2 * s);
            int lower = scene.Body("lower" + name, (foot + knee) * 0.5);
            int upper = scene.Body("upper" + name, (knee + head) * 0.5);
            JointPlace place = scene.Hinge(lower, null, foot, axis);
            scene.Hinge(upper, lower, knee, axis);
            scene.Hinge(platform, upper, head, axis);
            return place;
        }
    }

    /// <summary>Bennett's linkage by Denavit-Hartenberg, a = 1, alpha = 30, beta = 70 degrees.</summary>
    public static (MechanismScene Scene, JointPlace First, JointPlace Second) Bennett(double theta1)
    {
        const double alpha = 30, beta = 70;
        double b = Math.Sin(beta * Radians) / Math.Sin(alpha * Radians);
        double k = Math.Sin((beta + alpha) / 2 * Radians) / Math.Sin((beta - alpha) / 2 * Radians);
        double theta2 = 2 * Math.Atan(k / Math.Tan(theta1 / 2 * Radians)) / Radians;
        Pose f1 = Step(Pose.Identity, theta1, 1, alpha);
        Pose f2 = Step(f1, theta2, b, beta);
        Pose f3 = Step(f2, -theta1, 1, alpha);
        var scene = new MechanismScene();
        int link1 = scene.Body("link1", f1.Position * 0.5);
        int link2 = scene.Body("link2", f2.Position);
        int link3 = scene.Body("link3", f3.Position);
        JointPlace first = scene.Hinge(link1, null, Vector3d.Zero, Vector3d.UnitZ);
        JointPlace second = scene.Hinge(link2, link1, f1.Position, f1.Rotation * Vector3d.UnitZ);
        scene.Hinge(link3, link2, f2.Position, f2.Rotation * Vector3d.UnitZ);
        scene.Hinge(link3, null, f3.Position, f3.Rotation * Vector3d.UnitZ, closure: true);
        return (scene, first, second);
    }

    /// <summary>Rectangular Bricard: six hinges at the corners of a unit cube's edge path; the first about y drives.</summary>
    public static (MechanismScene Scene, JointPlace First, int Second, Vector3d P3) Bricard()
    {
        Vector3d[] points = [new(0, 0, 0), new(1, 0, 0), new(1, -1, 0), new(1, -1, 1), new(0, -1, 1), new(0, 0, 1)];
        Vector3d[] axes = [Vector3d.UnitY, Vector3d.UnitZ, Vector3d.UnitX, Vector3d.UnitY, Vector3d.UnitZ, Vector3d.UnitX];
        var scene = new MechanismScene();
        int? previous = null;
        JointPlace first = default;
        for (int i = 0; i < 5; i++)
        {
            int rod = scene.Body($"rod{i}", (points[i] + points[i + 1]) * 0.5);
            JointPlace place = scene.Hinge(rod, previous, points[i], axes[i]);
            first = i == 0 ? place : first;
            previous = rod;
        }

        scene.Hinge(4, null, points[5], axes[5], closure: true);
        return (scene, first, 1, points[2]);
    }

    /// <summary>Cardan joint of four hinges, shafts 30 degrees apart; the first pin starts at right angles to both shafts.</summary>
    public static (MechanismScene Scene, JointPlace In, JointPlace Out) Cardan(bool minimal)
    {
        var scene = new MechanismScene();
        var shaft = new Vector3d(Math.Cos(30 * Radians), Math.Sin(30 * Radians), 0);
        var pin = new Vector3d(-shaft.Y, shaft.X, 0);
        int input = scene.Body("in", -Vector3d.UnitX);
        JointPlace drive = scene.Hinge(input, null, -Vector3d.UnitX, Vector3d.UnitX);
        if (minimal)
        {
            // X is the pin on the connected body, Z the one on the own body.
            int free = scene.Body("out", shaft);
            scene.Configurable(free, input, Vector3d.Zero, Vector3d.UnitZ, Vector3d.Cross(pin, Vector3d.UnitZ), "LLLFLF");
            JointPlace bearing = scene.Configurable(free, null, shaft, shaft, Vector3d.UnitZ, "FFFFLL", closure: true);
            return (scene, drive, bearing);
        }

        int cross = scene.Body("cross", Vector3d.Zero);
        int output = scene.Body("out", shaft);
        scene.Hinge(cross, input, Vector3d.Zero, Vector3d.UnitZ);
        scene.Hinge(output, cross, Vector3d.Zero, pin);
        JointPlace driven = scene.Hinge(output, null, shaft, shaft, closure: true);
        return (scene, drive, driven);
    }

    /// <summary>Corners k of a hexagon on a circle in the plane z, at 120 k +- the half angle given about the corner's middle.</summary>
    public static Vector3d[] Hexagon(double radius, double middle, double half, double z)
    {
        var corners = new Vector3d[6];
        for (int k = 0; k < 6; k++)
        {
            double degrees = 120 * (k / 2) + middle + (k % 2 == 0 ? -half : half);
            corners[k] = new Vector3d(radius * Math.Cos(degrees * Radians), radius * Math.Sin(degrees * Radians), z);
        }

        return corners;
    }

    /// <summary>Stewart platform with legs universal-slide-ball (or ball-slide-ball).</summary>
    public static (MechanismScene Scene, int Platform, JointPlace[] Legs) Stewart(bool withUniversals)
    {
        Vector3d[] feet = Hexagon(1, 0, 10, 0);
        Vector3d[] heads = [
            Corner(0.6, -50, 1.2), Corner(0.6, 50, 1.2), Corner(0.6, 70, 1.2), Corner(0.6, 170, 1.2), Corner(0.6, 190, 1.2), Corner(0.6, 290, 1.2)];
        var scene = new MechanismScene();
        int platform = scene.Body("platform", new Vector3d(0, 0, 1.2));
        var legs = new JointPlace[6];
        for (int k = 0; k < 6; k++)
        {
            Vector3d along = (heads[k] - feet[k]).Normalized();
            int lower = scene.Body($"lower{k}", feet[k] + along * 0.3);
            int upper = scene.Body($"upper{k}", heads[k] - along * 0.3);
            if (withUniversals)
            {
                Universal(scene, lower, null, feet[k], along);
            }
            else
            {
                scene.Ball(lower, null, feet[k]);
            }

            legs[k] = scene.Slide(upper, lower, feet[k] + along * 0.6, along);
            scene.Ball(platform, upper, heads[k]);
        }

        return (scene, platform, legs);
    }

    /// <summary>A platform on six rods of fixed length between given corners.</summary>
    public static (MechanismScene Scene, int Platform) Rods(Vector3d[] feet, Vector3d[] heads)
    {
        var scene = new MechanismScene();
        Vector3d sum = Vector3d.Zero;
        foreach (Vector3d head in heads)
        {
            sum += head;
        }

        int platform = scene.Body("platform", sum * (1.0 / heads.Length));
        for (int k = 0; k < feet.Length; k++)
        {
            Rod(scene, $"rod{k}", null, feet[k], platform, heads[k]);
        }

        return (scene, platform);
    }

    /// <summary>A rod between two points: universal at the first end, ball at the second.</summary>
    public static void Rod(MechanismScene scene, string id, int? first, Vector3d from, int second, Vector3d to)
    {
        int rod = scene.Body(id, (from + to) * 0.5);
        Universal(scene, rod, first, from, (to - from).Normalized());
        scene.Ball(rod, second, to);
    }

    /// <summary>Delta robot: base radius 0.2, platform 0.05, arms 0.2 at 30 degrees below the horizontal, rods 0.4 in pairs 0.06 apart.</summary>
    public static (MechanismScene Scene, int Platform, JointPlace[] Arms) Delta(bool withBalls)
    {
        const double z = -0.3356660259;
        var scene = new MechanismScene();
        int platform = scene.Body("platform", new Vector3d(0, 0, z));
        var arms = new JointPlace[3];
        for (int k = 0; k < 3; k++)
        {
            double turn = 120 * k * Radians;
            var radial = new Vector3d(Math.Cos(turn), Math.Sin(turn), 0);
            var tangent = new Vector3d(-Math.Sin(turn), Math.Cos(turn), 0);
            Vector3d shoulder = radial * 0.2;
            Vector3d elbow = shoulder + radial * (0.2 * Math.Cos(30 * Radians)) - Vector3d.UnitZ * (0.2 * Math.Sin(30 * Radians));
            // Exactly above the platform's place: the rods' length in closed form, not the rounded height.
            double reach = elbow.Length > 0 ? 0.2 + 0.2 * Math.Cos(30 * Radians) - 0.05 : 0;
            Vector3d wrist = radial * 0.05 + new Vector3d(0, 0, elbow.Z - Math.Sqrt(0.16 - reach * reach));
            int arm = scene.Body($"arm{k}", shoulder);
            arms[k] = scene.Hinge(arm, null, shoulder, tangent);
            foreach (double side in new[] { -0.03, 0.03 })
            {
                if (withBalls)
                {
                    int rod = scene.Body($"rod{k}{side}", (elbow + wrist) * 0.5);
                    scene.Ball(rod, arm, elbow + tangent * side);
                    scene.Ball(rod, platform, wrist + tangent * side);
                }
                else
                {
                    Rod(scene, $"rod{k}{side}", arm, elbow + tangent * side, platform, wrist + tangent * side);
                }
            }
        }

        return (scene, platform, arms);
    }

    /// <summary>3-RPS: hinged legs with a slide and a ball under the platform.</summary>
    public static MechanismScene Rps()
    {
        var scene = new MechanismScene();
        int platform = scene.Body("platform", Vector3d.UnitZ);
        for (int k = 0; k < 3; k++)
        {
            double turn = 120 * k * Radians;
            var radial = new Vector3d(Math.Cos(turn), Math.Sin(turn), 0);
            var tangent = new Vector3d(-Math.Sin(turn), Math.Cos(turn), 0);
            Vector3d head = radial * 0.6 + Vector3d.UnitZ;
            int lower = scene.Body($"lower{k}", radial);
            int upper = scene.Body($"upper{k}", head);
            scene.Hinge(lower, null, radial, tangent);
            scene.Slide(upper, lower, (radial + head) * 0.5, head - radial);
            scene.Ball(platform, upper, head);
        }

        return scene;
    }

    /// <summary>RCCC: one hinge and three cylindrical joints on axes in general position.</summary>
    public static MechanismScene Rccc()
    {
        var scene = new MechanismScene();
        int a = scene.Body("a", new Vector3d(0.5, 0, 0));
        int c = scene.Body("c", new Vector3d(1.5, 0.6, 0.3));
        int b = scene.Body("b", new Vector3d(0.4, 1.3, 0.2));
        scene.Hinge(a, null, Vector3d.Zero, new Vector3d(0.1, 0.2, 1));
        Cylindrical(a, c, new Vector3d(1, 0.1, 0.2), new Vector3d(0.5, -0.3, 0.8));
        Cylindrical(c, b, new Vector3d(1.2, 1.1, 0.1), new Vector3d(-0.6, 0.7, 0.4));
        Cylindrical(b, null, new Vector3d(0.1, 1, -0.2), new Vector3d(0.2, -0.5, 0.9));
        return scene;

        void Cylindrical(int own, int? connected, Vector3d point, Vector3d axis) =>
            scene.Configurable(own, connected, point, axis, Vector3d.Perpendicular(axis.Normalized()), "FLLFLL");
    }

    /// <summary>Arm of six hinges on axes in general position.</summary>
    public static (MechanismScene Scene, JointPlace[] Joints) Arm(double limit = 0)
    {
        var scene = new MechanismScene();
        Vector3d[] axes = [Vector3d.UnitZ, Vector3d.UnitY, Vector3d.UnitY, Vector3d.UnitX, Vector3d.UnitY, Vector3d.UnitX];
        var joints = new JointPlace[6];
        int? previous = null;
        for (int i = 0; i < 6; i++)
        {
            var at = new Vector3d(0.4 * i, 0.03 * i * i, 0.2 + 0.02 * i * i);
            int link = scene.Body($"link{i}", at + new Vector3d(0.2, 0, 0));
            joints[i] = scene.Hinge(link, previous, at, axes[i], -limit, limit);
            previous = link;
        }

        return (scene, joints);
    }

    private static void Universal(MechanismScene scene, int own, int? connected, Vector3d point, Vector3d along)
    {
        Vector3d side = Vector3d.Perpendicular(along);
        scene.Configurable(own, connected, point, side, along, "LLLFLF");
    }

    private static Vector3d Corner(double radius, double degrees, double z) =>
        new(radius * Math.Cos(degrees * Radians), radius * Math.Sin(degrees * Radians), z);

    private static Pose Step(Pose from, double theta, double a, double alpha) =>
        from
        * new Pose(Vector3d.Zero, Quaterniond.AxisAngle(Vector3d.UnitZ, theta * Radians))
        * new Pose(new Vector3d(a, 0, 0), Quaterniond.AxisAngle(Vector3d.UnitX, alpha * Radians));
}
