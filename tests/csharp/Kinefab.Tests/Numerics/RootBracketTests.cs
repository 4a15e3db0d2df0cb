using System;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Numerics;

/// <summary>Where a function falls through 0 is found in few questions, whatever its form.</summary>
internal sealed class RootBracketTests
{
    private const double Close = 1e-9;

    private static readonly TestCaseData[] Falling =
    {
        new TestCaseData((Func<double, double>)(x => 0.3 - x), 2).SetName("{m}(line)"),
        new TestCaseData((Func<double, double>)(x => 0.01 + 0.5 * x - x * x), 6).SetName("{m}(parabola)"),
        new TestCaseData((Func<double, double>)(x => Math.Min(0.7 - x, 3 * (0.6 - x))), 8).SetName("{m}(of two)"),
        new TestCaseData((Func<double, double>)(x => Math.Exp(-30 * x) - 0.01), 10).SetName("{m}(steep)"),
        new TestCaseData((Func<double, double>)(x => x < 0.4 ? double.PositiveInfinity : 0.5 - x), 8).SetName("{m}(not there at first)"),
    };

    [TestCaseSource(nameof(Falling))]
    public void Next_OfAFallingFunction_ArrivesSoon(Func<double, double> f, int most)
    {
        var bracket = new RootBracket(0, double.IsInfinity(f(0)) ? 1 : f(0), 1, f(1), 0.5);
        int asked = 0;
        double value;
        do
        {
            double place = bracket.Next();
            value = f(place);
            bracket.Add(place, value);
            asked++;
        }
        while (!(Math.Abs(value) <= Close) && asked < 50);
        Assert.That(asked, Is.LessThanOrEqualTo(most));
    }

    [Test]
    public void Early_OfALeap_StandsBeforeIt()
    {
        const double leap = 0.37;
        var bracket = new RootBracket(0, 1, 1, -1, 0.5);
        for (int i = 0; i < 16; i++)
        {
            double place = bracket.Next();
            bracket.Add(place, place < leap ? 1 - place : -1);
        }

        Assert.That(bracket.Early, Is.LessThan(leap).And.GreaterThan(leap - 0.01));
    }
}
