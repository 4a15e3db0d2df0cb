using System.Collections.Generic;
using Kinefab.Joints;

namespace Kinefab.Kinematics;

/// <summary>Which tree freedoms each joint, coordinate and coupling of a mechanism depends on.</summary>
internal sealed class MechanismRows
{
    public MechanismRows(KinematicTree tree, JointModel[] joints, MechanismCoordinate[] coordinates, PositionCoupling[] couplings)
    {
        Joints = new RowPath[joints.Length];
        for (int j = 0; j < Joints.Length; j++)
        {
            Joints[j] = RowPath.Between(tree, joints[j].Body0, joints[j].Body1);
        }

        Couplings = new RowPath[couplings.Length];
        for (int i = 0; i < Couplings.Length; i++)
        {
            PositionCoupling coupling = couplings[i];
            Couplings[i] = Joints[coordinates[coupling.Driven].Joint];
            foreach (int term in coupling.Terms)
            {
                Couplings[i] = RowPath.Union(Couplings[i], Joints[coordinates[term].Joint], tree.Freedoms);
            }
        }

        var all = new List<RowPath>(Joints);
        all.AddRange(Couplings);
        All = all;
    }

    /// <summary>For each joint the path between its bodies: one body for a tree joint, a loop for a closing one.</summary>
    public RowPath[] Joints { get; }

    /// <summary>For each coupling the path of all its joints.</summary>
    public RowPath[] Couplings { get; }

    /// <summary>All of the above.</summary>
    public IReadOnlyList<RowPath> All { get; }
}
