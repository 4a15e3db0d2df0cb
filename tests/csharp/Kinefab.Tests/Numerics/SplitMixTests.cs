using System.Collections.Generic;
using System.Linq;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Numerics;

/// <summary>Numbers that look random, and the mixtures of directions that are made of them.</summary>
public class SplitMixTests
{
    [TestCase(0UL, 0xE220A8397B1DCDAFUL)]
    [TestCase(1UL, 0x6E789E6AA1B965F4UL)]
    [TestCase(2UL, 0x06C45D188009454FUL)]
    public void Bits_FirstPlaces_AreThoseOfTheReference(ulong place, ulong bits) => Assert.That(SplitMix.Bits(place), Is.EqualTo(bits));

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

        double[] values = new SingularValues(mixtures).Values.ToArray();
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
            double[] start = Enumerable.Range(0, 6).Select(direction => VelocitySpace.Weight(direction, round)).ToArray();
            if (squares.Near(start, known, default) is { } weights)
            {
                known.Add(weights);
            }
        }

        Assert.That(known, Has.Count.EqualTo(5));
    }
}
