namespace Kinefab.Dynamics.Rattle;

/// <summary>How often an island's steps are halved, kept from step to step.</summary>
internal struct SubstepHistory
{
    // Steps in which by its demand an eighth as many parts would have done, after which it is cut into half as many.
    private const int CalmSteps = 15;
    private const int Margin = 8;

    private int _calm;

    /// <summary>The island's energy.</summary>
    public EnergyLedger Energy;

    public int Halvings { get; private set; }

    /// <summary>Takes note of a step.</summary>
    /// <param name="halvings">Halvings that it took.</param>
    /// <param name="demand">See <see cref="StepLimit"/>.</param>
    public void Record(int halvings, double demand)
    {
        if (halvings > Halvings || demand * Margin > 1 << Halvings)
        {
            Halvings = halvings;
            _calm = 0;
        }
        else if (Halvings > 0 && ++_calm == CalmSteps)
        {
            Halvings--;
            _calm = 0;
        }
    }
}
