using System;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>The scenes by which solvers are compared: closed loops, chains, a motor, mass ratios, singular and inconsistent loops.</summary>
internal static class SolverScenes
{
    private static readonly Vector3d Z = Vector3d.UnitZ;

    /// <summary>Crank-rockers of 1.0 (ground), 0.4, 0.9 and 0.7 m, 1 kg a link, each released at another crank angle.</summary>
    public static MultibodySystem FourBars(int count, double tilt = 0)
    {
        var builder = new MechanismBuilder();
        for (int i = 0; i < count; i++)
        {
            FourBar(builder, new Vector3d(0, 0, i), 1.0, 0.4, 0.9, 0.7, 1.0 + 0.003 * i, tilt);
        }

        return builder.Build();
    }

    /// <summary>Double pendulums of two 1 m, 1 kg bars, released near the horizontal.</summary>
    public static MultibodySystem DoublePendulums(int count)
    {
        var builder = new MechanismBuilder();
        for (int i = 0; i < count; i++)
        {
            double angle = 0.0005 * i;
            var direction = new Vector3d(Math.Cos(angle), Math.Sin(angle), 0);
            var origin = new Vector3d(0, 0, i);
            int upper = builder.Bar(origin, origin + direction, 1);
            int lower = builder.Bar(origin + direction, origin + direction * 2, 1);
            builder.Hinge(JointModel.World, upper, origin, Z);
            builder.Hinge(upper, lower, origin + direction, Z);
        }

        return builder.Build();
    }

    /// <summary>Bars of 0.2 m and 1 kg, released horizontal.</summary>
    public static MultibodySystem Chain(int links)
    {
        var builder = new MechanismBuilder();
        int last = JointModel.World;
        for (int i = 0; i < links; i++)
        {
            int bar = builder.Bar(new Vector3d(0.2 * i, 0, 0), new Vector3d(0.2 * (i + 1), 0, 0), 1);
            builder.Hinge(last, bar, new Vector3d(0.2 * i, 0, 0), Z);
            last = bar;
        }

        return builder.Build();
    }

    /// <summary>The same bars hanging straight down, the lowest given a push: nothing whips, every step is a plain one.</summary>
    public static MultibodySystem HangingChain(int links) => HangingChains(1, links);

    /// <summary>Several of them, each an island.</summary>
    public static MultibodySystem HangingChains(int count, int links)
    {
        var builder = new MechanismBuilder();
        for (int chain = 0; chain < count; chain++)
        {
            int last = JointModel.World;
            for (int i = 0; i < links; i++)
            {
                int bar = builder.Bar(new Vector3d(0, -0.2 * i, chain), new Vector3d(0, -0.2 * (i + 1), chain), 1);
                builder.Hinge(last, bar, new Vector3d(0, -0.2 * i, chain), Z);
                last = bar;
            }

            builder.Change(last, d =>
            {
                d.LinearVelocity = new Vector3d(0.1, 0, 0);
                d.AngularVelocity = new Vector3d(0, 0, 1);
                return d;
            });
        }

        return builder.Build();
    }

    /// <summary>Seven links of 0.1 kg with a payload of 10 kg at the end, released horizontal.</summary>
    public static MultibodySystem Heavy8()
    {
        var builder = new MechanismBuilder();
        int last = JointModel.World;
        for (int i = 0; i < 8; i++)
        {
            int bar = builder.Bar(new Vector3d(0.2 * i, 0, 0), new Vector3d(0.2 * (i + 1), 0, 0), i == 7 ? 10 : 0.1);
            builder.Hinge(last, bar, new Vector3d(0.2 * i, 0, 0), Z);
            last = bar;
        }

        return builder.Build();
    }

    /// <summary>Crank 0.3 m, rod 0.8 m, slider on the X axis; the crank's motor holds 2 pi rad/s with up to 1000 N m.</summary>
    public static MultibodySystem SliderCrank()
    {
        var builder = new MechanismBuilder();
        const double angle = 0.5;
        var crankEnd = new Vector3d(0.3 * Math.Cos(angle), 0.3 * Math.Sin(angle), 0);
        var pin = new Vector3d(crankEnd.X + Math.Sqrt(0.8 * 0.8 - crankEnd.Y * crankEnd.Y), 0, 0);
        int crank = builder.Bar(Vector3d.Zero, crankEnd, 1);
        int rod = builder.Bar(crankEnd, pin, 1);
        int slider = builder.Body(pin, Quaterniond.Identity, 1, new Vector3d(0.01, 0.01, 0.01));
        RevoluteJoint motor = builder.Hinge(JointModel.World, crank, Vector3d.Zero, Z);
        motor.MotorEnabled = true;
        motor.MotorVelocity = 2 * Math.PI;
        motor.MotorForceLimit = 1000;
        builder.Hinge(crank, rod, crankEnd, Z);
        builder.Hinge(rod, slider, pin, Z);
        builder.Add(new D6Joint { X = AxisMotion.Free }, JointModel.World, slider, pin, Vector3d.UnitX);
        return builder.Build();
    }

    /// <summary>A parallelogram of 0.4 m cranks driven through its change points, where the loop is singular.</summary>
    public static MultibodySystem Parallelogram()
    {
        var builder = new MechanismBuilder();
        (RevoluteJoint crank, _) = FourBar(builder, Vector3d.Zero, 1.0, 0.4, 1.0, 0.4, 1.0, 0);
        crank.MotorEnabled = true;
        crank.MotorVelocity = 2 * Math.PI;
        crank.MotorForceLimit = 1000;
        return builder.Build();
    }

    private static (RevoluteJoint Crank, RevoluteJoint Rocker) FourBar(
        MechanismBuilder builder, Vector3d origin, double ground, double crank, double coupler, double rocker, double angle, double tilt)
    {
        Vector3d a = origin;
        Vector3d d = origin + new Vector3d(ground, 0, 0);
        Vector3d b = a + new Vector3d(crank * Math.Cos(angle), crank * Math.Sin(angle), 0);

        // The coupler-rocker pin above the line from b to d.
        Vector3d bd = d - b;
        double distance = bd.Length;
        double along = (distance * distance + coupler * coupler - rocker * rocker) / (2 * distance);
        double height = Math.Sqrt(coupler * coupler - along * along);
        Vector3d u = bd * (1 / distance);
        Vector3d c = b + u * along + new Vector3d(-u.Y, u.X, 0) * height;
        int crankBody = builder.Bar(a, b, 1);
        int couplerBody = builder.Bar(b, c, 1);
        int rockerBody = builder.Bar(d, c, 1);
        RevoluteJoint first = builder.Hinge(JointModel.World, crankBody, a, Z);
        builder.Hinge(crankBody, couplerBody, b, Z);
        builder.Hinge(couplerBody, rockerBody, c, new Vector3d(Math.Sin(tilt), 0, Math.Cos(tilt)));
        RevoluteJoint last = builder.Hinge(JointModel.World, rockerBody, d, Z);
        return (first, last);
    }
}
