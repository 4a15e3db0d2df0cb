using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>From impulses to momenta, from momenta to the rows' speeds, by the rows last built.</summary>
internal static class Impulses<V>
    where V : struct, ILane<V>
{
    /// <summary>v += M^-1 J^T l, L += J^T l, times a factor, in the active lanes.</summary>
    public static void Apply(Batch<V> batch, double[] impulses, double factor)
    {
        double[] a = batch.Bodies;
        double[] rows = batch.Rows;
        int w = Lane<V>.Width;
        Lane<V> active = Lane<V>.Load(batch.Active, 0);
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> times = Lane<V>.Splat(factor);
        Node[] nodes = batch.Shape.Nodes;
        for (int n = 0; n < nodes.Length; n++)
        {
            Node node = nodes[n];
            int row = batch.Shape.Pattern.Rows[n] * w;
            int stride = node.Bodies.Length * Batch<V>.SideCount * w;
            for (int side = 0; side < node.Bodies.Length; side++)
            {
                int body = node.Bodies[side];
                if (body >= batch.Shape.MovingBodies)
                {
                    continue;
                }

                var force = new LaneVector<V>(zero, zero, zero);
                var torque = new LaneVector<V>(zero, zero, zero);
                int o = batch.Row(n, 0, side, 0);
                int i = 0;
                if (node.LinearMask == 7)
                {
                    var l = LaneVector<V>.Load(impulses, row);
                    force = side == 0 ? l : force - l;
                    torque = l.X * LaneVector<V>.Load(rows, o + Batch<V>.Angular * w)
                        + l.Y * LaneVector<V>.Load(rows, o + stride + Batch<V>.Angular * w)
                        + l.Z * LaneVector<V>.Load(rows, o + 2 * stride + Batch<V>.Angular * w);
                    i = 3;
                }

                for (; i < node.Rows; i++)
                {
                    Lane<V> l = Lane<V>.Load(impulses, row + i * w);
                    int oi = o + i * stride;
                    torque += l * LaneVector<V>.Load(rows, oi + Batch<V>.Angular * w);
                    if (node.Classes[i] == RowClass.General)
                    {
                        force += l * LaneVector<V>.Load(rows, oi + Batch<V>.Linear * w);
                    }
                }

                int at = Batch<V>.Body(body, 0);
                Lane<V> mass = times * Lane<V>.Load(a, at + BodySlot.InverseMass * w);
                LaneVector<V> v = LaneVector<V>.Load(a, at + BodySlot.V * w);
                LaneVector<V> momentum = LaneVector<V>.Load(a, at + BodySlot.L * w);
                LaneVector<V>.Select(active, v + mass * force, v).Store(a, at + BodySlot.V * w);
                LaneVector<V>.Select(active, momentum + times * torque, momentum).Store(a, at + BodySlot.L * w);
            }
        }
    }

    /// <summary>Solution = -J v of all rows at the built pose.</summary>
    public static void NegativeSpeeds(Batch<V> batch)
    {
        double[] a = batch.Bodies;
        double[] rows = batch.Rows;
        int w = Lane<V>.Width;
        Lane<V> zero = Lane<V>.Splat(0);
        Node[] nodes = batch.Shape.Nodes;
        for (int n = 0; n < nodes.Length; n++)
        {
            Node node = nodes[n];
            int row = batch.Shape.Pattern.Rows[n] * w;
            int stride = node.Bodies.Length * Batch<V>.SideCount * w;
            for (int i = 0; i < node.Rows; i++)
            {
                zero.Store(batch.Solution, row + i * w);
            }

            for (int side = 0; side < node.Bodies.Length; side++)
            {
                int body = node.Bodies[side];
                if (batch.Shape.IsStatic[body])
                {
                    continue;
                }

                // The turning part is J_w I^-1 L for a moving body, its response being J_w I^-1; J_w w for a kinematic one.
                bool isMoving = body < batch.Shape.MovingBodies;
                int at = Batch<V>.Body(body, 0);
                LaneVector<V> v = LaneVector<V>.Load(a, at + BodySlot.V * w);
                LaneVector<V> turn = LaneVector<V>.Load(a, at + (isMoving ? BodySlot.L : BodySlot.W) * w);
                int slot = (isMoving ? Batch<V>.Response : Batch<V>.Angular) * w;
                int o = batch.Row(n, 0, side, 0);
                for (int i = 0; i < node.Rows; i++, o += stride)
                {
                    Lane<V> speed = LaneVector<V>.Dot(LaneVector<V>.Load(rows, o + slot), turn);
                    switch (node.Classes[i])
                    {
                        case RowClass.Angular:
                            break;
                        case RowClass.General:
                            speed += LaneVector<V>.Dot(LaneVector<V>.Load(rows, o + Batch<V>.Linear * w), v);
                            break;
                        default:
                            Lane<V> component = node.Classes[i] == RowClass.UnitX ? v.X : node.Classes[i] == RowClass.UnitY ? v.Y : v.Z;
                            speed = side == 0 ? speed + component : speed - component;
                            break;
                    }

                    Lane<V> sum = Lane<V>.Load(batch.Solution, row + i * w);
                    (sum - speed).Store(batch.Solution, row + i * w);
                }
            }
        }
    }
}
