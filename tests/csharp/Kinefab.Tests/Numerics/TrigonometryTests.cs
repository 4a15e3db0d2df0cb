using System;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Numerics;

/// <summary>Own sines and arctangents against the C library's, whose results are within about half a unit in the last place.</summary>
public sealed class TrigonometryTests
{
    private const int Samples = 200_000;

    [Test]
    public void SinAndCos_OfManyAngles_AreWithinOneUnitInTheLastPlace()
    {
        var random = new Random(1);
        for (int i = 0; i < Samples; i++)
        {
            double angle = (random.NextDouble() * 2 - 1) * Math.Pow(10, random.Next(-12, 6));
            Assert.That(Units(Trigonometry.Sin(angle), Math.Sin(angle)), Is.LessThanOrEqualTo(1), $"sin {angle:R}");
            Assert.That(Units(Trigonometry.Cos(angle), Math.Cos(angle)), Is.LessThanOrEqualTo(1), $"cos {angle:R}");
        }
    }

    [Test]
    public void SinAndCos_OfWholeQuarters_AreWithinOneUnitInTheLastPlace()
    {
        for (int quarter = -1000; quarter <= 1000; quarter++)
        {
            double angle = quarter * (Math.PI / 2);
            Assert.That(Units(Trigonometry.Sin(angle), Math.Sin(angle)), Is.LessThanOrEqualTo(1), $"sin {angle:R}");
            Assert.That(Units(Trigonometry.Cos(angle), Math.Cos(angle)), Is.LessThanOrEqualTo(1), $"cos {angle:R}");
        }
    }

    // An angle so large is itself known to its last place only.
    [Test]
    public void Sin_OfHugeAngles_IsThatOfAnAngleWithinTheirLastPlace()
    {
        var random = new Random(2);
        for (int i = 0; i < 1000; i++)
        {
            double angle = (1 + random.NextDouble()) * Math.Pow(10, random.Next(6, 14));
            Assert.That(Trigonometry.Sin(angle), Is.EqualTo(Math.Sin(angle)).Within(Math.BitIncrement(angle) - angle));
        }
    }

    [Test]
    public void Atan2_OfManyPoints_IsWithinOneUnitInTheLastPlace()
    {
        var random = new Random(3);
        for (int i = 0; i < Samples; i++)
        {
            double y = (random.NextDouble() * 2 - 1) * Math.Pow(10, random.Next(-12, 12));
            double x = (random.NextDouble() * 2 - 1) * Math.Pow(10, random.Next(-12, 12));
            Assert.That(Units(Trigonometry.Atan2(y, x), Math.Atan2(y, x)), Is.LessThanOrEqualTo(1), $"atan2 {y:R} {x:R}");
            double sine = random.NextDouble() * 2 - 1;
            Assert.That(Trigonometry.Asin(sine), Is.EqualTo(Math.Asin(sine)).Within(5e-16), $"asin {sine:R}");
            Assert.That(Units(Trigonometry.Tan(sine), Math.Tan(sine)), Is.LessThanOrEqualTo(3), $"tan {sine:R}");
        }
    }

    [Test]
    public void Atan2_OfZerosInfinitiesAndExtremes_IsTheCLibrarys()
    {
        double[] values = [0, -0.0, 1, -1, double.PositiveInfinity, double.NegativeInfinity, double.MaxValue, -double.MaxValue, double.Epsilon, -double.Epsilon, 1e-300, double.NaN];
        foreach (double y in values)
        {
            foreach (double x in values)
            {
                double wanted = Math.Atan2(y, x);
                double got = Trigonometry.Atan2(y, x);
                Assert.That(double.IsNaN(got) ? double.IsNaN(wanted) : Units(got, wanted) <= 1 && double.IsNegative(got) == double.IsNegative(wanted), $"atan2 {y} {x}: {got} {wanted}");
            }
        }

        Assert.That(double.IsNaN(Trigonometry.Sin(double.PositiveInfinity)) && double.IsNaN(Trigonometry.Cos(double.NaN)) && double.IsNaN(Trigonometry.Asin(1.5)));
    }

    private static long Units(double a, double b) => Math.Abs(BitConverter.DoubleToInt64Bits(a + 0.0) - BitConverter.DoubleToInt64Bits(b + 0.0));
}
