using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>What the joints' locked axes and limits did in a step, and which joints it broke.</summary>
internal static class Reactions<V>
    where V : struct, ILane<V>
{
    /// <summary>Writes the mechanism's reactions of the joints of a batch's islands that are active; marks those that broke.</summary>
    /// <param name="batch">Built at the end pose.</param>
    /// <param name="count">Lanes with an island of their own.</param>
    /// <param name="reactions">Where to.</param>
    /// <param name="dt">Step, s.</param>
    /// <param name="impulses">Those of the whole step.</param>
    public static void Report(LaneBatch<V> batch, int count, JointReaction[] reactions, double dt, double[] impulses)
    {
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            if (block.Joint == null)
            {
                continue;
            }

            Sum(batch, n, block, 1 / dt, impulses);
            for (int lane = 0; lane < count; lane++)
            {
                if (batch.Work.Active[lane] == 0)
                {
                    continue;
                }

                int index = batch.JointMembers[n * Lane<V>.Width + lane];
                Vector3d force = LaneTransfer<V>.ReadVector(batch.Work.Reaction, lane);
                Vector3d torque = LaneTransfer<V>.ReadVector(batch.Work.Reaction, 3 * Lane<V>.Width + lane);
                if (batch.ActiveSet != null)
                {
                    AddLimits(batch, batch.ActiveSet, n, 1 / dt, ref force, ref torque);
                }
                else if (batch.Axes != null)
                {
                    double impulse = batch.Axes.LimitImpulse(n, lane, impulses);
                    torque += impulse == 0 ? Vector3d.Zero : LaneTransfer<V>.ReadVector(batch.Joints, LaneBatch<V>.Joint(n, LaneBatch<V>.WorldFrame(1) + 3) + lane) * (impulse / dt);
                }

                // The anchors of a slide stand apart: it is the one in actor 1 that counts. Those of other joints meet.
                JointModel joint = batch.Models[n * Lane<V>.Width + lane]!;
                if (block.LinearMask != 7)
                {
                    torque -= Vector3d.Cross(Anchor(batch, n, block, 1, lane) - Anchor(batch, n, block, 0, lane), force);
                }

                reactions[index] = new JointReaction { Force = force, Torque = torque };
                if (force.LengthSquared > joint.BreakForce * joint.BreakForce || torque.LengthSquared > joint.BreakTorque * joint.BreakTorque)
                {
                    joint.IsBroken = true;
                }
            }
        }
    }

    // In the world.
    private static Vector3d Anchor(LaneBatch<V> batch, int n, RowBlock block, int side, int lane) =>
        LaneTransfer<V>.ReadVector(batch.Bodies, LaneBatch<V>.Body(block.Bodies[side], BodyLanes.EndX) + lane)
        + LaneTransfer<V>.ReadVector(batch.Joints, LaneBatch<V>.Joint(n, LaneBatch<V>.WorldFrame(side)) + lane);

    // Force and torque about the anchor in actor 0 of the rigid rows, as they act on body 0. An anchor's own rows have no torque there.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void Sum(LaneBatch<V> batch, int n, RowBlock block, double rate, double[] impulses)
    {
        int w = Lane<V>.Width;
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> times = Lane<V>.Splat(rate);
        var force = new LaneVector<V>(zero, zero, zero);
        LaneVector<V> torque = force;
        int row = batch.Shape.Pattern.Rows[n] * w;
        int i = 0;
        if (block.LinearMask == 7)
        {
            force = LaneVector<V>.Load(impulses, row);
            i = 3;
        }

        for (; i < block.BilateralCount; i++)
        {
            Lane<V> impulse = Lane<V>.Load(impulses, row + i * w);
            int o = batch.Row(n, i, 0);
            torque += impulse * LaneVector<V>.Load(batch.Angular, o);
            if (block.Classes[i] == RowClass.General)
            {
                LaneVector<V> share = impulse * LaneVector<V>.Load(batch.Linear, o);
                force += share;
                torque -= LaneVector<V>.Cross(LaneVector<V>.Load(batch.Joints, LaneBatch<V>.Joint(n, LaneBatch<V>.WorldFrame(0))), share);
            }
        }

        (times * force).Store(batch.Work.Reaction, 0);
        (times * torque).Store(batch.Work.Reaction, 3 * w);
    }

    private static void AddLimits(LaneBatch<V> batch, ActiveSet<V> scalars, int n, double rate, ref Vector3d force, ref Vector3d torque)
    {
        Vector3d linear = Vector3d.Zero;
        Vector3d angular = Vector3d.Zero;
        scalars.AddLimits(n, ref linear, ref angular);
        force += linear * rate;
        torque += (angular - Vector3d.Cross(LaneTransfer<V>.ReadVector(batch.Joints, LaneBatch<V>.Joint(n, LaneBatch<V>.WorldFrame(0))), linear)) * rate;
    }
}
