namespace Kinefab.Dynamics.Rattle;

/// <summary>What is kept of an island from step to step: how often its steps are halved, and its account of energy.</summary>
internal struct SubstepHistory
{
    // Steps in which by its demand an eighth as many parts would have done, after which it is cut into half as many.
    private const int CalmSteps = 15;
    private const int Margin = 8;

    /// <summary>The island's energy.</summary>
    public EnergyLedger Energy;

    private int _calm;

    public int Halvings { get; private set; }

    /// <summary>
    /// Whether the island's loops are at a pose where branches of their motion meet, as a parallelogram's that lies flat: speeds that J allows there are a
    /// mixture of the branches', of which no motion comes, and what the loop takes of them is lost whatever the step.
    /// </summary>
    public bool IsSingular { get; set; }

    /// <summary>Whether a drive is slowed down, as the mechanism did not follow it.</summary>
    public bool IsSlowedDown { get; set; }

    /// <summary>Whether its next step is to be taken alone.</summary>
    public readonly bool IsAlone => Halvings > 0 || IsSingular || IsSlowedDown;

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
