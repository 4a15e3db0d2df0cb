using System;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// A block of freedoms that loops and couplings tie together, or some bodies, as a linkage of its own: what it can do depends on nothing
/// else in the mechanism. What it hangs on stands still.
/// </summary>
internal sealed class IndependentLinkage
{
    private readonly int[] _coordinates;

    public IndependentLinkage(Linkage linkage, int[] bodies, int[] joints, int[] coordinates)
    {
        Linkage = linkage;
        Bodies = bodies;
        Joints = joints;
        _coordinates = coordinates;
    }

    public Linkage Linkage { get; }

    /// <summary>For each of its bodies the mechanism's, rising.</summary>
    public int[] Bodies { get; }

    /// <summary>For each of its joints the mechanism's, rising.</summary>
    public int[] Joints { get; }

    /// <summary>Its place in a body list of its own, from the mechanism's.</summary>
    public int IndexOf(int body) => Array.BinarySearch(Bodies, body);

    /// <summary>The part's own copy of a state.</summary>
    public MechanismState StateOf(MechanismState whole)
    {
        var state = new MechanismState(whole.Mechanism, Bodies.Length, _coordinates.Length);
        for (int i = 0; i < Bodies.Length; i++)
        {
            state.Poses[i] = whole.Poses[Bodies[i]];
        }

        for (int i = 0; i < _coordinates.Length; i++)
        {
            state.Values[i] = whole.Values[_coordinates[i]];
        }

        return state;
    }
}
