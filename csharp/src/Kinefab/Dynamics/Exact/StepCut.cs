namespace Kinefab.Dynamics.Exact;

/// <summary>How often an island's steps are halved, kept from step to step.</summary>
internal struct StepCut
{
    // Steps in which a quarter as many parts would have been ample, after which half as many will do.
    private const int CalmSteps = 15;
    private const int Margin = 8;

    private int _calm;

    public int Halvings { get; private set; }

    /// <summary>Takes note of a step.</summary>
    /// <param name="halvings">Halvings that it took.</param>
    /// <param name="demand">See <see cref="Ladder.Demand"/>.</param>
    public void Note(int halvings, double demand)
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
