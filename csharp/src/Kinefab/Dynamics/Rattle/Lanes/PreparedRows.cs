using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Rows that a joint's or coupling's own Prepare writes: single locked angles, couplings, and all that obey a law. They
/// are not written in lanes: islands with such rows are solved one at a time.
/// </summary>
internal static class PreparedRows<V>
    where V : struct, ILane<V>
{
    /// <summary>C of these rows at the end of the flight.</summary>
    public static void Evaluate(Batch<V> batch, int n)
    {
        Node node = batch.Shape.Nodes[n];
        int row = batch.Shape.Pattern.Rows[n];
        if (node.Coupling != null)
        {
            batch.Work.Error[row] = Couple(batch, node, out _, out _);
            return;
        }

        if (!node.HasMovingRows)
        {
            return;
        }

        ConstraintRow[] rows = batch.Work.Rows;
        int count = Prepare(batch, node, rows);
        var slots = new LawSlots(node);
        batch.Laws?.ClearEnds(n);
        for (int i = 0; i < count; i++)
        {
            int slot = slots.Next(rows[i]);
            if (slot >= 0)
            {
                batch.Laws!.SetEnd(n, slot, rows[i]);
            }
            else if (IsLoneAngle(node, rows[i]))
            {
                batch.Work.Error[row + node.RigidRows - 1] = rows[i].GeometricError;
            }
        }
    }

    /// <summary>J of these rows where they were last evaluated, and the laws' constants.</summary>
    public static void Build(Batch<V> batch, int n)
    {
        Node node = batch.Shape.Nodes[n];
        if (node.Coupling != null)
        {
            BuildCoupling(batch, n, node);
        }
        else if (node.HasMovingRows && node.Angular != AngularRows.Prepared)
        {
            batch.Laws!.TakeEnds(n);
        }
        else if (node.HasMovingRows || !batch.Laws!.HasMotorAlone(n))
        {
            Read(batch, n);
        }
    }

    /// <summary>The same with the joint's fields as they are now.</summary>
    public static void Read(Batch<V> batch, int n)
    {
        Node node = batch.Shape.Nodes[n];
        ConstraintRow[] rows = batch.Work.Rows;
        int count = Prepare(batch, node, rows);
        var slots = new LawSlots(node);
        batch.Laws?.Clear(n);
        for (int i = 0; i < count; i++)
        {
            int slot = slots.Next(rows[i]);
            if (slot >= 0)
            {
                batch.Laws!.Set(n, slot, rows[i]);
            }
            else if (IsLoneAngle(node, rows[i]))
            {
                Write(batch, n, node.RigidRows - 1, rows[i], 1);
            }
        }
    }

    /// <summary>Writes a row's J times a factor.</summary>
    public static void Write(Batch<V> batch, int n, int row, in ConstraintRow from, double factor)
    {
        Put(batch, batch.Row(n, row, 0), from.Linear0, from.Angular0, factor);
        Put(batch, batch.Row(n, row, 1), from.Linear1, from.Angular1, -factor);
    }

    /// <summary>A coupling's coordinates are unwrapped against those of the last finished step.</summary>
    public static void FinishCoupling(Batch<V> batch, Node node)
    {
        Couple(batch, node, out ConstraintRow a, out ConstraintRow b);
        node.Coupling!.LastA = a.GeometricError;
        node.Coupling.LastB = b.GeometricError;
    }

    private static int Prepare(Batch<V> batch, Node node, ConstraintRow[] rows)
    {
        Pose pose0 = PoseOf(batch, node.Bodies[0]);
        Pose pose1 = PoseOf(batch, node.Bodies[1]);
        return node.Angular == AngularRows.Prepared
            ? node.Joint!.Prepare(pose0, pose1, rows)
            : node.Joint!.PrepareForces(pose0, pose1, rows);
    }

    private static bool IsLoneAngle(Node node, in ConstraintRow row) =>
        node.Angular == AngularRows.Prepared && row.Hint == SolveHint.Equality && row.Has(RowFlags.Angular);

    private static double Couple(Batch<V> batch, Node node, out ConstraintRow rowA, out ConstraintRow rowB)
    {
        int[] sides = node.CouplingSides;
        return node.Coupling!.Prepare(
            PoseOf(batch, node.Bodies[sides[0]]),
            PoseOf(batch, node.Bodies[sides[1]]),
            PoseOf(batch, node.Bodies[sides[2]]),
            PoseOf(batch, node.Bodies[sides[3]]),
            out rowA,
            out rowB);
    }

    // J = row of B - ratio times row of A, added up on the bodies that both joints touch.
    private static void BuildCoupling(Batch<V> batch, int n, Node node)
    {
        Couple(batch, node, out ConstraintRow a, out ConstraintRow b);
        int first = batch.Row(n, 0, 0);
        Array.Clear(batch.Linear, first, 3 * node.Bodies.Length);
        Array.Clear(batch.Angular, first, 3 * node.Bodies.Length);
        double ratio = node.Coupling!.Ratio;
        Add(batch, n, node.CouplingSides[0], a.Linear0, a.Angular0, -ratio);
        Add(batch, n, node.CouplingSides[1], a.Linear1, a.Angular1, ratio);
        Add(batch, n, node.CouplingSides[2], b.Linear0, b.Angular0, 1);
        Add(batch, n, node.CouplingSides[3], b.Linear1, b.Angular1, -1);
    }

    private static void Add(Batch<V> batch, int n, int side, Vector3d linear, Vector3d angular, double factor)
    {
        int o = batch.Row(n, 0, side);
        for (int i = 0; i < 3; i++)
        {
            batch.Linear[o + i] += linear[i] * factor;
            batch.Angular[o + i] += angular[i] * factor;
        }
    }

    private static void Put(Batch<V> batch, int o, Vector3d linear, Vector3d angular, double factor)
    {
        Transfer<V>.Put(batch.Linear, o, linear * factor);
        Transfer<V>.Put(batch.Angular, o, angular * factor);
    }

    private static Pose PoseOf(Batch<V> batch, int body)
    {
        double[] a = batch.Bodies;
        int x = Batch<V>.Body(body, BodySlot.EndX);
        int q = Batch<V>.Body(body, BodySlot.EndQ);
        return new Pose(new Vector3d(a[x], a[x + 1], a[x + 2]), new Quaterniond(a[q], a[q + 1], a[q + 2], a[q + 3]));
    }
}

/// <summary>
/// Which law a row of Prepare belongs to, in its order of emission: drives; then cone, angles, distance, of which the cone
/// and the distance have no row where their direction is undefined.
/// </summary>
internal ref struct LawSlots
{
    private readonly Node _node;
    private int _drives;
    private int _angles;

    public LawSlots(Node node)
    {
        _node = node;
        _drives = 0;
        _angles = 0;
    }

    /// <summary>The law of the next row, or -1 for a rigid row.</summary>
    public int Next(in ConstraintRow row)
    {
        if (row.Has(RowFlags.Drive))
        {
            return _drives < _node.Drives ? _drives++ : -1;
        }

        if (!row.Has(RowFlags.Limit))
        {
            return -1;
        }

        int first = _node.Drives + (_node.HasCone ? 1 : 0);
        if (!row.Has(RowFlags.Angular))
        {
            return first + _node.AngleLimits;
        }

        if (row.Has(RowFlags.Cone))
        {
            return _node.HasCone ? _node.Drives : -1;
        }

        return _angles < _node.AngleLimits ? first + _angles++ : -1;
    }
}
