using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// The locked axes of joints in closed form, many islands at a time. Frames (p, axes x y z) are the joint's frame 0 in
/// body 0 and frame 1 in body 1; r are levers from the centres of mass.
/// All linear axes locked: C = p0 - p1, for each world axis e: J = (e, r0 x e; -e, -r1 x e).
/// Some locked, along a of frame 0: C = a.(p0 - p1), J = (a, (p1 - x0) x a; -a, -r1 x a).
/// Angular, for two axes a of frame 0 and b of frame 1 that stay at right angles: C = a.b, J = (0, a x b; 0, -(a x b)).
/// They span the same motions as the rows of <see cref="Joints.RowWriter.Locked"/>.
/// </summary>
internal static class RigidRows<V>
    where V : struct, ILane<V>
{
    /// <summary>C of the rigid rows at the end of the flight; the largest one, and the largest change, of each lane.</summary>
    public static void Evaluate(Batch<V> batch)
    {
        double[] errors = batch.Error;
        double[] last = batch.LastError;
        int w = Lane<V>.Width;
        Lane<V> most = Lane<V>.Splat(0);
        Lane<V> change = Lane<V>.Splat(0);
        Lane<V> gap = Lane<V>.Splat(0);
        Node[] nodes = batch.Shape.Nodes;
        for (int n = 0; n < nodes.Length; n++)
        {
            Node node = nodes[n];
            int row = batch.Shape.Pattern.Rows[n] * w;
            int end = row + node.Rows * w;
            if (node.IsPrepared)
            {
                PreparedRows<V>.Evaluate(batch, n);
            }

            if (node.Joint != null)
            {
                EvaluateJoint(batch, n, node, row);
            }

            for (int i = 0; row < end; i++, row += w)
            {
                Lane<V> c = Lane<V>.Load(errors, row);
                if (node.Classes[i] != RowClass.Angular)
                {
                    gap = Lane<V>.Max(gap, Lane<V>.Abs(c));
                }

                most = Lane<V>.Max(most, Lane<V>.Abs(c));
                change = Lane<V>.Max(change, Lane<V>.Abs(c - Lane<V>.Load(last, row)));
                c.Store(last, row);
            }
        }

        gap.Store(batch.MaxGap, 0);
        most.Store(batch.MaxError, 0);
        change.Store(batch.MaxChange, 0);
    }

    /// <summary>J of the rigid rows at the end of the flight, and the levers.</summary>
    public static void Build(Batch<V> batch)
    {
        Node[] nodes = batch.Shape.Nodes;
        for (int n = 0; n < nodes.Length; n++)
        {
            if (nodes[n].Joint != null)
            {
                BuildJoint(batch, n, nodes[n]);
            }

            if (nodes[n].IsPrepared)
            {
                PreparedRows<V>.Build(batch, n);
            }
        }
    }

    private static void EvaluateJoint(Batch<V> batch, int n, Node node, int row)
    {
        double[] errors = batch.Error;
        int w = Lane<V>.Width;
        if (node.LinearMask != 0)
        {
            LaneVector<V> gap = Anchor(batch, n, node, 0, out _) - Anchor(batch, n, node, 1, out _);
            if (node.LinearMask == 7)
            {
                gap.Store(errors, row);
                row += 3 * w;
            }
            else
            {
                for (int axis = 0; axis < 3; axis++)
                {
                    if ((node.LinearMask & (1 << axis)) != 0)
                    {
                        LaneVector<V>.Dot(Axis(batch, n, node, 0, axis), gap).Store(errors, row);
                        row += w;
                    }
                }
            }
        }

        int turns = TurnRows(node.Angular);
        for (int i = 0; i < turns; i++)
        {
            Turn(node.Angular, i, out int axis0, out int axis1);
            LaneVector<V>.Dot(Axis(batch, n, node, 0, axis0), Axis(batch, n, node, 1, axis1)).Store(errors, row);
            row += w;
        }
    }

    private static void BuildJoint(Batch<V> batch, int n, Node node)
    {
        double[] rows = batch.Rows;
        int w = Lane<V>.Width;
        Lane<V> zero = Lane<V>.Splat(0);
        LaneVector<V> p0 = Anchor(batch, n, node, 0, out LaneVector<V> r0);
        LaneVector<V> p1 = Anchor(batch, n, node, 1, out LaneVector<V> r1);
        r0.Store(batch.Joints, Batch<V>.Joint(n, Batch<V>.Lever0));
        r1.Store(batch.Joints, Batch<V>.Joint(n, Batch<V>.Lever1));
        int row = batch.Row(n, 0, 0, 0);
        int side = Batch<V>.SideCount * w;
        int angular = Batch<V>.Angular * w;
        if (node.LinearMask == 7)
        {
            // r x e for e = x, y, z: (0, rz, -ry), (-rz, 0, rx), (ry, -rx, 0); the linear parts are known by RowClass.
            new LaneVector<V>(zero, r0.Z, zero - r0.Y).Store(rows, row + angular);
            new LaneVector<V>(zero, zero - r1.Z, r1.Y).Store(rows, row + side + angular);
            new LaneVector<V>(zero - r0.Z, zero, r0.X).Store(rows, row + 2 * side + angular);
            new LaneVector<V>(r1.Z, zero, zero - r1.X).Store(rows, row + 3 * side + angular);
            new LaneVector<V>(r0.Y, zero - r0.X, zero).Store(rows, row + 4 * side + angular);
            new LaneVector<V>(zero - r1.Y, r1.X, zero).Store(rows, row + 5 * side + angular);
            row += 6 * side;
        }
        else
        {
            var none = new LaneVector<V>(zero, zero, zero);
            LaneVector<V> lever = r0 + (p1 - p0);
            for (int i = 0; i < 3; i++)
            {
                if ((node.LinearMask & (1 << i)) != 0)
                {
                    LaneVector<V> a = Axis(batch, n, node, 0, i);
                    a.Store(rows, row);
                    LaneVector<V>.Cross(lever, a).Store(rows, row + angular);
                    (none - a).Store(rows, row + side);
                    LaneVector<V>.Cross(a, r1).Store(rows, row + side + angular);
                    row += 2 * side;
                }
            }
        }

        int turns = TurnRows(node.Angular);
        for (int i = 0; i < turns; i++)
        {
            Turn(node.Angular, i, out int axis0, out int axis1);
            LaneVector<V> a = Axis(batch, n, node, 0, axis0);
            LaneVector<V> b = Axis(batch, n, node, 1, axis1);
            LaneVector<V>.Cross(a, b).Store(rows, row + angular);
            LaneVector<V>.Cross(b, a).Store(rows, row + side + angular);
            row += 2 * side;
        }
    }

    private static int TurnRows(AngularRows angular) => angular switch
    {
        AngularRows.None or AngularRows.Prepared => 0,
        AngularRows.All => 3,
        _ => 2,
    };

    // Which axes of frame 0 and frame 1 stay at right angles: the free axis of 1 with the other two of 0, and for a joint
    // without a free turn also y0 with z1.
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void Turn(AngularRows angular, int row, out int axis0, out int axis1)
    {
        int free = angular == AngularRows.HingeY ? 1 : angular == AngularRows.HingeZ ? 2 : 0;
        if (row == 2)
        {
            axis0 = 1;
            axis1 = 2;
            return;
        }

        axis0 = free + 1 + row;
        axis0 = axis0 > 2 ? axis0 - 3 : axis0;
        axis1 = free;
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Anchor(Batch<V> batch, int n, Node node, int side, out LaneVector<V> lever)
    {
        int body = node.Bodies[side];
        LaneVector<V> local = LaneVector<V>.Load(batch.Joints, Batch<V>.Joint(n, side == 0 ? Batch<V>.Anchor0 : Batch<V>.Anchor1));
        lever = LaneVector<V>.Multiply(batch.Bodies, Batch<V>.Body(body, BodySlot.R), local);
        return LaneVector<V>.Load(batch.Bodies, Batch<V>.Body(body, BodySlot.EndX)) + lever;
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Axis(Batch<V> batch, int n, Node node, int side, int axis)
    {
        int slot = (side == 0 ? Batch<V>.Axes0 : Batch<V>.Axes1) + 3 * axis;
        LaneVector<V> local = LaneVector<V>.Load(batch.Joints, Batch<V>.Joint(n, slot));
        return LaneVector<V>.Multiply(batch.Bodies, Batch<V>.Body(node.Bodies[side], BodySlot.R), local);
    }
}
