using System;
using Kinefab.Joints;
using Kinefab.Mechanisms;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>The joint frame of schemas/SPEC.md, section 4, from axes that are no frame yet.</summary>
public sealed class UnityFramesTests
{
    [Test]
    public void Axes_AskewAndOfAnyLength_KeepTheAxisAndThePlaneOfBoth()
    {
        Quaterniond axes = UnityFrames.Axes(new Vector3d(0, 0, 3), new Vector3d(0, 5, 4));
        AssertFrame(axes, Vector3d.UnitZ, Vector3d.UnitY);
    }

    [Test]
    public void Axes_WithoutAxis_StandAsTheDefault() =>
        AssertFrame(UnityFrames.Axes(Vector3d.Zero, Vector3d.UnitY), Vector3d.UnitX, Vector3d.UnitY);

    [TestCase(0, 0, 0)]
    [TestCase(2, -1, 2)]
    public void Axes_SecondaryWithoutADirectionOfItsOwn_IsAnyPerpendicular(double x, double y, double z)
    {
        Vector3d axis = new(2, -1, 2);
        Quaterniond axes = UnityFrames.Axes(axis, new Vector3d(x, y, z));
        AssertFrame(axes, axis * (1.0 / 3), axes * Vector3d.UnitY);
    }

    [TestCase(1, 0, 0)]
    [TestCase(0, 1, 0)]
    [TestCase(0, 0, -1)]
    [TestCase(0.6, 0, 0.8)]
    public void Perpendicular_OfAUnitVector_IsOneAtRightAngles(double x, double y, double z)
    {
        Vector3d unit = new(x, y, z);
        Vector3d found = Vector3d.Perpendicular(unit);
        Assert.That((Vector3d.Dot(found, unit), found.Length), Is.EqualTo((0, 1)).Using<(double, double)>(Near));
    }

    private static bool Near((double A, double B) one, (double A, double B) other) =>
        Math.Abs(one.A - other.A) < 1e-15 && Math.Abs(one.B - other.B) < 1e-15;

    private static void AssertFrame(Quaterniond axes, Vector3d x, Vector3d y)
    {
        Vector3d[] off = [axes * Vector3d.UnitX - x, axes * Vector3d.UnitY - y, axes * Vector3d.UnitZ - Vector3d.Cross(x, y)];
        Assert.That(off, Has.All.Matches<Vector3d>(difference => difference.Length < 1e-15));
    }
}
