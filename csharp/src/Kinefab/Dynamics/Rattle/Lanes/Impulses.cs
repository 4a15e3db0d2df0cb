using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>From impulses to momenta, from momenta to the rows' speeds, by the rows last built.</summary>
internal static class Impulses<V>
    where V : struct, ILane<V>
{
    /// <summary>v += M^-1 J^T l, L += J^T l in the active lanes.</summary>
    public static void Apply(Batch<V> batch, double[] impulses)
    {
        int w = Lane<V>.Width;
        if (w == 1 && batch.Work.Active[0] == 0)
        {
            return;
        }

        Node[] nodes = batch.Shape.Nodes;
        for (int n = 0; n < nodes.Length; n++)
        {
            Node node = nodes[n];
            int row = batch.Shape.Pattern.Rows[n] * w;
            if (node.IsAnchor)
            {
                ApplyAnchor(batch, n, node, impulses, row);
                continue;
            }

            for (int side = 0; side < node.Bodies.Length; side++)
            {
                if (node.Bodies[side] < batch.Shape.MovingBodies)
                {
                    ApplySide(batch, n, node, side, impulses, row);
                }
            }
        }
    }

    // The force l and the torque r x l, both reversed on side 1, and the torques along the turns.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void ApplyAnchor(Batch<V> batch, int n, Node node, double[] impulses, int row)
    {
        double[] rows = batch.Angular;
        int w = Lane<V>.Width;
        int o = batch.Row(n, 0, 0);
        LaneVector<V> force = LaneVector<V>.Load(impulses, row);
        LaneVector<V> torque0 = LaneVector<V>.Cross(RigidRows<V>.BuiltLever(rows, o), force);
        LaneVector<V> torque1 = LaneVector<V>.Cross(RigidRows<V>.BuiltLever(rows, o + 3 * w), force);
        for (int i = 3; i < node.Rows; i++)
        {
            LaneVector<V> turn = Lane<V>.Load(impulses, row + i * w) * LaneVector<V>.Load(rows, o + 6 * i * w);
            torque0 += turn;
            torque1 -= turn;
        }

        Lane<V> active = Lane<V>.Load(batch.Work.Active, 0);
        if (node.Bodies[0] < batch.Shape.MovingBodies)
        {
            Add(batch, node.Bodies[0], active, force, torque0);
        }

        if (node.Bodies[1] < batch.Shape.MovingBodies)
        {
            Add(batch, node.Bodies[1], active, -force, torque1);
        }
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void Add(Batch<V> batch, int body, Lane<V> active, LaneVector<V> force, LaneVector<V> torque)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        int at = Batch<V>.Body(body, 0);
        LaneVector<V> v = LaneVector<V>.Load(a, at + BodySlot.V * w);
        LaneVector<V> momentum = LaneVector<V>.Load(a, at + BodySlot.L * w);
        LaneVector<V> faster = v + Lane<V>.Load(a, at + BodySlot.InverseMass * w) * force;
        LaneVector<V> turned = momentum + torque;

        // The only lane is active, or nothing is applied at all.
        (w == 1 ? faster : LaneVector<V>.Select(active, faster, v)).Store(a, at + BodySlot.V * w);
        (w == 1 ? turned : LaneVector<V>.Select(active, turned, momentum)).Store(a, at + BodySlot.L * w);
    }

    // The same of any rows.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void ApplySide(Batch<V> batch, int n, Node node, int side, double[] impulses, int row)
    {
        double[] rows = batch.Angular;
        int w = Lane<V>.Width;
        Lane<V> zero = Lane<V>.Splat(0);
        var force = new LaneVector<V>(zero, zero, zero);
        LaneVector<V> torque = force;
        int o = batch.Row(n, 0, side);
        int stride = 3 * node.Bodies.Length * w;
        int i = 0;
        if (node.LinearMask == 7)
        {
            LaneVector<V> l = LaneVector<V>.Load(impulses, row);
            torque = LaneVector<V>.Cross(RigidRows<V>.BuiltLever(rows, o), l);
            force = side == 0 ? l : force - l;
            i = 3;
            o += 3 * stride;
        }

        for (; i < node.Rows; i++, o += stride)
        {
            Lane<V> l = Lane<V>.Load(impulses, row + i * w);
            torque += l * LaneVector<V>.Load(rows, o);
            if (node.Classes[i] == RowClass.General)
            {
                force += l * LaneVector<V>.Load(batch.Linear, o);
            }
        }

        Add(batch, node.Bodies[side], Lane<V>.Load(batch.Work.Active, 0), force, torque);
    }

    /// <summary>Solution = -J v of all rows at the built pose.</summary>
    /// <param name="batch">The rows and bodies.</param>
    /// <param name="areFixedMoving">Whether kinematic bodies count with their velocities.</param>
    public static void NegativeSpeeds(Batch<V> batch, bool areFixedMoving = true)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        Lane<V> zero = Lane<V>.Splat(0);
        Node[] nodes = batch.Shape.Nodes;
        for (int n = 0; n < nodes.Length; n++)
        {
            Node node = nodes[n];
            int row = batch.Shape.Pattern.Rows[n] * w;
            int stride = 3 * node.Bodies.Length * w;
            if (node.IsAnchor)
            {
                NegativeAnchorSpeeds(batch, n, node, row, areFixedMoving);
                continue;
            }

            for (int i = 0; i < node.Rows; i++)
            {
                zero.Store(batch.Work.Solution, row + i * w);
            }

            for (int side = 0; side < node.Bodies.Length; side++)
            {
                int body = node.Bodies[side];
                if (batch.Shape.IsStatic[body] || (!areFixedMoving && body >= batch.Shape.MovingBodies))
                {
                    continue;
                }

                // The turning part is J_w I^-1 L for a moving body, its response being J_w I^-1; J_w w for a kinematic one.
                bool isMoving = body < batch.Shape.MovingBodies;
                int at = Batch<V>.Body(body, 0);
                LaneVector<V> v = LaneVector<V>.Load(a, at + BodySlot.V * w);
                LaneVector<V> turn = LaneVector<V>.Load(a, at + (isMoving ? BodySlot.L : BodySlot.W) * w);
                double[] rows = isMoving ? batch.Work.Response : batch.Angular;
                int o = batch.Row(n, 0, side);
                for (int i = 0; i < node.Rows; i++, o += stride)
                {
                    Lane<V> speed = LaneVector<V>.Dot(LaneVector<V>.Load(rows, o), turn);
                    switch (node.Classes[i])
                    {
                        case RowClass.Angular:
                            break;
                        case RowClass.General:
                            speed += LaneVector<V>.Dot(LaneVector<V>.Load(batch.Linear, o), v);
                            break;
                        default:
                            Lane<V> component = node.Classes[i] == RowClass.UnitX ? v.X : node.Classes[i] == RowClass.UnitY ? v.Y : v.Z;
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
    private static void NegativeAnchorSpeeds(Batch<V> batch, int n, Node node, int row, bool areFixedMoving)
    {
        int w = Lane<V>.Width;
        double[] solution = batch.Work.Solution;
        Lane<V> zero = Lane<V>.Splat(0);
        var sum = new LaneVector<V>(zero, zero, zero);
        for (int i = 3; i < node.Rows; i++)
        {
            zero.Store(solution, row + i * w);
        }

        for (int side = 0; side < 2; side++)
        {
            int body = node.Bodies[side];
            bool isMoving = body < batch.Shape.MovingBodies;
            if (!isMoving && (!areFixedMoving || batch.Shape.IsStatic[body]))
            {
                continue;
            }

            int at = Batch<V>.Body(body, 0);
            LaneVector<V> v = LaneVector<V>.Load(batch.Bodies, at + BodySlot.V * w);
            LaneVector<V> turn = LaneVector<V>.Load(batch.Bodies, at + (isMoving ? BodySlot.L : BodySlot.W) * w);
            double[] rows = isMoving ? batch.Work.Response : batch.Angular;
            int o = batch.Row(n, 0, side);
            var speed = new LaneVector<V>(
                LaneVector<V>.Dot(LaneVector<V>.Load(rows, o), turn),
                LaneVector<V>.Dot(LaneVector<V>.Load(rows, o + 6 * w), turn),
                LaneVector<V>.Dot(LaneVector<V>.Load(rows, o + 12 * w), turn));
            sum -= side == 0 ? speed + v : speed - v;
            for (int i = 3; i < node.Rows; i++)
            {
                Lane<V> turning = LaneVector<V>.Dot(LaneVector<V>.Load(rows, o + 6 * i * w), turn);
                (Lane<V>.Load(solution, row + i * w) - turning).Store(solution, row + i * w);
            }
        }

        sum.Store(solution, row);
    }

    /// <summary>The impulse of one row that a joint wrote, on the only lane.</summary>
    public static void ApplyRow(Batch<V> batch, int node, in ConstraintRow row, double impulse)
    {
        int[] bodies = batch.Shape.Nodes[node].Bodies;
        ApplySide(batch, bodies[0], row.Linear0, row.Angular0, impulse);
        ApplySide(batch, bodies[1], row.Linear1, row.Angular1, -impulse);
    }

    /// <summary>The linear impulse that a node's rows give one of its bodies, on the only lane.</summary>
    public static Vector3d Force(Batch<V> batch, int n, int side, double[] impulses)
    {
        Node node = batch.Shape.Nodes[n];
        int row = batch.Shape.Pattern.Rows[n];
        Vector3d force = Vector3d.Zero;
        int i = 0;
        if (node.LinearMask == 7)
        {
            force = new Vector3d(impulses[row], impulses[row + 1], impulses[row + 2]) * (side == 0 ? 1 : -1);
            i = 3;
        }

        for (; i < node.Rows; i++)
        {
            if (node.Classes[i] == RowClass.General)
            {
                int o = batch.Row(n, i, side);
                force += new Vector3d(batch.Linear[o], batch.Linear[o + 1], batch.Linear[o + 2]) * impulses[row + i];
            }
        }

        return force;
    }

    /// <summary>Speed of such a row by the momenta and the built inverse inertias.</summary>
    public static double Speed(Batch<V> batch, int node, in ConstraintRow row)
    {
        int[] bodies = batch.Shape.Nodes[node].Bodies;
        return row.Velocity(
            Vector(batch, bodies[0], BodySlot.V), AngularVelocity(batch, bodies[0]), Vector(batch, bodies[1], BodySlot.V), AngularVelocity(batch, bodies[1]));
    }

    /// <summary>
    /// Speed of such a row in the last flight. J turns with the bodies: the mean of the start's and the end's gives the mean
    /// speed to second order.
    /// </summary>
    public static double FlightSpeed(Batch<V> batch, int node, in ConstraintRow start, in ConstraintRow end)
    {
        int[] bodies = batch.Shape.Nodes[node].Bodies;
        Vector3d v0 = Vector(batch, bodies[0], BodySlot.V), w0 = Vector(batch, bodies[0], BodySlot.W);
        Vector3d v1 = Vector(batch, bodies[1], BodySlot.V), w1 = Vector(batch, bodies[1], BodySlot.W);
        return (start.Velocity(v0, w0, v1, w1) + end.Velocity(v0, w0, v1, w1)) / 2;
    }

    /// <summary>J M^-1 J^T of such a row.</summary>
    public static double ResponseOf(Batch<V> batch, int node, in ConstraintRow row)
    {
        int[] bodies = batch.Shape.Nodes[node].Bodies;
        return ResponseOf(batch, bodies[0], row.Linear0, row.Angular0) + ResponseOf(batch, bodies[1], row.Linear1, row.Angular1);
    }

    private static double ResponseOf(Batch<V> batch, int body, Vector3d linear, Vector3d angular) =>
        body >= batch.Shape.MovingBodies
            ? 0
            : batch.Bodies[Batch<V>.Body(body, BodySlot.InverseMass)] * linear.LengthSquared + Vector3d.Dot(angular, Turn(batch, body, angular));

    private static void ApplySide(Batch<V> batch, int body, Vector3d linear, Vector3d angular, double impulse)
    {
        if (body >= batch.Shape.MovingBodies)
        {
            return;
        }

        double[] a = batch.Bodies;
        double inverseMass = a[Batch<V>.Body(body, BodySlot.InverseMass)];
        int v = Batch<V>.Body(body, BodySlot.V);
        int l = Batch<V>.Body(body, BodySlot.L);
        Transfer<V>.Put(a, v, Transfer<V>.Vector(a, v) + inverseMass * impulse * linear);
        Transfer<V>.Put(a, l, Transfer<V>.Vector(a, l) + impulse * angular);
    }

    /// <summary>Angular velocity by the momentum and the built inverse inertia, on the only lane.</summary>
    public static Vector3d AngularVelocity(Batch<V> batch, int body) =>
        body < batch.Shape.MovingBodies ? Turn(batch, body, Vector(batch, body, BodySlot.L)) : Vector(batch, body, BodySlot.W);

    private static Vector3d Turn(Batch<V> batch, int body, Vector3d v)
    {
        double[] a = batch.Bodies;
        int o = Batch<V>.Body(body, BodySlot.WorldInverse);
        return new Vector3d(
            a[o] * v.X + a[o + 3] * v.Y + a[o + 4] * v.Z,
            a[o + 3] * v.X + a[o + 1] * v.Y + a[o + 5] * v.Z,
            a[o + 4] * v.X + a[o + 5] * v.Y + a[o + 2] * v.Z);
    }

    private static Vector3d Vector(Batch<V> batch, int body, int slot) => Transfer<V>.Vector(batch.Bodies, Batch<V>.Body(body, slot));
}
