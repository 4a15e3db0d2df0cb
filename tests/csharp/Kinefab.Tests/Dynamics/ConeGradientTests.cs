using System;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>The row of a cone in the exact solver is the gradient of its error: on a hard cone, and at whatever depth beyond a soft one. PhysX's is near it.</summary>
internal sealed class ConeGradientTests
{
    [Test]
    public void Find_OnACone_GivesTheGradient([Values] bool isSoft)
    {
        var random = new Random(11);
        for (int trial = 0; trial < 1000; trial++)
        {
            double beyond = isSoft ? 1 + 0.2 * random.NextDouble() : 1;
            var limit = new ConeLimit
            {
                Y = Math.Pow(10, -2 * random.NextDouble()),
                Z = Math.Pow(10, -2 * random.NextDouble()),
                Response = isSoft ? new LimitResponse { Stiffness = 1 } : default,
            };
            double at = 2 * Math.PI * random.NextDouble();
            Quaterniond swing = Swing(beyond * limit.Y * Math.Cos(at), beyond * limit.Z * Math.Sin(at));
            Error(limit, swing, out Vector3d axis);
            double least = Math.Min(limit.Y, limit.Z);
            double h = 1e-4 * least * least;

            var gradient = new Vector3d(Rate(limit, swing, Vector3d.UnitX, h), Rate(limit, swing, Vector3d.UnitY, h), Rate(limit, swing, Vector3d.UnitZ, h));

            Assert.That((gradient + axis).Length, Is.LessThan(1e-3), $"trial {trial}: cone {limit.Y} x {limit.Z} at {at} times {beyond}");
        }
    }

    /// <summary>
    /// As far as half a turn beyond a soft cone its error is the angle to its nearest line, here of as many as are looked through. About half a turn the
    /// line that is nearest among the swing angles may be the farther side's: the angle jumped by a radian there.
    /// </summary>
    [Test]
    public void Find_FarBeyondASoftCone_IsTheAngleToTheNearestLine([Values(1.8, Math.PI)] double widest)
    {
        const int lines = 4000;
        var random = new Random(3);
        for (int trial = 0; trial < 300; trial++)
        {
            double size = widest > 2 ? 2.5 : 1;
            var limit = new ConeLimit { Y = size * Math.Pow(10, -2 * random.NextDouble()), Z = size * Math.Pow(10, -2 * random.NextDouble()), Response = new LimitResponse { Stiffness = 1 } };
            double toward = 2 * Math.PI * random.NextDouble();
            Quaterniond swing = Quaterniond.AxisAngle(new Vector3d(0, Math.Cos(toward), Math.Sin(toward)), widest - 0.8 * random.NextDouble());
            if (!ConeLimitError.Find(limit, 0, swing, true, out _, out double error))
            {
                continue;
            }

            double nearest = Math.PI;
            for (int i = 0; i < lines; i++)
            {
                double at = 2 * Math.PI * i / lines;
                Vector3d line = Swing(limit.Y * Math.Cos(at), limit.Z * Math.Sin(at)) * Vector3d.UnitX;
                nearest = Math.Min(nearest, Math.Acos(Math.Max(-1, Math.Min(1, Vector3d.Dot(line, swing * Vector3d.UnitX)))));
            }

            Assert.That(-error, Is.EqualTo(nearest).Within(3e-3), $"trial {trial}: cone {limit.Y} x {limit.Z}");
        }
    }

    private static double Rate(in ConeLimit limit, Quaterniond swing, Vector3d about, double h) =>
        (Error(limit, Without(Quaterniond.AxisAngle(about, h) * swing), out _) - Error(limit, Without(Quaterniond.AxisAngle(about, -h) * swing), out _)) / (2 * h);

    private static Quaterniond Without(Quaterniond turn) => new SwingTwist(turn).Swing;

    private static double Error(in ConeLimit limit, Quaterniond swing, out Vector3d axis)
    {
        Assert.That(ConeLimitError.Find(limit, limit.Y, swing, true, out axis, out double error));
        return error;
    }

    // The swing by two angles, each four times that of its half's tangent.
    private static Quaterniond Swing(double y, double z)
    {
        (double ty, double tz) = (Math.Tan(y / 4), Math.Tan(z / 4));
        double square = ty * ty + tz * tz;
        return new Quaterniond(0, 2 * ty / (1 + square), 2 * tz / (1 + square), (1 - square) / (1 + square));
    }
}
