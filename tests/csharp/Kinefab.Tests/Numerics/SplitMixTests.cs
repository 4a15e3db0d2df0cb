using System;
using System.Collections.Generic;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Numerics;

/// <summary>Numbers that look random, and the mixtures of directions that are made of them.</summary>
public class SplitMixTests
{
    [Test]
    public void Bits_FirstPlaces_AreThoseOfTheReference() =>
        Assert.That(new[] { SplitMix.Bits(0), SplitMix.Bits(1), SplitMix.Bits(2) }, Is.EqualTo(new[] { 0xE220A8397B1DCDAFUL, 0x6E789E6AA1B965F4UL, 0x06C45D188009454FUL }));

    [Test]
    public void Around0_ManyPlaces_IsEvenFromMinusOneToOne()
    {
        double sum = 0, squares = 0;
        for (ulong place = 0; place < 10_000; place++)
        {
            double number = SplitMix.Around0(place);
            Assert.That(number, Is.GreaterThanOrEqualTo(-1).And.LessThan(1));
            sum += number;
            squares += number * number;
        }

        Assert.That(sum / 10_000, Is.EqualTo(0).Within(0.02));
        Assert.That(squares / 10_000, Is.EqualTo(1.0 / 3).Within(0.01));
    }

    [Test]
    public void Weight_AsManyRoundsAsDirections_AreIndependentMixtures([Values(3, 6, 12, 24)] int directions)
    {
        var mixtures = new double[directions, directions];
        for (int round = 0; round < directions; round++)
        {
            for (int direction = 0; direction < directions; direction++)
            {
                mixtures[round, direction] = VelocitySpace.Weight(direction, round);
            }
        }

        IReadOnlyList<double> values = new SingularValues(mixtures).Values;
        Assert.That(values[^1], Is.GreaterThan(0.001 * values[0]));
    }

    [Test]
    public void Near_OneSquareOfSixWeights_LeavesFive()
    {
        var form = new double[6, 6];
        form[0, 0] = 1;
        var squares = new VanishingSquares(new List<double[,]> { form });
        var known = new List<double[]>();
        for (int round = 0; round < 16; round++)
        {
            double[] start = Array.ConvertAll(new[] { 0, 1, 2, 3, 4, 5 }, direction => VelocitySpace.Weight(direction, round));
            if (squares.Near(start, known, default) is { } weights)
            {
                known.Add(weights);
            }
        }

        Assert.That(known, Has.Count.EqualTo(5));
    }
}
