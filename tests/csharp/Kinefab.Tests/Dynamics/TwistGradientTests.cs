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

    // Beside one locked swing the other may turn all round; at half a turn of it a twist as such has no number.
    [TestCase(true)]
    [TestCase(false)]
    public void Prepare_TwistBesideALockedSwing_IsTheTurnAboutXAtAnySwing(bool isFirstLocked)
    {
        var joint = new D6Joint
        {
            LimitsFromAfar = true,
            Twist = AxisMotion.Limited,
            Swing1 = isFirstLocked ? AxisMotion.Locked : AxisMotion.Free,
            Swing2 = isFirstLocked ? AxisMotion.Free : AxisMotion.Locked,
            TwistLimit = new AngularLimit { Lower = -0.4, Upper = 1.2 },
            Body0 = JointModel.World,
            Frame0 = Pose.Identity,
            Frame1 = Pose.Identity,
        };
        Vector3d swingAxis = isFirstLocked ? Vector3d.UnitZ : Vector3d.UnitY;
        Span<ConstraintRow> rows = stackalloc ConstraintRow[JointModel.MaxRows];
        for (int i = 0; i <= 64; i++)
        {
            double twist = -0.3 + 0.02 * i;
            Quaterniond swing = Quaterniond.AxisAngle(swingAxis, 2 * Math.PI * i / 64 - Math.PI / 2);
            Quaterniond q = swing * Quaterniond.AxisAngle(Vector3d.UnitX, twist);
            int count = joint.PrepareForces(Pose.Identity, new Pose(Vector3d.Zero, q), rows);
            joint.FinishTwist(Pose.Identity, new Pose(Vector3d.Zero, q));

            Assert.That(count, Is.EqualTo(2));
            Assert.That(rows[0].GeometricError, Is.EqualTo(twist + 0.4).Within(1e-12), $"swing {i}");
            Assert.That(rows[1].GeometricError, Is.EqualTo(1.2 - twist).Within(1e-12), $"swing {i}");
            Assert.That((rows[1].Angular0 - q * Vector3d.UnitX).Length, Is.LessThan(1e-12), $"swing {i}");
        }
    }
}
