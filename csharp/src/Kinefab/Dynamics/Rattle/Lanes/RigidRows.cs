using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

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
    /// <summary>Levers and axes in the world's axes at the end of the flight.</summary>
    public static void Place(Batch<V> batch)
    {
        Node[] nodes = batch.Shape.Nodes;
        for (int n = 0; n < nodes.Length; n++)
        {
            if (nodes[n].Joint != null)
            {
                Place(batch, n, nodes[n], 0);
                Place(batch, n, nodes[n], 1);
            }
        }
    }

    /// <summary>Places levers and axes and finds C of all rows but those with a law.</summary>
    public static void Evaluate(Batch<V> batch)
    {
        Place(batch);
        int w = Lane<V>.Width;
        Node[] nodes = batch.Shape.Nodes;
        for (int n = 0; n < nodes.Length; n++)
        {
            Node node = nodes[n];
            int row = batch.Shape.Pattern.Rows[n] * w;
            if (node.IsPrepared)
            {
                PreparedRows<V>.Evaluate(batch, n);
            }

            if (node.Joint != null)
            {
                int linear = EvaluateLinear(batch, n, node, row);
                EvaluateAngular(batch, n, node, row + linear * w);
            }
        }

        if (batch.SoftStep > 0)
        {
            SoftAngles<V>.Evaluate(batch);
        }

    }

    /// <summary>J of all rows where levers and axes were last placed.</summary>
    public static void Build(Batch<V> batch)
    {
        Node[] nodes = batch.Shape.Nodes;
        for (int n = 0; n < nodes.Length; n++)
        {
            if (nodes[n].Joint != null)
            {
                int row = batch.Row(n, 0, 0);
                int stride = 6 * Lane<V>.Width;
                if (nodes[n].LinearMask == 7)
                {
                    BuildAnchor(batch, n, row);
                    row += 3 * stride;
                }
                else
                {
                    for (int axis = 0; axis < 3; axis++)
                    {
                        if ((nodes[n].LinearMask & (1 << axis)) != 0)
                        {
                            BuildAlong(batch, n, nodes[n], axis, row);
                            row += stride;
                        }
                    }
                }

                for (int i = 0; i < nodes[n].Turns; i++, row += stride)
                {
                    BuildTurn(batch, n, nodes[n], i, row);
                }
            }

            if (nodes[n].IsPrepared)
            {
                PreparedRows<V>.Build(batch, n);
            }
        }
    }

    private static void Place(Batch<V> batch, int n, Node node, int side)
    {
        int body = node.Bodies[side];
        if (batch.Shape.IsStatic[body])
        {
            return;
        }

        ToWorld(
            batch.Bodies, Batch<V>.Body(body, BodySlot.R), batch.Joints, Batch<V>.Joint(n, Batch<V>.Frame(side)),
            Batch<V>.Joint(n, Batch<V>.Placed(side)), side == 0 ? node.PlacedMask0 : node.PlacedMask1);
    }

    // Turns those vectors of a frame that the mask names, by one matrix.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void ToWorld(double[] bodies, int matrix, double[] joints, int from, int to, int mask)
    {
        int step = 3 * Lane<V>.Width;
        LaneVector<V> x = LaneVector<V>.Load(bodies, matrix);
        LaneVector<V> y = LaneVector<V>.Load(bodies, matrix + step);
        LaneVector<V> z = LaneVector<V>.Load(bodies, matrix + 2 * step);
        for (; mask != 0; mask >>= 1, from += step, to += step)
        {
            if ((mask & 1) != 0)
            {
                LaneVector<V> v = LaneVector<V>.Load(joints, from);
                new LaneVector<V>(LaneVector<V>.Dot(x, v), LaneVector<V>.Dot(y, v), LaneVector<V>.Dot(z, v)).Store(joints, to);
            }
        }
    }

    // Returns the number of rows.
    private static int EvaluateLinear(Batch<V> batch, int n, Node node, int row)
    {
        if (node.LinearMask == 0)
        {
            return 0;
        }

        int x0 = Batch<V>.Body(node.Bodies[0], BodySlot.EndX);
        int x1 = Batch<V>.Body(node.Bodies[1], BodySlot.EndX);
        if (node.LinearMask == 7)
        {
            Gap(batch, n, x0, x1).Store(batch.Work.Error, row);
            return 3;
        }

        int rows = 0;
        for (int axis = 0; axis < 3; axis++)
        {
            if ((node.LinearMask & (1 << axis)) != 0)
            {
                GapAlong(batch, n, x0, x1, axis, row + rows * Lane<V>.Width);
                rows++;
            }
        }

        return rows;
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void GapAlong(Batch<V> batch, int n, int x0, int x1, int axis, int row) =>
        LaneVector<V>.Dot(Axis(batch, n, 0, axis), Gap(batch, n, x0, x1)).Store(batch.Work.Error, row);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Gap(Batch<V> batch, int n, int x0, int x1) =>
        (LaneVector<V>.Load(batch.Bodies, x0) + Lever(batch, n, 0)) - (LaneVector<V>.Load(batch.Bodies, x1) + Lever(batch, n, 1));

    private static void EvaluateAngular(Batch<V> batch, int n, Node node, int row)
    {
        for (int i = 0; i < node.Turns; i++, row += Lane<V>.Width)
        {
            node.Turn(i, out int axis0, out int axis1);
            LaneVector<V>.Dot(Axis(batch, n, 0, axis0), Axis(batch, n, 1, axis1)).Store(batch.Work.Error, row);
        }
    }

    /// <summary>The largest error of all rows, its largest change and the largest gap, of each lane.</summary>
    public static void Rate(Batch<V> batch)
    {
        int w = Lane<V>.Width;
        double[] errors = batch.Work.Error;
        double[] last = batch.Work.LastError;
        bool[] isAngular = batch.Shape.IsAngular;
        Lane<V> most = Lane<V>.Splat(0);
        Lane<V> change = Lane<V>.Splat(0);
        Lane<V> gap = Lane<V>.Splat(0);

        // The largest number skips what is not one; the sum does not.
        Lane<V> sum = Lane<V>.Splat(0);
        for (int i = 0; i < isAngular.Length; i++)
        {
            Lane<V> c = Lane<V>.Load(errors, i * w);
            change = Lane<V>.Max(change, Lane<V>.Abs(c - Lane<V>.Load(last, i * w)));
            c.Store(last, i * w);
            c = Lane<V>.Abs(c);
            most = Lane<V>.Max(most, c);
            sum += c;
            gap = isAngular[i] ? gap : Lane<V>.Max(gap, c);
        }

        (most + (sum - sum)).Store(batch.Work.MaxError, 0);
        change.Store(batch.Work.MaxChange, 0);
        gap.Store(batch.Work.MaxGap, 0);
    }

    /// <summary>The lever off an anchor's built rows r x e; reversed on side 1, as they are.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> BuiltLever(double[] rows, int first)
    {
        int w = Lane<V>.Width;
        return new LaneVector<V>(Lane<V>.Load(rows, first + 8 * w), Lane<V>.Load(rows, first + 12 * w), Lane<V>.Load(rows, first + w));
    }

    // r x e for e = x, y, z: (0, rz, -ry), (-rz, 0, rx), (ry, -rx, 0); the linear parts are known by RowClass.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void BuildAnchor(Batch<V> batch, int n, int row)
    {
        double[] rows = batch.Angular;
        int side = 3 * Lane<V>.Width;
        Lane<V> zero = Lane<V>.Splat(0);
        LaneVector<V> r0 = Lever(batch, n, 0);
        LaneVector<V> r1 = Lever(batch, n, 1);
        new LaneVector<V>(zero, r0.Z, zero - r0.Y).Store(rows, row);
        new LaneVector<V>(zero, zero - r1.Z, r1.Y).Store(rows, row + side);
        new LaneVector<V>(zero - r0.Z, zero, r0.X).Store(rows, row + 2 * side);
        new LaneVector<V>(r1.Z, zero, zero - r1.X).Store(rows, row + 3 * side);
        new LaneVector<V>(r0.Y, zero - r0.X, zero).Store(rows, row + 4 * side);
        new LaneVector<V>(zero - r1.Y, r1.X, zero).Store(rows, row + 5 * side);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void BuildAlong(Batch<V> batch, int n, Node node, int axis, int row)
    {
        int side = 3 * Lane<V>.Width;
        LaneVector<V> gap = Gap(batch, n, Batch<V>.Body(node.Bodies[0], BodySlot.EndX), Batch<V>.Body(node.Bodies[1], BodySlot.EndX));
        LaneVector<V> a = Axis(batch, n, 0, axis);
        a.Store(batch.Linear, row);
        LaneVector<V>.Cross(Lever(batch, n, 0) - gap, a).Store(batch.Angular, row);
        (-a).Store(batch.Linear, row + side);
        LaneVector<V>.Cross(a, Lever(batch, n, 1)).Store(batch.Angular, row + side);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void BuildTurn(Batch<V> batch, int n, Node node, int i, int row)
    {
        node.Turn(i, out int axis0, out int axis1);
        LaneVector<V> turn = LaneVector<V>.Cross(Axis(batch, n, 0, axis0), Axis(batch, n, 1, axis1));
        turn.Store(batch.Angular, row);
        (-turn).Store(batch.Angular, row + 3 * Lane<V>.Width);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Lever(Batch<V> batch, int n, int side) => LaneVector<V>.Load(batch.Joints, Batch<V>.Joint(n, Batch<V>.Placed(side)));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Axis(Batch<V> batch, int n, int side, int axis) =>
        LaneVector<V>.Load(batch.Joints, Batch<V>.Joint(n, Batch<V>.Placed(side) + 3 * (axis + 1)));
}
