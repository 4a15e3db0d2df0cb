using System;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// An island's account of energy from step to step: how far what it has lies above what it had and was given since. A step that gains, or
/// loses where nothing takes any, more than a small share of the largest energy so far is too coarse; what gathers over many steps is
/// taken from the speeds. A second-order step's energy swings about that of the motion: what it has lost it may bring back.
/// </summary>
internal struct EnergyLedger
{
    // Of the largest energy so far: above what was given at most, and in a step.
    private const double Share = 5e-4;
    private const double ShareOfStep = 1.25e-4;

    private double _excess;
    private double _largest;

    /// <summary>Whether a step is fine enough.</summary>
    /// <param name="gain">Energy that came of nothing since its start, J.</param>
    /// <param name="moving">Energy that moves at its end, J.</param>
    /// <param name="mayLose">Whether something takes energy, as limits and dampers do.</param>
    public readonly bool Allows(double gain, double moving, bool mayLose)
    {
        double most = ShareOfStep * Math.Max(_largest, moving);
        return gain <= most && (mayLose || gain >= -most);
    }

    /// <summary>Takes down a step that was taken. What limits and dampers take leaves no room for a gain.</summary>
    /// <returns>What is to be taken from the speeds, J.</returns>
    public double Enter(double gain, double moving, bool mayLose)
    {
        _largest = Math.Max(_largest, moving);
        double most = Share * _largest;
        double excess = _excess + gain;
        excess = mayLose ? Math.Max(excess, Math.Min(_excess, -most)) : excess;
        double surplus = excess > most ? excess : 0;
        _excess = excess - surplus;
        return surplus;
    }
}
