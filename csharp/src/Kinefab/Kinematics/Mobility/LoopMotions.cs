using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>The independent motions of one block as its bodies show them, bodies that are rigidly joined counting as one group.</summary>
internal sealed class LoopMotions
{
    private readonly IndependentLinkage _part;
    private readonly VelocitySpace _space;
    private readonly Dictionary<int, int> _moverOf = new();

    /// <summary>Of a block.</summary>
    /// <param name="loop">Which.</param>
    /// <param name="space">Its velocities at some pose.</param>
    /// <param name="movers">The mechanism's bodies that have freedoms in it.</param>
    /// <param name="rigid">Groups of the mechanism's bodies.</param>
    public LoopMotions(LoopMobility loop, VelocitySpace space, IReadOnlyList<int> movers, DisjointSets rigid)
    {
        _part = loop.Part;
        _space = space;
        foreach (int body in movers)
        {
            // One body of a group has freedoms, the others hang on it.
            Groups.Add(rigid.Find(body));
            _moverOf[rigid.Find(body)] = loop.Part.IndexOf(body);
        }

        Groups.Sort();
        foreach (PositionCoupling coupling in _part.Linkage.Couplings)
        {
            // A screw's is within one joint.
            foreach (int term in coupling.Terms)
            {
                IsCoupled |= _part.Linkage.Coordinates[term].Joint != _part.Linkage.Coordinates[coupling.Driven].Joint;
            }
        }
    }

    /// <summary>The groups that move, each by the body that stands for it, rising.</summary>
    public List<int> Groups { get; } = new();

    /// <inheritdoc cref="VelocitySpace.Noise"/>
    public double Noise => _space.Noise;

    /// <summary>Number of motions.</summary>
    public int Count => _space.Freedoms;

    /// <summary>Whether a coupling ties different joints of the block to each other.</summary>
    public bool IsCoupled { get; }

    /// <summary>A group's velocity at the mechanism's origin, in its lengths, and its angular velocity in one of the motions.</summary>
    public void Twist(int group, int motion, out Vector3d linear, out Vector3d angular) =>
        _space.Twist(_moverOf[group], _space.Basis[motion], out linear, out angular);
}
