using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>
/// What the joints of an articulation carry: for every branch its masses times accelerations less the forces on it, from the tips inwards, which
/// is the second half of the recursive Newton-Euler algorithm. Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, section 5.3.
/// </summary>
internal sealed class CarriedWrenches
{
    private readonly ArticulationTree _tree;
    private readonly Wrench[] _carried;

    public CarriedWrenches(ArticulationTree tree)
    {
        _tree = tree;
        _carried = new Wrench[tree.Count];
    }

    /// <summary>Of each link what the one above does to it by their joint, world axes, about the link's centre of mass; that of the root has no meaning.</summary>
    /// <param name="rotations">Poses of the links, of which the rotations count.</param>
    /// <param name="levers">From each parent's centre of mass to the link's.</param>
    /// <param name="accelerations">Of the links' centres of mass.</param>
    /// <param name="forces">On each link from outside, less what its spin resists with.</param>
    public ReadOnlySpan<Wrench> Find(ReadOnlySpan<Pose> rotations, ReadOnlySpan<Vector3d> levers, ReadOnlySpan<Twist> accelerations, ReadOnlySpan<Wrench> forces)
    {
        for (int i = 0; i < _tree.Count; i++)
        {
            LinkDefinition link = _tree.Links[i];
            Quaterniond q = rotations[i].Rotation;
            Twist a = accelerations[i];
            _carried[i] = new Wrench(a.Linear * link.Mass, q * Vector3d.Scale(link.Inertia, q.InverseRotate(a.Angular))) - forces[i];
        }

        for (int i = _tree.Count - 1; i > 1; i--)
            _carried[_tree.Parents[i]] += _carried[i].From(levers[i]);
        return _carried;
    }
}
