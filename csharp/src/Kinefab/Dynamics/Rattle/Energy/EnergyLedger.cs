using System;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// An island's account of energy from step to step. A step in which more than a small share of the largest energy so far comes of nothing, or
/// goes where nothing takes any, is too coarse. What gathers over many steps is taken from the speeds or given back to them.
/// </summary>
internal struct EnergyLedger
{
    // Of the largest energy so far: from what there should be, and in a step.
    private const double Share = 5e-4;
    private const double ShareOfStep = 1.25e-4;

    // How far the energy lies above what there was and was given, J: at least, as if limits and dampers had taken nothing, and at most,
    // as if they had taken all that went while they acted. The first follows the energy down, lest it leave room for a gain.
    private double _least;
    private double _most;
    private double _largest;

    /// <summary>Whether a step is fine enough.</summary>
    /// <param name="gain">Energy that came of nothing since its start, J.</param>
    /// <param name="moving">Energy that moves at its end, J.</param>
    /// <param name="mayLose">Whether something takes energy, as limits and dampers do.</param>
    public readonly bool Allows(double gain, double moving, bool mayLose)
    {
        double allowed = ShareOfStep * Math.Max(_largest, moving);
        return gain <= allowed && (mayLose || gain >= -allowed);
    }

    /// <summary>Takes down a step that was taken.</summary>
    /// <returns>What is to be taken from the speeds, or below 0 given to them, J.</returns>
    public double Enter(double gain, double moving, bool mayLose)
    {
        bool isExplained = mayLose || !Allows(gain, moving, false);
        _largest = Math.Max(_largest, moving);
        double room = Share * _largest;
        _most += isExplained ? Math.Max(0, gain) : gain;
        _least = isExplained ? Math.Max(_least + gain, Math.Min(_least, -room)) : _least + gain;
        double surplus = _least > room ? _least : _most < -room && !isExplained ? _most : 0;
        _least -= surplus;
        _most = Math.Min(room, _most - surplus);
        return surplus;
    }
}
