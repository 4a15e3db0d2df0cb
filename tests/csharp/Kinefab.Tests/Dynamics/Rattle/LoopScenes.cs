using System;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Loops that softly held axes would let move: some because an axis is off, some because they stand near a singular pose. All are closed to rounding.
/// </summary>
internal static class LoopScenes
{
    /// <summary>
    /// A crank-rocker whose crank carries an elbow: two arms on a hinge between two balls, which can turn about the line through these and no more.
    /// The hinge's axis is any, so that some elbows nearly bend.
    /// </summary>
    /// <param name="seed">Of the elbow.</param>
    /// <param name="tilt">Of an axis of the crank-rocker, rad; null: without one, the crank turns on its hinge.</param>
    public static MultibodySystem Elbow(int seed, double? tilt)
    {
        var random = new Random(seed);
        var b = new MechanismBuilder();
        var end = new Vector3d(0.4 * Math.Cos(1), 0.4 * Math.Sin(1), 0);
        int crank = b.Bar(Vector3d.Zero, end, 1);
        b.Hinge(JointModel.World, crank, Vector3d.Zero, Vector3d.UnitZ);
        if (tilt != null)
        {
            var pivot = new Vector3d(1, 0, 0);
            Vector3d line = pivot - end, along = line.Normalized();
            double way = (line.LengthSquared + 0.81 - 0.49) / (2 * line.Length);
            Vector3d middle = end + along * way + new Vector3d(-along.Y, along.X, 0) * Math.Sqrt(0.81 - way * way);
            int coupler = b.Bar(end, middle, 1), rocker = b.Bar(middle, pivot, 1);
            b.Hinge(crank, coupler, end, Vector3d.UnitZ);
            b.Hinge(coupler, rocker, middle, new Vector3d(tilt.Value, 0, 1));
            b.Hinge(JointModel.World, rocker, pivot, Vector3d.UnitZ);
        }

        Vector3d shoulder = Any(), elbow = Any(), hand = Any();
        int upper = b.Bar(shoulder, elbow, 1), lower = b.Bar(elbow, hand, 1);
        b.Add(Ball(), crank, upper, shoulder, Vector3d.UnitX);
        b.Hinge(upper, lower, elbow, Any());
        b.Add(Ball(), crank, lower, hand, Vector3d.UnitX);
        return b.Build();

        Vector3d Any() => new(random.NextDouble() - 0.5, random.NextDouble() - 0.5, random.NextDouble() - 0.5);
        static D6Joint Ball() => new() { Twist = AxisMotion.Free, Swing1 = AxisMotion.Free, Swing2 = AxisMotion.Free };
    }

    /// <summary>
    /// One to three plane polygons of four to six bars, one on the other; one hinge of one of them is tilted, so that it can turn only by what angles give.
    /// </summary>
    public static MultibodySystem Polygons(int seed)
    {
        var random = new Random(seed);
        var b = new MechanismBuilder();
        int count = random.Next(1, 4), off = random.Next(count), ground = JointModel.World;
        Vector3d at = Vector3d.Zero;
        for (int polygon = 0; polygon < count; polygon++)
        {
            var points = new Vector3d[random.Next(4, 7)];
            for (int i = 0; i < points.Length; i++)
            {
                double angle = 2 * Math.PI * (i + 0.6 * (random.NextDouble() - 0.5)) / points.Length, radius = 0.5 + 0.5 * random.NextDouble();
                points[i] = at + new Vector3d(radius * Math.Cos(angle), radius * Math.Sin(angle), 0);
            }

            int tilted = random.Next(points.Length), carrier = random.Next(points.Length - 1), last = ground, next = ground;
            for (int i = 0; i < points.Length; i++)
            {
                int bar = i == points.Length - 1 ? ground : b.Bar(points[i], points[i + 1], 0.1 + random.NextDouble());
                double tilt = polygon == off && i == tilted ? Math.Pow(10, -2.5 + 0.8 * random.NextDouble()) : 0;
                b.Hinge(last, bar, points[i], new Vector3d(tilt, tilt * (random.NextDouble() - 0.5), 1));
                next = i == carrier ? bar : next;
                last = bar;
            }

            ground = next;
            at = points[0];
        }

        return b.Build();
    }
}
