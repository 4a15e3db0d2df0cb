using System.Collections.Generic;

namespace Kinefab.Kinematics;

/// <summary>Which tree freedoms each joint, coordinate and coupling of a mechanism depends on.</summary>
internal sealed class MechanismRows
{
    public MechanismRows(Mechanism mechanism)
    {
        KinematicTree tree = mechanism.Tree;
        Joints = new RowPath[mechanism.Joints.Length];
        for (int j = 0; j < Joints.Length; j++)
        {
            Joints[j] = RowPath.Between(tree, mechanism.Joints[j].Body0, mechanism.Joints[j].Body1);
        }

        Couplings = new RowPath[mechanism.Couplings.Length];
        for (int i = 0; i < Couplings.Length; i++)
        {
            PositionCoupling coupling = mechanism.Couplings[i];
            RowPath a = Joints[mechanism.Coordinates[coupling.A].Joint];
            RowPath b = Joints[mechanism.Coordinates[coupling.B].Joint];
            Couplings[i] = RowPath.Union(b, a, tree.Freedoms);
        }

        var all = new List<RowPath>(Joints);
        all.AddRange(Couplings);
        All = all;
    }

    /// <summary>For each joint the path between its bodies: one body for a tree joint, a loop for a closing one.</summary>
    public RowPath[] Joints { get; }

    /// <summary>For each coupling the path of both its joints.</summary>
    public RowPath[] Couplings { get; }

    /// <summary>All of the above.</summary>
    public IReadOnlyList<RowPath> All { get; }
}
