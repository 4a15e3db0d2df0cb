using System;
using System.Collections.Generic;
using System.Numerics;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Builds the benchmarks at their initial states.</summary>
internal static class BenchmarkMechanisms
{
    private static readonly Vector3d Z = Vector3d.UnitZ;

    /// <summary>B1: a 1 kg point on a 1 m arm, from the horizontal.</summary>
    public static BenchmarkMechanism Pendulum()
    {
        var b = new MechanismBuilder();
        int bob = b.Body(new Vector3d(-1, 0, 0), Quaterniond.Identity, 1, new Vector3d(1, 1, 1) * 1e-9);
        b.Hinge(JointModel.World, bob, Vector3d.Zero, Z);
        return new BenchmarkMechanism("B1", b, m => new[] { ("x", m.Bodies.Poses[0].Position.X), ("y", m.Bodies.Poses[0].Position.Y) });
    }

    /// <summary>B2: n four-bar windows of 1 m, 1 kg rods, the horizontals moving at 1 m/s.</summary>
    public static BenchmarkMechanism Windows(int n)
    {
        var b = new MechanismBuilder();
        int last = -1;
        int lastHorizontal = -1;
        for (int i = 0; i <= n; i++)
        {
            var foot = new Vector3d(i, 0, 0);
            Vector3d head = foot + Vector3d.UnitY;
            int vertical = Rod(b, foot, head, 1);
            b.Change(vertical, d =>
            {
                d.LinearVelocity = new Vector3d(0.5, 0, 0);
                d.AngularVelocity = new Vector3d(0, 0, -1);
                return d;
            });
            b.Hinge(JointModel.World, vertical, foot, Z);
            if (last >= 0)
            {
                int horizontal = Rod(b, head - Vector3d.UnitX, head, 1);
                b.Change(horizontal, d =>
                {
                    d.LinearVelocity = Vector3d.UnitX;
                    return d;
                });
                b.Hinge(last, horizontal, head - Vector3d.UnitX, Z);
                b.Hinge(horizontal, vertical, head, Z);
                lastHorizontal = horizontal;
            }

            last = vertical;
        }

        _ = lastHorizontal;
        return new BenchmarkMechanism($"B2_N{n}", b, m =>
        {
            Vector3d head = m.Bodies.Poses[0].Point(new Vector3d(0.5, 0, 0));
            return new[] { ("B0x", head.X), ("B0y", head.Y) };
        });
    }

    /// <summary>B3: Andrews' squeezing mechanism.</summary>
    public static BenchmarkMechanism Squeezer()
    {
        const double d = .028, da = .0115, e = .02, ea = .01421, fa = .01421, rr = .007, ra = .00092, sa = .01874,
            sb = .01043, sc = .018, sd = .02, ta = .02308, tb = .00916, u = .04, ua = .01228, ub = .00449, zf = .02, zt = .04;
        double[] mass = { .04325, .00365, .02373, .00706, .07050, .00706, .05498 };
        double[] inertia = { 2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5 };
        double beta = -.0617138900142764496, theta = 0, gamma = .455279819163070380, phi = .222668390165885885,
            delta = .487364979543842550, omega = -.222668390165885885, epsilon = 1.23054744454982119;
        Complex i = Complex.ImaginaryOne;
        var a = new Complex(-.06934, -.00227);
        var bPoint = new Complex(-.03635, .03273);
        Complex[] centers =
        {
            ra * E(beta),
            rr * E(beta) - da * E(beta + theta),
            bPoint + (sb - i * sa) * E(gamma),
            a + zt * E(delta) - i * (e - ea) * E(phi + delta),
            a + (ta + i * tb) * E(delta),
            a - i * u * E(epsilon) + (zf - fa) * E(omega + epsilon),
            a - (ub + i * ua) * E(epsilon),
        };
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        for (int k = 0; k < 7; k++)
        {
            b.Body(P(centers[k]), Quaterniond.Identity, mass[k], new Vector3d(1, 1, 1) * inertia[k]);
        }

        Vector3d squeezed = P(rr * E(beta) - d * E(beta + theta));
        b.Hinge(JointModel.World, 0, Vector3d.Zero, Z);
        b.Hinge(0, 1, P(rr * E(beta)), Z);
        b.Hinge(1, 2, squeezed, Z);
        b.Hinge(1, 3, squeezed, Z);
        b.Hinge(1, 5, squeezed, Z);
        b.Hinge(JointModel.World, 2, P(bPoint), Z);
        b.Hinge(3, 4, P(a + zt * E(delta)), Z);
        b.Hinge(JointModel.World, 4, P(a), Z);
        b.Hinge(5, 6, P(a - i * u * E(epsilon)), Z);
        b.Hinge(JointModel.World, 6, P(a), Z);

        // The spring from C to D on K3; its ends differ, so its frames are set one by one.
        var spring = new DistanceSpring { Length = .07785, Stiffness = 4530 };
        b.Add(spring, JointModel.World, 2, new Pose(P(new Complex(.014, .072)), Quaterniond.Identity));
        spring.Frame1 = new Pose(P(bPoint + (sd - i * sc) * E(gamma)) - P(centers[2]), Quaterniond.Identity);
        double turned = 0;
        double lastAngle = 0;
        return new BenchmarkMechanism("B3", b, m => new[]
        {
            ("beta", beta + Unwrapped(Angle(m, 0))),
            ("gamma", gamma + Angle(m, 2)),
            ("epsilon", epsilon + Angle(m, 6)),
        })
        {
            Drive = m =>
            {
                m.Bodies.Torques[0] = new Vector3d(0, 0, .033);
                Unwrapped(Angle(m, 0));
            },
        };

        double Unwrapped(double angle)
        {
            turned += Math.IEEERemainder(angle - lastAngle, 2 * Math.PI);
            lastAngle = angle;
            return turned;
        }

        static Complex E(double x) => Complex.FromPolarCoordinates(1, x);

        static Vector3d P(Complex c) => new(c.Real, c.Imaginary, 0);
    }

    /// <summary>B4: a Bricard loop of five rods and six hinges, one constraint redundant.</summary>
    public static BenchmarkMechanism Bricard()
    {
        Vector3d[] points = { new(0, 0, 0), new(1, 0, 0), new(1, -1, 0), new(1, -1, 1), new(0, -1, 1), new(0, 0, 1) };
        Vector3d[] axes = { Vector3d.UnitY, Z, Vector3d.UnitX, Vector3d.UnitY, Z, Vector3d.UnitX };
        var b = new MechanismBuilder();
        for (int i = 0; i < 5; i++)
        {
            b.Bar(points[i], points[i + 1], 1, 0.1);
        }

        for (int i = 0; i < 6; i++)
        {
            b.Hinge(i == 0 ? JointModel.World : i - 1, i == 5 ? JointModel.World : i, points[i], axes[i]);
        }

        return new BenchmarkMechanism("B4", b, m =>
        {
            Vector3d p = m.Bodies.Poses[1].Point(new Vector3d(0.5, 0, 0));
            return new[] { ("P3x", p.X), ("P3y", p.Y), ("P3z", p.Z) };
        });
    }

    /// <summary>B5: a flyball governor with stiff spring-dampers, z up.</summary>
    public static BenchmarkMechanism Governor()
    {
        var b = new MechanismBuilder { Gravity = new Vector3d(0, 0, -9.81) };
        const double spin = 2 * Math.PI;
        const double down = Math.PI / 6;
        const double across = .3 * (1 + .01 * .01) / 12, axial = .3 * .01 * .01 / 6;
        int shaft = b.Body(Spinning(new Vector3d(0, 0, .5), Quaterniond.Identity, .3, new Vector3d(across, across, axial)));
        int slider = b.Body(Spinning(new Vector3d(0, 0, .5), Quaterniond.Identity, 3, new Vector3d(1, 1, 1) * (3 * .01 / 6)));
        b.Hinge(JointModel.World, shaft, Vector3d.Zero, Z);
        b.Add(new D6Joint { X = AxisMotion.Free }, shaft, slider, new Vector3d(0, 0, .5), Z);
        foreach (int side in new[] { 1, -1 })
        {
            var pivot = new Vector3d(side * .05, 0, 1);
            Vector3d along = new Vector3d(side * Math.Cos(down), 0, -Math.Sin(down));

            // Rod and the 5 kg point at its tip, as one body.
            const double mass = 5.3, center = (.3 * .5 + 5) / mass;
            double offset = 5 * (1 - center) * (1 - center) + .3 * (center - .5) * (center - .5);
            Vector3d y = Vector3d.UnitY;
            var rotation = Quaterniond.FromAxes(along, y, Vector3d.Cross(along, y));
            int rod = b.Body(Spinning(pivot + along * center, rotation, mass, new Vector3d(axial, across + offset, across + offset)));
            b.Hinge(shaft, rod, pivot, Vector3d.UnitY);
            var spring = b.Add(
                new DistanceSpring { Length = .5, Stiffness = 8e5, Damping = 4e4 }, slider, rod, pivot, Z);
            spring.Frame0 = new Pose(new Vector3d(side * .05, 0, 0), Quaterniond.Identity);
            spring.Frame1 = new Pose(new Vector3d(.5 - center, 0, 0), Quaterniond.Identity);
        }

        double turned = 0;
        double lastAngle = 0;
        return new BenchmarkMechanism("B5", b, m => new[] { ("s", m.Bodies.Poses[slider].Position.Z), ("shaft_angle", Turned(m)) })
        {
            Drive = m => Turned(m),
        };

        double Turned(MultibodySystem m)
        {
            double angle = Angle(m, shaft);
            turned += Math.IEEERemainder(angle - lastAngle, 2 * Math.PI);
            lastAngle = angle;
            return turned;
        }

        static BodyDefinition Spinning(Vector3d position, Quaterniond rotation, double mass, Vector3d inertia)
        {
            BodyDefinition d = BodyDefinition.Default;
            d.Pose = new Pose(position, rotation);
            d.Mass = mass;
            d.Inertia = inertia;
            d.AngularVelocity = new Vector3d(0, 0, spin);
            d.LinearVelocity = Vector3d.Cross(d.AngularVelocity, position);
            return d;
        }
    }

    /// <summary>B7: two uniform 1 m, 1 kg rods from the horizontal.</summary>
    public static BenchmarkMechanism DoublePendulum()
    {
        var b = new MechanismBuilder();
        Rod(b, Vector3d.Zero, Vector3d.UnitX, 1);
        Rod(b, Vector3d.UnitX, Vector3d.UnitX * 2, 1);
        b.Hinge(JointModel.World, 0, Vector3d.Zero, Z);
        b.Hinge(0, 1, Vector3d.UnitX, Z);
        return new BenchmarkMechanism("B7", b, m =>
        {
            Vector3d tip = m.Bodies.Poses[1].Point(new Vector3d(0.5, 0, 0));
            return new[] { ("tip_x", tip.X), ("tip_y", tip.Y) };
        });
    }

    /// <summary>B9: a free body that spins about its middle axis.</summary>
    public static BenchmarkMechanism Flip()
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int body = b.Body(Vector3d.Zero, Quaterniond.Identity, 1, new Vector3d(1, 2, 3));
        b.Change(body, d =>
        {
            d.AngularVelocity = new Vector3d(.01, 2, .01);
            return d;
        });
        return new BenchmarkMechanism("B9", b, m =>
        {
            Vector3d w = m.Bodies.Poses[0].Rotation.InverseRotate(m.Bodies.AngularVelocities[0]);
            return new[] { ("w1", w.X), ("w2", w.Y), ("w3", w.Z) };
        });
    }

    /// <summary>B10: a four-bar of 0.4, 1.2, 0.8 and 1 m, 1 kg/m, from rest at 60 degrees.</summary>
    public static BenchmarkMechanism FourBar()
    {
        var b = new MechanismBuilder();
        var a = new Vector3d(.4 * Math.Cos(Math.PI / 3), .4 * Math.Sin(Math.PI / 3), 0);
        var d = new Vector3d(1, 0, 0);

        // The pin of coupler and rocker on the open branch: circles of 1.2 m about a, 0.8 m about d.
        Vector3d ad = d - a;
        double distance = ad.Length;
        double along = (distance * distance + 1.2 * 1.2 - .8 * .8) / (2 * distance);
        double height = Math.Sqrt(1.2 * 1.2 - along * along);
        Vector3d u = ad * (1 / distance);
        Vector3d pin = a + u * along + new Vector3d(-u.Y, u.X, 0) * height;
        Rod(b, Vector3d.Zero, a, .4);
        Rod(b, a, pin, 1.2);
        Rod(b, d, pin, .8);
        b.Hinge(JointModel.World, 0, Vector3d.Zero, Z);
        b.Hinge(0, 1, a, Z);
        b.Hinge(1, 2, pin, Z);
        b.Hinge(JointModel.World, 2, d, Z);
        return new BenchmarkMechanism("B10", b, m =>
        {
            Vector3d p = m.Bodies.Poses[2].Point(new Vector3d(.4, 0, 0));
            return new[] { ("Bx", p.X), ("By", p.Y) };
        });
    }

    /// <summary>B11: the lever's slider-crank, r = 25 mm, l = 90 mm, under 0.05 N m from 30 degrees.</summary>
    public static BenchmarkMechanism Lever()
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        const double angle = Math.PI / 6;
        var pin = new Vector3d(.025 * Math.Cos(angle), .025 * Math.Sin(angle), 0);
        var end = new Vector3d(pin.X + Math.Sqrt(.09 * .09 - pin.Y * pin.Y), 0, 0);
        int rotor = b.Body(Vector3d.Zero, Quaterniond.Identity, 1, new Vector3d(1, 1, 1) * 1.2e-3);
        int bar = Rod(b, pin, end, .15);
        int slider = b.Body(end, Quaterniond.Identity, .3, new Vector3d(1, 1, 1) * 1e-4);
        b.Hinge(JointModel.World, rotor, Vector3d.Zero, Z);
        b.Hinge(rotor, bar, pin, Z);
        b.Hinge(bar, slider, end, Z);
        b.Add(new D6Joint { X = AxisMotion.Free }, JointModel.World, slider, end, Vector3d.UnitX);
        double turned = angle;
        double lastAngle = 0;
        return new BenchmarkMechanism("B11", b, m => new[] { ("lever", Turned(m)), ("slider_x", m.Bodies.Poses[slider].Position.X) })
        {
            Drive = m =>
            {
                m.Bodies.Torques[rotor] = new Vector3d(0, 0, .05);
                Turned(m);
            },
        };

        double Turned(MultibodySystem m)
        {
            double now = Angle(m, rotor);
            turned += Math.IEEERemainder(now - lastAngle, 2 * Math.PI);
            lastAngle = now;
            return turned;
        }
    }

    // A slender rod; its moment about its own axis, which no planar motion feels, is that across.
    private static int Rod(MechanismBuilder b, Vector3d from, Vector3d to, double mass)
    {
        Vector3d x = (to - from).Normalized();
        Vector3d y = Vector3d.Perpendicular(x);
        double across = mass * (to - from).LengthSquared / 12;
        return b.Body((from + to) * 0.5, Quaterniond.FromAxes(x, y, Vector3d.Cross(x, y)), mass, new Vector3d(1, 1, 1) * across);
    }

    // Turn about Z against the world's axes, (-pi, pi].
    private static double Angle(MultibodySystem m, int body)
    {
        Quaterniond q = m.Bodies.Poses[body].Rotation;
        return 2 * Math.Atan2(q.Z, q.W) is var angle && angle > Math.PI ? angle - 2 * Math.PI : angle <= -Math.PI ? angle + 2 * Math.PI : angle;
    }
}
