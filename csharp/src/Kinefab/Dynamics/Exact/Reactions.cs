using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>What the joints' locked axes and limits did in a step, and which joints it broke.</summary>
internal static class Reactions<V>
    where V : struct, ILane<V>
{
    /// <summary>Writes the mechanism's reactions of one lane's joints; true when one broke.</summary>
    public static bool Report(Batch<V> batch, int lane, Island island, MultibodySystem mechanism, double dt)
    {
        bool isBroken = false;
        int w = Lane<V>.Width;
        for (int n = 0; n < island.Nodes.Length; n++)
        {
            Node node = island.Nodes[n];
            Joint? joint = node.Joint;
            if (joint == null)
            {
                continue;
            }

            int row = batch.Shape.Pattern.Rows[n] * w + lane;
            Vector3d linear = Vector3d.Zero;
            Vector3d angular = Vector3d.Zero;
            for (int i = 0; i < node.RigidRows; i++)
            {
                double impulse = batch.Total[row + i * w];
                int o = batch.Row(n, i, 0, 0) + lane;
                angular += Vector(batch.Rows, o + Batch<V>.Angular * w) * impulse;
                linear += node.Classes[i] switch
                {
                    RowClass.UnitX => new Vector3d(impulse, 0, 0),
                    RowClass.UnitY => new Vector3d(0, impulse, 0),
                    RowClass.UnitZ => new Vector3d(0, 0, impulse),
                    RowClass.Angular => Vector3d.Zero,
                    _ => Vector(batch.Rows, o) * impulse,
                };
            }

            batch.Laws?.AddLimits(n, ref linear, ref angular);
            angular -= Vector3d.Cross(Vector(batch.Joints, Batch<V>.Joint(n, Batch<V>.Placed(0)) + lane), linear);
            mechanism.Reactions[node.Index] = new JointReaction { Force = linear * (1 / dt), Torque = angular * (1 / dt) };
            if (linear.Length > joint.BreakForce * dt || angular.Length > joint.BreakTorque * dt)
            {
                joint.IsBroken = true;
                isBroken = true;
            }
        }

        return isBroken;
    }

    private static Vector3d Vector(double[] a, int index) => new(a[index], a[index + Lane<V>.Width], a[index + 2 * Lane<V>.Width]);
}
