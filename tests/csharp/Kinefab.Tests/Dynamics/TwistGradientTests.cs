using System;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>The row of a twist is the gradient of its angle, at whatever swing; PhysX's own row is that only without one.</summary>
public sealed class TwistGradientTests
{
    [Test]
    public void TwistGradient_AtAnySwing_IsTheRateOfTheTwist()
    {
        var random = new Random(5);
        double Between() => 2 * random.NextDouble() - 1;
        for (int trial = 0; trial < 1000; trial++)
        {
            Quaterniond swing = Quaterniond.AxisAngle(new Vector3d(0, Between(), Between()).Normalized(), 2.8 * random.NextDouble());
            Quaterniond q = swing * Quaterniond.AxisAngle(Vector3d.UnitX, 2.5 * Between());
            var rate = new Vector3d(Between(), Between(), Between());
            const double h = 1e-5;
            double later = SwingTwist.TwistAngle(Quaterniond.AxisAngle(rate.Normalized(), rate.Length * h) * q);
            double before = SwingTwist.TwistAngle(Quaterniond.AxisAngle(rate.Normalized(), -rate.Length * h) * q);

            Vector3d gradient = SwingTwist.TwistGradient(Vector3d.UnitX, q * Vector3d.UnitX);

            Assert.That(Vector3d.Dot(gradient, rate), Is.EqualTo((later - before) / (2 * h)).Within(1e-6 * (1 + gradient.LengthSquared)), $"trial {trial}");
        }
    }
}
