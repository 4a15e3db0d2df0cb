using System;
using System.Globalization;
using System.Text;
using FsCheck;
using FsCheck.Fluent;
using Kinefab.Json;
using NUnit.Framework;

namespace Kinefab.Tests.Json;

public class ShortDecimalTests
{
    [TestCase("0", 0)]
    [TestCase("-10", -10)]
    [TestCase("80", 80)]
    [TestCase("0.1", 0.1)]
    [TestCase("-0.000000000001", -1e-12)]
    [TestCase("1.23456789012e-05", 1.23456789012e-05)]
    [TestCase("6.02E+22", 6.02e22)]
    [TestCase("9007199254740991", 9007199254740991)]
    [TestCase("0.707106781187", 0.707106781187)]
    public void TryParse_FewDigits_IsExact(string text, double expected)
    {
        bool parsed = ShortDecimal.TryParse(Encoding.ASCII.GetBytes(text), out double value);
        Assert.That((parsed, BitConverter.DoubleToInt64Bits(value)), Is.EqualTo((true, BitConverter.DoubleToInt64Bits(expected))));
    }

    [TestCase("0.70710678118654757")]
    [TestCase("1e-30")]
    [TestCase("3e999")]
    [TestCase("36893488147419103233")]
    [TestCase("0.000000000000000000001")]
    public void TryParse_MoreThanOneRounding_IsLeftToTheRuntime(string text) =>
        Assert.That(ShortDecimal.TryParse(Encoding.ASCII.GetBytes(text), out _), Is.False);

    [Test]
    public void TryParse_AnyNumberItTakes_AgreesWithTheRuntimeToTheLastBit()
    {
        Prop.ForAll(ArbMap.Default.ArbFor<int>(), seed =>
        {
            var random = new System.Random(seed);
            double number = (random.NextDouble() - 0.5) * Math.Pow(10, random.Next(-25, 25));
            string text = number.ToString("G" + random.Next(1, 18), CultureInfo.InvariantCulture);
            return !ShortDecimal.TryParse(Encoding.ASCII.GetBytes(text), out double value)
                || value.Equals(double.Parse(text, CultureInfo.InvariantCulture));
        }).QuickCheckThrowOnFailure();
    }
}
