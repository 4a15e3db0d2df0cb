using System;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// A block of freedoms that loops and couplings tie together, as a linkage of its own: what it can do depends on nothing
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

    /// <summary>The same with all bodies held where they stand but some.</summary>
    /// <param name="isMoving">Of one of the mechanism's bodies: whether it moves.</param>
    public IndependentLinkage Holding(Func<int, bool> isMoving)
    {
        KinematicTree tree = Linkage.Tree;
        bool[] isFixed = Array.ConvertAll(Bodies, body => !isMoving(body));
        var isClosure = new bool[Joints.Length];
        for (int j = 0; j < isClosure.Length; j++)
        {
            isClosure[j] = tree.ChildOf[j] < 0;
        }

        return new IndependentLinkage(new Linkage(isFixed, Linkage.Joints, isClosure, Linkage.Coordinates, Linkage.Couplings, Linkage.Origin, Linkage.Length), Bodies, Joints, _coordinates);
    }

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
