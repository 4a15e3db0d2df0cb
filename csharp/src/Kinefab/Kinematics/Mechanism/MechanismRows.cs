using System.Collections.Generic;

namespace Kinefab.Kinematics;

/// <summary>Which tree freedoms each joint, coordinate and coupling of a mechanism depends on.</summary>
internal sealed class MechanismRows
{
    public MechanismRows(Linkage linkage)
    {
        KinematicTree tree = linkage.Tree;
        Joints = new RowPath[linkage.Joints.Length];
        for (int j = 0; j < Joints.Length; j++)
        {
            Joints[j] = RowPath.Between(tree, linkage.Joints[j].Body0, linkage.Joints[j].Body1);
        }

        Couplings = new RowPath[linkage.Couplings.Length];
        for (int i = 0; i < Couplings.Length; i++)
        {
            PositionCoupling coupling = linkage.Couplings[i];
            RowPath a = Joints[linkage.Coordinates[coupling.A].Joint];
            RowPath b = Joints[linkage.Coordinates[coupling.B].Joint];
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
