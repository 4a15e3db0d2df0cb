using System.Collections.Generic;
using System.Threading;
using Kinefab.Joints;

namespace Kinefab.Kinematics;

/// <summary>Which tree freedoms each joint, coordinate and coupling of a mechanism depends on.</summary>
internal sealed class MechanismRows
{
    /// <summary>Finds them.</summary>
    /// <param name="tree">Over the joints.</param>
    /// <param name="joints">Of the mechanism.</param>
    /// <param name="coordinates">Of these joints.</param>
    /// <param name="couplings">Of these coordinates.</param>
    /// <param name="cancellation">Ends it early, with an OperationCanceledException.</param>
    public MechanismRows(KinematicTree tree, JointModel[] joints, MechanismCoordinate[] coordinates, PositionCoupling[] couplings, CancellationToken cancellation)
    {
        Joints = new RowPath[joints.Length];
        for (int j = 0; j < Joints.Length; j++)
        {
            cancellation.ThrowIfCancellationRequested();
            Joints[j] = RowPath.Between(tree, joints[j].Body0, joints[j].Body1);
        }

        Couplings = new RowPath[couplings.Length];
        for (int i = 0; i < Couplings.Length; i++)
        {
            cancellation.ThrowIfCancellationRequested();
            PositionCoupling coupling = couplings[i];
            var paths = new List<RowPath> { Joints[coordinates[coupling.Driven].Joint] };
            foreach (int term in coupling.Terms)
            {
                paths.Add(Joints[coordinates[term].Joint]);
            }

            Couplings[i] = RowPath.Union(paths, tree.Freedoms);
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
