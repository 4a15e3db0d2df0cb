using System;
using Kinefab.Advice.Runs;

namespace Kinefab.Advice;

/// <summary>What is worth a warning: a length in proportion to the links, and an angle.</summary>
internal readonly struct Threshold
{
    private readonly double _distance;
    private readonly double _angle;

    private Threshold(double distance, double angle)
    {
        _distance = distance;
        _angle = angle;
    }

    /// <summary>A joint that comes apart or shakes: seen by eye from 2 mm on a link of 1 m.</summary>
    public static Threshold Drift(RunIsland island) => new(0.002 * island.Length, 0.2);

    /// <summary>A body that is not where it should be: a twentieth of a link.</summary>
    public static Threshold Place(RunIsland island) => new(0.05 * island.Length, 5);

    /// <summary>A coordinate that is not held: a hundredth of a link.</summary>
    public static Threshold Hold(RunIsland island) => new(0.01 * island.Length, 1);

    /// <summary>1 where a warning begins; 0 for anything that is not a number.</summary>
    public double Score(AdviceMeasure measure)
    {
        double score = Math.Max((measure.Distance ?? 0) / _distance, (measure.Angle ?? 0) / _angle);
        return score >= 0 ? score : 0;
    }
}
