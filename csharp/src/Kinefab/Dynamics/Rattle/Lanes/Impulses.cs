using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>From impulses to momenta, from momenta to the rows' speeds, by the rows last built.</summary>
internal static class Impulses<V>
    where V : struct, ILane<V>
{
    /// <summary>v += M^-1 J^T l, L += J^T l in the active lanes.</summary>
    public static void Apply(LaneRecords<V> batch, double[] impulses)
    {
        int w = Lane<V>.Width;
        if (w == 1 && batch.Work.Active[0] == 0)
        {
            return;
        }

        RowBlock[] blocks = batch.Shape.Blocks;
        for (int n = 0; n < blocks.Length; n++)
        {
            RowBlock block = blocks[n];
            int row = batch.Shape.Pattern.Rows[n] * w;
            if (block.IsPointJoint)
            {
                ApplyPoint(batch, n, block, impulses, row);
                continue;
            }

            for (int side = 0; side < block.Bodies.Length; side++)
            {
                if (block.Bodies[side] < batch.Shape.MovingBodies)
                {
                    ApplySide(batch, n, block, side, impulses, row);
                }
            }
        }
    }

    // The force l and the torque r x l, both reversed on side 1, and the torques along the turns.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void ApplyPoint(LaneRecords<V> batch, int n, RowBlock block, double[] impulses, int row)
    {
        double[] rows = batch.Angular;
        int w = Lane<V>.Width;
        int o = batch.Row(n, 0, 0);
        LaneVector<V> force = LaneVector<V>.Load(impulses, row);
        LaneVector<V> torque0 = LaneVector<V>.Cross(BilateralRows<V>.BuiltLever(rows, o), force);
        LaneVector<V> torque1 = LaneVector<V>.Cross(BilateralRows<V>.BuiltLever(rows, o + 3 * w), force);
        for (int i = 3; i < block.Rows; i++)
        {
            LaneVector<V> turn = Lane<V>.Load(impulses, row + i * w) * LaneVector<V>.Load(rows, o + 6 * i * w);
            torque0 += turn;
            torque1 -= turn;
        }

        Lane<V> active = Lane<V>.Load(batch.Work.Active, 0);
        if (block.Bodies[0] < batch.Shape.MovingBodies)
        {
            Add(batch, block.Bodies[0], active, force, torque0);
        }

        if (block.Bodies[1] < batch.Shape.MovingBodies)
        {
            Add(batch, block.Bodies[1], active, -force, torque1);
        }
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void Add(LaneRecords<V> batch, int body, Lane<V> active, LaneVector<V> force, LaneVector<V> torque)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        int at = LaneRecords<V>.Body(body, 0);
        LaneVector<V> v = LaneVector<V>.Load(a, at, BodyLanes.V);
        LaneVector<V> momentum = LaneVector<V>.Load(a, at, BodyLanes.L);
        LaneVector<V> faster = v + Lane<V>.Load(a, at, BodyLanes.InverseMass) * force;
        LaneVector<V> turned = momentum + torque;

        // The only lane is active, or nothing is applied at all.
        (w == 1 ? faster : LaneVector<V>.Select(active, faster, v)).Store(a, at, BodyLanes.V);
        (w == 1 ? turned : LaneVector<V>.Select(active, turned, momentum)).Store(a, at, BodyLanes.L);
    }

    // The same of any rows.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void ApplySide(LaneRecords<V> batch, int n, RowBlock block, int side, double[] impulses, int row)
    {
        double[] rows = batch.Angular;
        int w = Lane<V>.Width;
        Lane<V> zero = Lane<V>.Splat(0);
        var force = new LaneVector<V>(zero, zero, zero);
        LaneVector<V> torque = force;
        int o = batch.Row(n, 0, side);
        int stride = 3 * block.Bodies.Length * w;
        int i = 0;
        if (block.LinearMask == 7)
        {
            LaneVector<V> l = LaneVector<V>.Load(impulses, row);
            torque = LaneVector<V>.Cross(BilateralRows<V>.BuiltLever(rows, o), l);
            force = side == 0 ? l : force - l;
            i = 3;
            o += 3 * stride;
        }

        for (; i < block.Rows; i++, o += stride)
        {
            Lane<V> l = Lane<V>.Load(impulses, row + i * w);
            torque += l * LaneVector<V>.Load(rows, o);
            if (block.Classes[i] == RowClass.General)
            {
                force += l * LaneVector<V>.Load(batch.Linear, o);
            }
        }

        Add(batch, block.Bodies[side], Lane<V>.Load(batch.Work.Active, 0), force, torque);
    }

    /// <summary>Solution = -J v of all rows at the built pose.</summary>
    /// <param name="batch">The rows and bodies.</param>
    /// <param name="areFixedMoving">Whether kinematic bodies count with their velocities.</param>
    public static void NegativeSpeeds(LaneRecords<V> batch, bool areFixedMoving = true)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        Lane<V> zero = Lane<V>.Splat(0);
        RowBlock[] blocks = batch.Shape.Blocks;
        for (int n = 0; n < blocks.Length; n++)
        {
            RowBlock block = blocks[n];
            int row = batch.Shape.Pattern.Rows[n] * w;
            int stride = 3 * block.Bodies.Length * w;
            if (block.IsPointJoint)
            {
                NegativePointSpeeds(batch, n, block, row, areFixedMoving);
                continue;
            }

            for (int i = 0; i < block.Rows; i++)
            {
                zero.Store(batch.Work.Solution, row + i * w);
            }

            for (int side = 0; side < block.Bodies.Length; side++)
            {
                int body = block.Bodies[side];
                if (batch.Shape.IsStatic[body] || (!areFixedMoving && body >= batch.Shape.MovingBodies))
                {
                    continue;
                }

                // The turning part is J_w I^-1 L for a moving body, its response being J_w I^-1; J_w w for a kinematic one.
                bool isMoving = body < batch.Shape.MovingBodies;
                int at = LaneRecords<V>.Body(body, 0);
                LaneVector<V> v = LaneVector<V>.Load(a, at, BodyLanes.V);
                LaneVector<V> turn = LaneVector<V>.Load(a, at + (isMoving ? BodyLanes.L : BodyLanes.W) * w);
                double[] rows = isMoving ? batch.Work.Response : batch.Angular;
                int o = batch.Row(n, 0, side);
                for (int i = 0; i < block.Rows; i++, o += stride)
                {
                    Lane<V> speed = LaneVector<V>.Dot(LaneVector<V>.Load(rows, o), turn);
                    switch (block.Classes[i])
                    {
                        case RowClass.Angular:
                            break;
                        case RowClass.General:
                            speed += LaneVector<V>.Dot(LaneVector<V>.Load(batch.Linear, o), v);
                            break;
                        default:
                            Lane<V> component = block.Classes[i] == RowClass.UnitX ? v.X : block.Classes[i] == RowClass.UnitY ? v.Y : v.Z;
                            speed = side == 0 ? speed + component : speed - component;
                            break;
                    }

                    Lane<V> sum = Lane<V>.Load(batch.Work.Solution, row + i * w);
                    (sum - speed).Store(batch.Work.Solution, row + i * w);
                }
            }
        }
    }

    // The same with the sums over both sides in registers.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void NegativePointSpeeds(LaneRecords<V> batch, int n, RowBlock block, int row, bool areFixedMoving)
    {
        int w = Lane<V>.Width;
        double[] solution = batch.Work.Solution;
        Lane<V> zero = Lane<V>.Splat(0);
        var sum = new LaneVector<V>(zero, zero, zero);
        for (int i = 3; i < block.Rows; i++)
        {
            zero.Store(solution, row + i * w);
        }

        for (int side = 0; side < 2; side++)
        {
            int body = block.Bodies[side];
            bool isMoving = body < batch.Shape.MovingBodies;
            if (!isMoving && (!areFixedMoving || batch.Shape.IsStatic[body]))
            {
                continue;
            }

            int at = LaneRecords<V>.Body(body, 0);
            LaneVector<V> v = LaneVector<V>.Load(batch.Bodies, at, BodyLanes.V);
            LaneVector<V> turn = LaneVector<V>.Load(batch.Bodies, at + (isMoving ? BodyLanes.L : BodyLanes.W) * w);
            double[] rows = isMoving ? batch.Work.Response : batch.Angular;
            int o = batch.Row(n, 0, side);
            var speed = new LaneVector<V>(
                LaneVector<V>.Dot(LaneVector<V>.Load(rows, o), turn),
                LaneVector<V>.Dot(LaneVector<V>.Load(rows, o, 6), turn),
                LaneVector<V>.Dot(LaneVector<V>.Load(rows, o, 12), turn));
            sum -= side == 0 ? speed + v : speed - v;
            for (int i = 3; i < block.Rows; i++)
            {
                Lane<V> turning = LaneVector<V>.Dot(LaneVector<V>.Load(rows, o + 6 * i * w), turn);
                (Lane<V>.Load(solution, row + i * w) - turning).Store(solution, row + i * w);
            }
        }

        sum.Store(solution, row);
    }

    /// <summary>The impulse of one row that a joint wrote, on the only lane.</summary>
    public static void ApplyRow(LaneRecords<V> batch, int block, in ConstraintRow row, double impulse)
    {
        int[] bodies = batch.Shape.Blocks[block].Bodies;
        ApplySide(batch, bodies[0], row.Linear0, row.Angular0, impulse);
        ApplySide(batch, bodies[1], row.Linear1, row.Angular1, -impulse);
    }

    /// <summary>Speed of such a row by the momenta and the built inverse inertias.</summary>
    /// <param name="batch">The rows and bodies.</param>
    /// <param name="block">The row's.</param>
    /// <param name="row">J.</param>
    /// <param name="areFixedMoving">Whether kinematic bodies count with their velocities.</param>
    public static double Speed(LaneRecords<V> batch, int block, in ConstraintRow row, bool areFixedMoving = true)
    {
        int[] bodies = batch.Shape.Blocks[block].Bodies;
        bool is0 = areFixedMoving || bodies[0] < batch.Shape.MovingBodies, is1 = areFixedMoving || bodies[1] < batch.Shape.MovingBodies;
        return row.Velocity(
            is0 ? Vector(batch, bodies[0], BodyLanes.V) : Vector3d.Zero, is0 ? AngularVelocity(batch, bodies[0]) : Vector3d.Zero,
            is1 ? Vector(batch, bodies[1], BodyLanes.V) : Vector3d.Zero, is1 ? AngularVelocity(batch, bodies[1]) : Vector3d.Zero);
    }

    /// <summary>
    /// Speed of such a row in the last drift. J turns with the bodies: the mean of the start's and the end's gives the mean
    /// speed to second order.
    /// </summary>
    public static double DriftSpeed(LaneRecords<V> batch, int block, in ConstraintRow start, in ConstraintRow end)
    {
        int[] bodies = batch.Shape.Blocks[block].Bodies;
        Vector3d v0 = Vector(batch, bodies[0], BodyLanes.V), w0 = Vector(batch, bodies[0], BodyLanes.W);
        Vector3d v1 = Vector(batch, bodies[1], BodyLanes.V), w1 = Vector(batch, bodies[1], BodyLanes.W);
        return (start.Velocity(v0, w0, v1, w1) + end.Velocity(v0, w0, v1, w1)) / 2;
    }

    /// <summary>J M^-1 J^T of such a row.</summary>
    public static double ResponseOf(LaneRecords<V> batch, int block, in ConstraintRow row)
    {
        int[] bodies = batch.Shape.Blocks[block].Bodies;
        return ResponseOf(batch, bodies[0], row.Linear0, row.Angular0) + ResponseOf(batch, bodies[1], row.Linear1, row.Angular1);
    }

    private static double ResponseOf(LaneRecords<V> batch, int body, Vector3d linear, Vector3d angular) =>
        body >= batch.Shape.MovingBodies
            ? 0
            : batch.Bodies[LaneRecords<V>.Body(body, BodyLanes.InverseMass)] * linear.LengthSquared + Vector3d.Dot(angular, Turn(batch, body, angular));

    private static void ApplySide(LaneRecords<V> batch, int body, Vector3d linear, Vector3d angular, double impulse)
    {
        if (body >= batch.Shape.MovingBodies)
        {
            return;
        }

        double[] a = batch.Bodies;
        double inverseMass = a[LaneRecords<V>.Body(body, BodyLanes.InverseMass)];
        int v = LaneRecords<V>.Body(body, BodyLanes.V);
        int l = LaneRecords<V>.Body(body, BodyLanes.L);
        LaneTransfer<V>.Write(a, v, LaneTransfer<V>.ReadVector(a, v) + inverseMass * impulse * linear);
        LaneTransfer<V>.Write(a, l, LaneTransfer<V>.ReadVector(a, l) + impulse * angular);
    }

    /// <summary>Angular velocity by the momentum and the built inverse inertia, on the only lane.</summary>
    public static Vector3d AngularVelocity(LaneRecords<V> batch, int body) =>
        body < batch.Shape.MovingBodies ? Turn(batch, body, Vector(batch, body, BodyLanes.L)) : Vector(batch, body, BodyLanes.W);

    private static Vector3d Turn(LaneRecords<V> batch, int body, Vector3d v)
    {
        double[] a = batch.Bodies;
        int o = LaneRecords<V>.Body(body, BodyLanes.WorldInverse);
        return new Vector3d(
            a[o] * v.X + a[o + 3] * v.Y + a[o + 4] * v.Z,
            a[o + 3] * v.X + a[o + 1] * v.Y + a[o + 5] * v.Z,
            a[o + 4] * v.X + a[o + 5] * v.Y + a[o + 2] * v.Z);
    }

    private static Vector3d Vector(LaneRecords<V> batch, int body, int slot) => LaneTransfer<V>.ReadVector(batch.Bodies, LaneRecords<V>.Body(body, slot));
}
