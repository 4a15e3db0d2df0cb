using System;
using System.Globalization;
using System.Text;
using Kinefab.Json;
using NUnit.Framework;

namespace Kinefab.Tests.Json;

public sealed class LongDecimalTests
{
    // Ties, the ends of the range, subnormal numbers, more digits than decide.
    [TestCase("0")]
    [TestCase("-0")]
    [TestCase("0.000e999999999999999999999")]
    [TestCase("0.70710678118654757")]
    [TestCase("9007199254740993")]
    [TestCase("9007199254740995")]
    [TestCase("9007199254740993.00000000000000000000000000000000000001")]
    [TestCase("1e22")]
    [TestCase("1e23")]
    [TestCase("8.5e22")]
    [TestCase("1.7976931348623157e308")]
    [TestCase("1.7976931348623158079e308")]
    [TestCase("1.7976931348623159e308")]
    [TestCase("1e309")]
    [TestCase("-1e99999999999999999999")]
    [TestCase("2.2250738585072011e-308")]
    [TestCase("2.2250738585072014e-308")]
    [TestCase("4.9406564584124654e-324")]
    [TestCase("2.4703282292062327e-324")]
    [TestCase("2.4703282292062328e-324")]
    [TestCase("1e-400")]
    [TestCase("0.1000000000000000055511151231257827021181583404541015625")]
    [TestCase("0.0067351284578038109")]
    public void Parse_IsTheFrameworksToTheLastBit(string text) => Check(text);

    [Test]
    public void Parse_OfManyDigits_IsTheFrameworksToTheLastBit()
    {
        Check("1" + new string('0', 900));
        Check("0." + new string('0', 300) + new string('7', 900));
        // A tie but for one digit that stands far behind.
        Check("9007199254740993." + new string('0', 900) + "1");
        Check(new string('9', 300) + "e-290");
        var random = new Random(5);
        for (int i = 0; i < 100_000; i++)
        {
            double number = BitConverter.Int64BitsToDouble(random.NextInt64(0, 0x7ff0000000000000));
            Check(number.ToString(i % 2 == 0 ? "R" : "E" + random.Next(1, 30), CultureInfo.InvariantCulture));
        }
    }

    private static void Check(string text) => Assert.That(
        BitConverter.DoubleToInt64Bits(LongDecimal.Parse(Encoding.ASCII.GetBytes(text))),
        Is.EqualTo(BitConverter.DoubleToInt64Bits(double.Parse(text, CultureInfo.InvariantCulture))), text);
}
