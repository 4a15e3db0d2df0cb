using System;
using Kinefab.Advice.Runs;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Advice;

/// <summary>What counts as going to and fro with the step.</summary>
public sealed class ShakeMeterTests
{
    private const int Steps = 200;

    [Test]
    public void Mean_OfAlternationOnASmoothMotion_IsItsAmplitude()
    {
        ShakeMeter meter = Run(k => Pose(0.5 * Math.Sin(0.01 * k) + 0.003 * Sign(k), 0.2 * Math.Sin(0.02 * k) + 0.01 * Sign(k)));
        Assert.That(meter.Mean.Distance, Is.EqualTo(0.003).Within(0.0001));
        Assert.That(meter.Mean.Angle, Is.EqualTo(0.01 * 180 / Math.PI).Within(0.02));
    }

    [Test]
    public void Mean_OfASwing_IsNothing() =>
        Assert.That(Run(k => Pose(0.5 * Math.Sin(0.3 * k), 0.5 * Math.Sin(0.3 * k))).Mean.Distance, Is.Zero);

    [Test]
    public void Mean_OfAKickAndAStop_IsNothing() =>
        Assert.That(Run(k => Pose(k < 120 ? 0 : k < 150 ? 0.1 * (k - 120) : 3, 0)).Mean.Distance, Is.LessThan(1e-15));

    [Test]
    public void Mean_OfAShakeThatHasDied_IsNothing() =>
        Assert.That(Run(k => Pose(k < Steps / 2 - 4 ? 0.01 * Sign(k) : 0, 0)).Mean.Distance, Is.Zero);

    private static ShakeMeter Run(Func<int, Pose> motion)
    {
        var meter = new ShakeMeter();
        for (int k = 0; k < Steps; k++)
            meter.Note(motion(k), isLate: k >= Steps / 2);
        return meter;
    }

    private static double Sign(int k) => k % 2 == 0 ? 1 : -1;

    private static Pose Pose(double x, double angle) => new(new Vector3d(x, 0, 0), Quaterniond.AxisAngle(Vector3d.UnitZ, angle));
}
