using System;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// An island's account of energy from step to step. RATTLE's energy swings about a value that it keeps, by the square of the step, and what swings
/// below comes back by itself. So only what lies above what there was and was given is taken from the speeds, and given back when the energy swings
/// below, lest a motion run down by one side of its swings; and so is what has run down far, as where the step's length changed amid a swing.
/// </summary>
internal struct EnergyLedger
{
    /// <summary>Of what moves, the most that is taken or given at once.</summary>
    public const double MostOfKinetic = 0.5;

    // Of the largest energy so far: how far the energy may lie above what there should be, and below, and what it may change by in a step.
    private const double MostAbove = 5e-4;
    private const double MostBelow = 1e-2;
    private const double MostInStep = 2e-2;

    // How far the energy lies above what there was and was given, J: at least, as if limits and dampers had taken nothing, and at most,
    // as if they had taken all that went while they acted. The first follows the energy down, lest it leave room for a gain.
    private double _least;
    private double _most;
    private double _largest;

    // Of what was taken from the speeds, what was not given back, J.
    private double _taken;

    /// <summary>Whether a step is fine enough.</summary>
    /// <param name="gain">Energy that came of nothing since its start, J.</param>
    /// <param name="moving">Energy that moves at its end, J.</param>
    /// <param name="mayLose">Whether something takes energy, as limits and dampers do.</param>
    public readonly bool Allows(double gain, double moving, bool mayLose)
    {
        double allowed = MostInStep * Math.Max(_largest, moving);
        return gain <= allowed && (mayLose || gain >= -allowed);
    }

    /// <summary>
    /// Whether the speeds can give what a step leaves too much, down to twice what is left alone: where a swing turns round there is little to take, and the
    /// energy that it then has too much, or half of it, lifts it over where it was let go.
    /// </summary>
    /// <param name="gain">Energy that came of nothing since its start, J.</param>
    /// <param name="moving">Energy that moves at its end, J.</param>
    /// <param name="takeable">What speeds can give, J.</param>
    public readonly bool CanTake(double gain, double moving, double takeable) =>
        _least + gain - MostOfKinetic * takeable <= 2 * MostAbove * Math.Max(_largest, moving);

    /// <summary>Takes down a step that was taken.</summary>
    /// <param name="gain">Energy that came of nothing in it, J.</param>
    /// <param name="moving">Energy that moves at its end, J.</param>
    /// <param name="takeable">What speeds can give or take of it, see <see cref="LaneEnergy{V}.Takeable"/>, J.</param>
    /// <param name="mayLose">Whether something takes energy, as limits and dampers do.</param>
    /// <returns>What is to be taken from the speeds, or below 0 given to them, J.</returns>
    public double Enter(double gain, double moving, double takeable, bool mayLose)
    {
        bool isExplained = mayLose || !Allows(gain, moving, false);
        _largest = Math.Max(_largest, moving);
        double room = MostAbove * _largest;
        _most += isExplained ? Math.Max(0, gain) : gain;
        _least = isExplained ? Math.Max(_least + gain, Math.Min(_least, -room)) : _least + gain;
        double surplus = 0;
        if (_least > room)
        {
            surplus = Math.Min(_least - room, MostOfKinetic * takeable);
        }
        else if (_most < 0 && !isExplained)
        {
            double back = Math.Max(Math.Min(_taken, -_most), -_most - MostBelow * _largest);
            surplus = -Math.Min(back, MostOfKinetic * takeable);
        }

        _taken = Math.Max(0, _taken + surplus);
        _least -= surplus;
        _most = Math.Min(room, _most - surplus);
        return surplus;
    }
}
