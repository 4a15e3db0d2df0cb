using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Rows that a joint's or coupling's own Prepare writes: single locked angles, couplings of other joints than hinges, and all scalar rows. They
/// are not written in lanes: a step with such rows is made of one island at a time.
/// </summary>
internal static class AssembledRows<V>
    where V : struct, ILane<V>
{
    /// <summary>C of these rows at the end of the drift.</summary>
    public static void Evaluate(LaneRecords<V> batch, int n)
    {
        RowBlock block = batch.Shape.Blocks[n];
        int row = batch.Shape.Pattern.Rows[n];
        if (block.Coupling != null)
        {
            batch.Work.Error[row] = Couple(batch, n, block);
            return;
        }

        ConstraintRow[] rows = batch.Work.Rows;
        int count = Prepare(batch, n, block, rows);
        var slots = new RowSlots(block);
        batch.Scalars?.ClearEndRows(n);
        for (int i = 0; i < count; i++)
        {
            int slot = slots.Next(rows[i]);
            if (slot >= 0)
            {
                batch.Scalars!.SetEndRow(n, slot, rows[i]);
            }
            else if (IsLoneAngle(block, rows[i]))
            {
                batch.Work.Error[row + block.BilateralCount - 1] = rows[i].GeometricError;
            }
        }
    }

    /// <summary>J of these rows where they were last evaluated, and the scalar rows' constants.</summary>
    public static void Build(LaneRecords<V> batch, int n)
    {
        RowBlock block = batch.Shape.Blocks[n];
        if (block.Coupling != null)
        {
            BuildCoupling(batch, n, block);
        }
        else if (block.Angular != AngularForm.Prepared)
        {
            batch.Scalars!.AdoptEndRows(n);
        }
        else
        {
            Read(batch, n);
        }
    }

    /// <summary>The same with the joint's fields as they are now.</summary>
    public static void Read(LaneRecords<V> batch, int n)
    {
        RowBlock block = batch.Shape.Blocks[n];
        ConstraintRow[] rows = batch.Work.Rows;
        int count = Prepare(batch, n, block, rows);
        var slots = new RowSlots(block);
        batch.Scalars?.Clear(n);
        for (int i = 0; i < count; i++)
        {
            int slot = slots.Next(rows[i]);
            if (slot >= 0)
            {
                batch.Scalars!.Set(n, slot, rows[i]);
            }
            else if (IsLoneAngle(block, rows[i]))
            {
                Write(batch, n, block.BilateralCount - 1, rows[i]);
            }
        }
    }

    /// <summary>Writes a row's J.</summary>
    public static void Write(LaneRecords<V> batch, int n, int row, in ConstraintRow from)
    {
        Put(batch, batch.Row(n, row, 0), from.Linear0, from.Angular0, 1);
        Put(batch, batch.Row(n, row, 1), from.Linear1, from.Angular1, -1);
    }

    /// <summary>Notes the angles that were reached: those of limits, springs and couplings are counted on from the last finished part of a step.</summary>
    public static void FinishAngles(LaneRecords<V> batch)
    {
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            CoordinateCoupling? coupling = batch.Couplings[n];
            if (coupling != null)
            {
                Couple(batch, n, block);
                for (int i = 0; i < coupling.Last.Length; i++)
                {
                    coupling.Last[i] = coupling.Rows[i].GeometricError;
                    if (coupling.Coordinates[i].Axis == CoordinateAxis.AngularX)
                    {
                        coupling.Coordinates[i].Joint.FinishTwist(PoseOf(batch, block.Bodies[block.CouplingSides[2 * i]]), PoseOf(batch, block.Bodies[block.CouplingSides[(2 * i) + 1]]));
                    }
                }
            }
            else if (block.ScalarCount > 0)
            {
                batch.Models[n]!.FinishTwist(PoseOf(batch, block.Bodies[0]), PoseOf(batch, block.Bodies[1]));
            }
        }
    }

    private static int Prepare(LaneRecords<V> batch, int n, RowBlock block, ConstraintRow[] rows)
    {
        Pose pose0 = PoseOf(batch, block.Bodies[0]);
        Pose pose1 = PoseOf(batch, block.Bodies[1]);
        return block.Angular == AngularForm.Prepared
            ? batch.Models[n]!.Prepare(pose0, pose1, rows)
            : batch.Models[n]!.PrepareForces(pose0, pose1, rows);
    }

    private static bool IsLoneAngle(RowBlock block, in ConstraintRow row) =>
        block.Angular == AngularForm.Prepared && row.Hint == SolveHint.Equality && row.Has(RowFlags.Angular);

    private static double Couple(LaneRecords<V> batch, int n, RowBlock block, bool isBuilt = false)
    {
        int[] sides = block.CouplingSides;
        CoordinateCoupling coupling = batch.Couplings[n]!;
        double sum = 0;
        for (int i = 0; i < coupling.Coordinates.Length; i++)
        {
            sum += coupling.Evaluate(i, PoseOf(batch, block.Bodies[sides[2 * i]]), PoseOf(batch, block.Bodies[sides[2 * i + 1]]));
        }

        sum -= coupling.Offset;
        if (coupling.AnglesAmongOthers.Length == 0)
        {
            return sum;
        }

        double least = double.PositiveInfinity;
        for (int i = 0; isBuilt && i < coupling.AnglesAmongOthers.Length; i++)
        {
            int candidate = coupling.AnglesAmongOthers[i];
            double square = CoordinateCoupling.AngleAmongOthers.SquareOf(FramesOf(batch, block, coupling, candidate), coupling.Coordinates[candidate].Axis - CoordinateAxis.AngularX);
            if (square < least)
            {
                (least, coupling.Among) = (square, candidate);
            }
        }

        int among = coupling.Among;
        CoordinateAxisMap angle = coupling.Coordinates[among];
        JointFrames f = FramesOf(batch, block, coupling, among);
        return coupling.Angle.Evaluate(f, angle.Axis - CoordinateAxis.AngularX, angle.Sign * coupling.Rows[among].GeometricError, angle.Sign * coupling.Factors[among], sum, isBuilt);
    }

    private static JointFrames FramesOf(LaneRecords<V> batch, RowBlock block, CoordinateCoupling coupling, int coordinate)
    {
        int[] sides = block.CouplingSides;
        coupling.Coordinates[coordinate].Joint.FramesAt(PoseOf(batch, block.Bodies[sides[2 * coordinate]]), PoseOf(batch, block.Bodies[sides[(2 * coordinate) + 1]]), out JointFrames f);
        return f;
    }

    // J = sum of factor times row, added up on the bodies that several joints touch.
    private static void BuildCoupling(LaneRecords<V> batch, int n, RowBlock block)
    {
        Couple(batch, n, block, isBuilt: true);
        int first = batch.Row(n, 0, 0);
        Array.Clear(batch.Linear, first, 3 * block.Bodies.Length);
        Array.Clear(batch.Angular, first, 3 * block.Bodies.Length);
        CoordinateCoupling coupling = batch.Couplings[n]!;
        bool isWeighed = coupling.AnglesAmongOthers.Length > 0 && coupling.Angle.IsActive;
        for (int i = 0; i < coupling.Rows.Length; i++)
        {
            double factor = coupling.Factors[i] * (isWeighed ? coupling.Angle.Weight : 1);
            if (isWeighed && i == coupling.Among)
            {
                coupling.Rows[i].Angular0 = coupling.Rows[i].Angular1 = -coupling.Angle.Gradient;
                factor = 1;
            }

            Add(batch, n, block.CouplingSides[2 * i], coupling.Rows[i].Linear0, coupling.Rows[i].Angular0, factor);
            Add(batch, n, block.CouplingSides[2 * i + 1], coupling.Rows[i].Linear1, coupling.Rows[i].Angular1, -factor);
        }
    }

    private static void Add(LaneRecords<V> batch, int n, int side, Vector3d linear, Vector3d angular, double factor)
    {
        int o = batch.Row(n, 0, side);
        for (int i = 0; i < 3; i++)
        {
            batch.Linear[o + i] += linear[i] * factor;
            batch.Angular[o + i] += angular[i] * factor;
        }
    }

    private static void Put(LaneRecords<V> batch, int o, Vector3d linear, Vector3d angular, double factor)
    {
        LaneTransfer<V>.Write(batch.Linear, o, linear * factor);
        LaneTransfer<V>.Write(batch.Angular, o, angular * factor);
    }

    private static Pose PoseOf(LaneRecords<V> batch, int body) => LaneTransfer<V>.ReadPose(batch, body, 0);
}

/// <summary>
/// Which scalar row a row of Prepare belongs to, in its order of emission: drives; then cone, angles, distance, of which the cone
/// and the distance have no row where their direction is undefined.
/// </summary>
internal ref struct RowSlots
{
    private readonly RowBlock _block;
    private int _drives;
    private int _angles;

    public RowSlots(RowBlock block)
    {
        _block = block;
        _drives = 0;
        _angles = 0;
    }

    /// <summary>The scalar row of the next row, or -1 for a rigid row.</summary>
    public int Next(in ConstraintRow row)
    {
        if (row.Has(RowFlags.Drive))
        {
            return _drives < _block.Drives ? _drives++ : -1;
        }

        if (!row.Has(RowFlags.Limit))
        {
            return -1;
        }

        int first = _block.Drives + (_block.HasCone ? 1 : 0);
        if (!row.Has(RowFlags.Angular))
        {
            return first + _block.AngleLimits;
        }

        if (row.Has(RowFlags.Cone))
        {
            return _block.HasCone ? _block.Drives : -1;
        }

        return _angles < _block.AngleLimits ? first + _angles++ : -1;
    }
}
