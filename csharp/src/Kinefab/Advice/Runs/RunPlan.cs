namespace Kinefab.Advice.Runs;

/// <summary>When a run is looked at: the same times in every run, whatever its own step.</summary>
internal readonly struct RunPlan
{
    public RunPlan(double step, int samples)
    {
        Step = step;
        Samples = samples;
    }

    /// <summary>The unchanged scene's fixedTimestep, seconds.</summary>
    public double Step { get; }

    /// <summary>Steps of that length.</summary>
    public int Samples { get; }

    public double Seconds => Step * Samples;
}
