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
internal static class BilateralRows<V>
    where V : struct, ILane<V>
{
    /// <summary>Levers and axes in the world's axes at the end of the drift.</summary>
    public static void Place(LaneRecords<V> batch)
    {
        RowBlock[] blocks = batch.Shape.Blocks;
        for (int n = 0; n < blocks.Length; n++)
        {
            if (blocks[n].Joint != null)
            {
                Place(batch, n, blocks[n], 0);
                Place(batch, n, blocks[n], 1);
            }
        }
    }

    /// <summary>Places levers and axes and finds C of all bilateral rows.</summary>
    public static void Evaluate(LaneRecords<V> batch)
    {
        Place(batch);
        int w = Lane<V>.Width;
        RowBlock[] blocks = batch.Shape.Blocks;
        for (int n = 0; n < blocks.Length; n++)
        {
            RowBlock block = blocks[n];
            int row = batch.Shape.Pattern.Rows[n] * w;
            if (block.IsAssembled)
            {
                AssembledRows<V>.Evaluate(batch, n);
            }
            else if (block.Coupling != null)
            {
                CoupledTurns<V>.Evaluate(batch, n);
            }

            if (block.Joint != null)
            {
                int linear = EvaluateLinear(batch, n, block, row);
                EvaluateAngular(batch, n, block, row + linear * w);
            }
        }
    }

    /// <summary>J of all rows where levers and axes were last placed.</summary>
    public static void Build(LaneRecords<V> batch)
    {
        RowBlock[] blocks = batch.Shape.Blocks;
        for (int n = 0; n < blocks.Length; n++)
        {
            if (blocks[n].Joint != null)
            {
                int row = batch.Row(n, 0, 0);
                int stride = 6 * Lane<V>.Width;
                if (blocks[n].LinearMask == 7)
                {
                    BuildPoint(batch, n, row);
                    row += 3 * stride;
                }
                else
                {
                    for (int axis = 0; axis < 3; axis++)
                    {
                        if ((blocks[n].LinearMask & (1 << axis)) != 0)
                        {
                            BuildAlong(batch, n, blocks[n], axis, row);
                            row += stride;
                        }
                    }
                }

                for (int i = 0; i < blocks[n].LockedRotations; i++, row += stride)
                {
                    BuildRotation(batch, n, blocks[n], i, row);
                }
            }

            if (blocks[n].IsAssembled)
            {
                AssembledRows<V>.Build(batch, n);
            }
            else if (blocks[n].Coupling != null)
            {
                CoupledTurns<V>.Build(batch, n);
            }
        }
    }

    private static void Place(LaneRecords<V> batch, int n, RowBlock block, int side)
    {
        int body = block.Bodies[side];
        if (batch.Shape.IsStatic[body])
        {
            return;
        }

        ToWorld(
            batch.Bodies, LaneRecords<V>.Body(body, BodyLanes.R), batch.Joints, LaneRecords<V>.Joint(n, LaneRecords<V>.Frame(side)),
            LaneRecords<V>.Joint(n, LaneRecords<V>.WorldFrame(side)), side == 0 ? block.WorldLeverMask0 : block.WorldLeverMask1);
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
    private static int EvaluateLinear(LaneRecords<V> batch, int n, RowBlock block, int row)
    {
        if (block.LinearMask == 0)
        {
            return 0;
        }

        int x0 = LaneRecords<V>.Body(block.Bodies[0], BodyLanes.EndX);
        int x1 = LaneRecords<V>.Body(block.Bodies[1], BodyLanes.EndX);
        if (block.LinearMask == 7)
        {
            Gap(batch, n, x0, x1).Store(batch.Work.Error, row);
            return 3;
        }

        int rows = 0;
        for (int axis = 0; axis < 3; axis++)
        {
            if ((block.LinearMask & (1 << axis)) != 0)
            {
                GapAlong(batch, n, x0, x1, axis, row + rows * Lane<V>.Width);
                rows++;
            }
        }

        return rows;
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void GapAlong(LaneRecords<V> batch, int n, int x0, int x1, int axis, int row) =>
        LaneVector<V>.Dot(Axis(batch, n, 0, axis), Gap(batch, n, x0, x1)).Store(batch.Work.Error, row);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Gap(LaneRecords<V> batch, int n, int x0, int x1) =>
        (LaneVector<V>.Load(batch.Bodies, x0) + Lever(batch, n, 0)) - (LaneVector<V>.Load(batch.Bodies, x1) + Lever(batch, n, 1));

    private static void EvaluateAngular(LaneRecords<V> batch, int n, RowBlock block, int row)
    {
        for (int i = 0; i < block.LockedRotations; i++, row += Lane<V>.Width)
        {
            block.RotationPlane(i, out int axis0, out int axis1);
            LaneVector<V>.Dot(Axis(batch, n, 0, axis0), Axis(batch, n, 1, axis1)).Store(batch.Work.Error, row);
        }
    }

    /// <summary>The largest error of all rows, its largest change and the largest gap, of each lane.</summary>
    public static void MeasureErrors(LaneRecords<V> batch)
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
        return new LaneVector<V>(Lane<V>.Load(rows, first, 8), Lane<V>.Load(rows, first, 12), Lane<V>.Load(rows, first, 1));
    }

    // r x e for e = x, y, z: (0, rz, -ry), (-rz, 0, rx), (ry, -rx, 0); the linear parts are known by RowClass.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void BuildPoint(LaneRecords<V> batch, int n, int row)
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
    private static void BuildAlong(LaneRecords<V> batch, int n, RowBlock block, int axis, int row)
    {
        int side = 3 * Lane<V>.Width;
        LaneVector<V> gap = Gap(batch, n, LaneRecords<V>.Body(block.Bodies[0], BodyLanes.EndX), LaneRecords<V>.Body(block.Bodies[1], BodyLanes.EndX));
        LaneVector<V> a = Axis(batch, n, 0, axis);
        a.Store(batch.Linear, row);
        LaneVector<V>.Cross(Lever(batch, n, 0) - gap, a).Store(batch.Angular, row);
        (-a).Store(batch.Linear, row + side);
        LaneVector<V>.Cross(a, Lever(batch, n, 1)).Store(batch.Angular, row + side);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void BuildRotation(LaneRecords<V> batch, int n, RowBlock block, int i, int row)
    {
        block.RotationPlane(i, out int axis0, out int axis1);
        LaneVector<V> turn = LaneVector<V>.Cross(Axis(batch, n, 0, axis0), Axis(batch, n, 1, axis1));
        turn.Store(batch.Angular, row);
        (-turn).Store(batch.Angular, row + 3 * Lane<V>.Width);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Lever(LaneRecords<V> batch, int n, int side) => LaneVector<V>.Load(batch.Joints, LaneRecords<V>.Joint(n, LaneRecords<V>.WorldFrame(side)));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Axis(LaneRecords<V> batch, int n, int side, int axis) =>
        LaneVector<V>.Load(batch.Joints, LaneRecords<V>.Joint(n, LaneRecords<V>.WorldFrame(side) + 3 * (axis + 1)));
}
