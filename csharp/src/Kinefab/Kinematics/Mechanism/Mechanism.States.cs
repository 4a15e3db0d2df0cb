using System;

namespace Kinefab.Kinematics;

/// <content>States of the mechanism: apart, since a state knows its mechanism.</content>
public sealed partial class Mechanism
{
    /// <summary>A state at the exported pose.</summary>
    /// <returns>Of its own: several may be moved side by side.</returns>
    public MechanismState NewState()
    {
        var state = new MechanismState(this, _start.Length, _coordinates.Length);
        Array.Copy(_start, state.Poses, _start.Length);
        for (int i = 0; i < _coordinates.Length; i++)
        {
            state.Values[i] = _coordinates[i].Zero;
            state.Trail[i] = _coordinates[i].Zero;
        }

        return state;
    }
}
