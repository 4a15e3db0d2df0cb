using System;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// An island's account of energy from step to step: by how much what it has lies above what it had and was given since. A step that would
/// take that beyond a small share of the largest energy so far is too coarse. Below, the account follows what blows, dampers and
/// limits take, so that they leave no room for a gain.
/// </summary>
internal struct EnergyLedger
{
    // Of the largest energy so far, to either side of what was given.
    private const double Share = 5e-4;

    private double _excess;
    private double _largest;

    /// <summary>Whether a step may be taken.</summary>
    /// <param name="gain">What it gained beyond what forces and drives gave it, J.</param>
    /// <param name="energy">What moves at its end, J.</param>
    /// <param name="mayLose">Whether energy may go, as into limits and dampers.</param>
    public readonly bool Allows(double gain, double energy, bool mayLose)
    {
        double most = Share * Math.Max(_largest, energy);
        double excess = _excess + gain;
        return excess <= most && (mayLose || gain >= 0 || excess >= -most);
    }

    /// <summary>Takes down a step that was taken.</summary>
    public void Enter(double gain, double energy)
    {
        _largest = Math.Max(_largest, energy);
        double most = Share * _largest;
        _excess = Math.Min(most, Math.Max(-most, _excess + gain));
    }
}
