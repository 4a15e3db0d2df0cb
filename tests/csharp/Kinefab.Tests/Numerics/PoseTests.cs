using System;
using FsCheck;
using FsCheck.Fluent;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Numerics;

public class PoseTests
{
    [Test]
    public void Quaternion_QuarterTurnAboutUp_TurnsForwardToRight()
    {
        Vector3d right = Quaterniond.AxisAngle(Vector3d.UnitY, Math.PI / 2) * Vector3d.UnitZ;
        Assert.That((right - Vector3d.UnitX).Length, Is.LessThan(1e-15));
    }

    [Test]
    public void FromAxes_AxesOfARotation_GivesItBack()
    {
        Prop.ForAll(ArbMap.Default.ArbFor<int>(), seed =>
        {
            var random = new Random(seed);
            double Next() => random.NextDouble() * 2 - 1;
            Quaterniond q = new Quaterniond(Next(), Next(), Next(), Next()).Normalized();
            Quaterniond back = Quaterniond.FromAxes(q * Vector3d.UnitX, q * Vector3d.UnitY, q * Vector3d.UnitZ);
            double dot = Math.Abs(q.X * back.X + q.Y * back.Y + q.Z * back.Z + q.W * back.W);
            return Math.Abs(dot - 1) < 1e-12;
        }).QuickCheckThrowOnFailure();
    }

    [Test]
    public void Inverse_AfterPose_IsIdentity()
    {
        var pose = new Pose(new Vector3d(0.3, -1.2, 2.5), new Quaterniond(0.1, -0.7, 0.2, 0.5).Normalized());
        Vector3d p = new(4, -5, 6);
        using (Assert.EnterMultipleScope())
        {
            Assert.That((pose.Inverse().Point(pose.Point(p)) - p).Length, Is.LessThan(1e-14));
            Assert.That(((pose * pose.Inverse()).Point(p) - p).Length, Is.LessThan(1e-14));
            Assert.That((pose.InversePoint(pose.Point(p)) - p).Length, Is.LessThan(1e-14));
        }
    }
}
