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
    [TestCase("12345678.90123456", 12345678.90123456)]
    [TestCase("1e0005", 1e5)]
    public void TryGet_FewDigits_IsExact(string text, double expected)
    {
        bool parsed = TryRead(text, out double value);
        Assert.That((parsed, BitConverter.DoubleToInt64Bits(value)), Is.EqualTo((true, BitConverter.DoubleToInt64Bits(expected))));
    }

    [TestCase("0.70710678118654757")]
    [TestCase("1e-30")]
    [TestCase("3e999")]
    [TestCase("1e99999999999")]
    [TestCase("0.0000000000000000000000000000001e31")]
    [TestCase("36893488147419103233")]
    [TestCase("0.000000000000000000001")]
    public void TryGet_MoreThanOneRounding_IsLeftToTheRuntime(string text) =>
        Assert.That(TryRead(text, out _), Is.False);

    [Test]
    public void TryGet_AnyNumberItTakes_AgreesWithTheRuntimeToTheLastBit()
    {
        Prop.ForAll(ArbMap.Default.ArbFor<int>(), seed =>
        {
            var random = new System.Random(seed);
            double number = (random.NextDouble() - 0.5) * Math.Pow(10, random.Next(-25, 25));
            string text = number.ToString("G" + random.Next(1, 18), CultureInfo.InvariantCulture);
            return !TryRead(text, out double value)
                || value.Equals(double.Parse(text, CultureInfo.InvariantCulture));
        }).QuickCheckThrowOnFailure();
    }

    // As the tokenizer does: sign, whole part, fraction, power.
    private static bool TryRead(string text, out double value)
    {
        byte[] bytes = Encoding.ASCII.GetBytes(text);
        bool isNegative = bytes[0] == '-';
        var number = new ShortDecimal(isNegative);
        int at = number.AddWhole(bytes, isNegative ? 1 : 0);
        if (at < bytes.Length && bytes[at] == '.')
            at = number.AddFraction(bytes, at + 1);
        if (at < bytes.Length && bytes[at] is (byte)'e' or (byte)'E')
        {
            bool isSmall = bytes[at + 1] == '-';
            at = number.AddPower(bytes, at + (isSmall || bytes[at + 1] == '+' ? 2 : 1), isSmall);
        }

        Assert.That(at, Is.EqualTo(bytes.Length));
        return number.TryGet(out value);
    }
}
