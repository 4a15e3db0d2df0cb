using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Which closed form gives a joint's locked angular rows.</summary>
internal enum AngularForm : byte
{
    None,

    /// <summary>Only the turn about X of the frames is free.</summary>
    HingeX,

    /// <summary>Only the turn about Y of the frames is free.</summary>
    HingeY,

    /// <summary>Only the turn about Z of the frames is free.</summary>
    HingeZ,

    /// <summary>No turn is free.</summary>
    All,

    /// <summary>One locked angle: the row is the one that <see cref="JointModel.Prepare"/> writes.</summary>
    Prepared,
}

/// <summary>What is watched in lanes: limits, which have no row there but for a hinge that rests on one.</summary>
internal enum WatchForm : byte
{
    None,

    /// <summary>The turn of a hinge about X, which a drive asks for.</summary>
    Turn,

    /// <summary>The same with its two ends.</summary>
    Twist,

    /// <summary>Whatever <see cref="JointModel.PrepareForces"/> writes.</summary>
    Prepared,
}

/// <summary>What is known of a row's linear part before any pose is.</summary>
internal enum RowClass : byte
{
    /// <summary>Along the world's X, Y or Z, positive on the block's first body and negative on its second.</summary>
    UnitX,
    UnitY,
    UnitZ,

    /// <summary>None.</summary>
    Angular,

    /// <summary>Anything.</summary>
    General,
}

/// <summary>
/// The rows of one joint or coupling as one block of the matrix: rigid rows first, then one row for each scalar row (limit, drive,
/// motor, spring) that the joint may ever apply, at work or not, so that the pattern never changes.
/// </summary>
internal sealed class RowBlock
{
    /// <summary>Joint in the mechanism, or null for a coupling.</summary>
    public readonly JointModel? Joint;
    public readonly CoordinateCoupling? Coupling;

    /// <summary>Of the joint's layout when the block was made.</summary>
    public readonly int Signature;

    /// <summary>Index in the mechanism's joints or couplings.</summary>
    public readonly int Index;

    /// <summary>Bodies in the island, no two the same: actor 0 and 1 of a joint, of a coupling those of all its joints.</summary>
    public readonly int[] Bodies;

    /// <summary>Locked linear axes of frame 0 as a bit mask; 7 is written in the world's axes instead.</summary>
    public readonly int LinearMask;
    public readonly AngularForm Angular;
    public readonly int BilateralCount;

    /// <summary>Whether it is a hinge, a slide or the like, in which a force on the freedom meets the same inertia in every pose.</summary>
    public bool HasOneFreedom => BilateralCount == 5;

    /// <summary>Angular rows in closed form, each of two axes that stay at right angles.</summary>
    public readonly int LockedRotations;

    /// <summary>What of frame 0 and 1 the rigid rows need in the world's axes: bit 0 the lever, bits 1 to 3 the axes.</summary>
    public readonly int WorldLeverMask0;
    public readonly int WorldLeverMask1;

    /// <summary>Slots for drive rows, in Prepare's order, then for limits: cone, angles, distance.</summary>
    public readonly int Drives;
    public readonly bool HasCone;
    public readonly int AngleLimits;
    public readonly bool HasDistance;
    public readonly RowClass[] Classes;

    /// <summary>Whether some rows' linear parts are not known before the pose is: <see cref="RowClass.General"/>.</summary>
    public readonly bool HasGeneralRows;

    /// <summary>Whether it is an anchor (all linear axes locked) with angular rows in closed form and nothing else, as a hinge is.</summary>
    public readonly bool IsPointJoint;

    /// <summary>Of a block without its limits' rows: how to tell when they are reached.</summary>
    public readonly WatchForm Watch;

    /// <summary>Of a block in lanes: whether a hinge has a row about its axis, for a drive or for the end of its limits that it rests on.</summary>
    public readonly bool HasAxisRow;

    /// <summary>Whether that row is a drive's.</summary>
    public readonly bool IsAxisDriven;

    /// <summary>For a coupling, which of Bodies are actor 0 and 1 of the joint of each of its coordinates.</summary>
    public readonly int[] CouplingSides = Array.Empty<int>();

    public RowBlock(JointModel joint, int index, int[] bodies)
        : this(joint, index, bodies, false, false)
    {
    }

    private RowBlock(JointModel joint, int index, int[] bodies, bool isInLanes, bool holdsLimits)
    {
        Joint = joint;
        Index = index;
        Bodies = bodies;
        Coupled = Array.Empty<int>();
        var classes = new List<RowClass>();
        RowLayout layout = joint.Layout();
        Signature = layout.Signature;
        LinearMask = layout.Locked & 0b111;
        Angular = (layout.Locked >> 3) switch
        {
            0 => AngularForm.None,
            6 => AngularForm.HingeX,
            5 => AngularForm.HingeY,
            3 => AngularForm.HingeZ,
            7 => AngularForm.All,
            _ => AngularForm.Prepared,
        };
        bool isHinge = layout.Limits == layout.TwistLimits && Angular == AngularForm.HingeX;
        IsAxisDriven = isInLanes && layout.Drives == 1 && layout.AngularDrives == 1 && Angular == AngularForm.HingeX;
        HasAxisRow = IsAxisDriven || (isInLanes && holdsLimits && isHinge && layout.Limits > 0 && layout.Drives == 0);
        Drives = IsAxisDriven ? 0 : layout.Drives;
        HasCone = !isInLanes && layout.HasCone;
        AngleLimits = isInLanes ? 0 : layout.SwingLimits + layout.TwistLimits;
        HasDistance = !isInLanes && layout.HasDistance;
        Watch = !isInLanes ? WatchForm.None
            : layout.Limits == 0 ? (IsAxisDriven ? WatchForm.Turn : WatchForm.None)
            : isHinge ? WatchForm.Twist : WatchForm.Prepared;

        for (int axis = 0; axis < 3; axis++)
        {
            if ((LinearMask & (1 << axis)) != 0)
            {
                classes.Add(LinearMask == 7 ? (RowClass)axis : RowClass.General);
            }
        }

        int turns = Angular switch { AngularForm.None => 0, AngularForm.All => 3, AngularForm.Prepared => 1, _ => 2 };
        for (int i = 0; i < turns; i++)
        {
            classes.Add(RowClass.Angular);
        }

        BilateralCount = classes.Count;
        LockedRotations = Angular == AngularForm.Prepared ? 0 : turns;
        WorldLeverMask0 = 1 | (LinearMask == 7 ? 0 : LinearMask << 1);
        WorldLeverMask1 = 1;
        for (int i = 0; i < LockedRotations; i++)
        {
            RotationPlane(i, out int axis0, out int axis1);
            WorldLeverMask0 |= 2 << axis0;
            WorldLeverMask1 |= 2 << axis1;
        }

        if (HasAxisRow)
        {
            classes.Add(RowClass.Angular);
        }

        for (int i = 0; i < ScalarCount; i++)
        {
            bool isLinear = i < layout.LinearDrives || (HasDistance && i == ScalarCount - 1);
            classes.Add(isLinear ? RowClass.General : RowClass.Angular);
        }

        Classes = classes.ToArray();
        HasGeneralRows = classes.Contains(RowClass.General);
        IsPointJoint = LinearMask == 7 && !HasGeneralRows && Angular != AngularForm.Prepared;
    }

    /// <summary>Of a coupling that has its row in lanes, the blocks of its hinges; else empty.</summary>
    public readonly int[] Coupled;

    public RowBlock(CoordinateCoupling coupling, int index, int[] bodies, int[] sides)
        : this(coupling, index, bodies, sides, Array.Empty<int>())
    {
    }

    private RowBlock(CoordinateCoupling coupling, int index, int[] bodies, int[] sides, int[] coupled)
    {
        Coupled = coupled;
        Coupling = coupling;
        Index = index;
        Bodies = bodies;
        CouplingSides = sides;
        BilateralCount = 1;
        Classes = new[] { RowClass.General };
        HasGeneralRows = true;
    }

    /// <summary>
    /// Which axes of frame 0 and frame 1 an angular row keeps at right angles: the free axis of 1 with the other two of 0, and
    /// for a joint without a free turn also y0 with z1.
    /// </summary>
    public void RotationPlane(int row, out int axis0, out int axis1)
    {
        int free = Angular == AngularForm.HingeY ? 1 : Angular == AngularForm.HingeZ ? 2 : 0;
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

    /// <summary>Whether a row locks an angle.</summary>
    public bool IsLockedAngle(int row) => row < BilateralCount && Classes[row] == RowClass.Angular;

    /// <summary>Scalar rows: those with bounds.</summary>
    public int ScalarCount => Drives + Limits;

    /// <summary>Of these, the ones of limits.</summary>
    public int Limits => (HasCone ? 1 : 0) + AngleLimits + (HasDistance ? 1 : 0);

    public int Rows => Classes.Length;

    /// <summary>Whether some rows come from the joint's or coupling's own Prepare, one mechanism at a time.</summary>
    public bool IsAssembled => (Coupling != null && Coupled.Length == 0) || ScalarCount > 0 || Angular == AngularForm.Prepared;

    /// <summary>The block as it stands in lanes: without the rows of its limits, a hinge with one about its axis; a coupling of hinges with the blocks of these.</summary>
    /// <param name="blocks">Of its island.</param>
    /// <param name="holdsLimits">Whether a hinge with limits has a row for the end that it rests on.</param>
    public RowBlock InLanes(RowBlock[] blocks, bool holdsLimits)
    {
        if (Coupling is null)
        {
            return ScalarCount == 0 ? this : new RowBlock(Joint!, Index, Bodies, true, holdsLimits);
        }

        int[] coupled = Array.ConvertAll(
            Coupling.Coordinates, c => c.Axis == CoordinateAxis.AngularX ? Array.FindIndex(blocks, block => block.Joint == c.Joint && block.Angular == AngularForm.HingeX) : -1);
        return Array.IndexOf(coupled, -1) >= 0 ? this : new RowBlock(Coupling, Index, Bodies, CouplingSides, coupled);
    }

    /// <summary>Whether the other block has the same rows between the same bodies.</summary>
    public bool HasShapeOf(RowBlock other)
    {
        bool hasSameRows = LinearMask == other.LinearMask && Angular == other.Angular && HasDistance == other.HasDistance;
        bool hasSameAxisRow = Watch == other.Watch && HasAxisRow == other.HasAxisRow && IsAxisDriven == other.IsAxisDriven;
        bool hasSameScalars = Drives == other.Drives && HasCone == other.HasCone && AngleLimits == other.AngleLimits;
        bool hasSameCoupling = (Coupling is null) == (other.Coupling is null) && HasSame(CouplingSides, other.CouplingSides) && HasSame(Coupled, other.Coupled);
        if (Bodies.Length != other.Bodies.Length || !hasSameRows || !hasSameAxisRow || !hasSameScalars || !hasSameCoupling)
        {
            return false;
        }

        for (int i = 0; i < Classes.Length; i++)
        {
            if (Classes[i] != other.Classes[i])
            {
                return false;
            }
        }

        return HasSame(Bodies, other.Bodies);
    }

    /// <summary>Whether the other one is the same joint or coupling, between the same bodies, with the same rows.</summary>
    public bool IsSameAs(RowBlock other) => Joint == other.Joint && Coupling == other.Coupling && Signature == other.Signature && HasSame(Bodies, other.Bodies);

    private static bool HasSame(int[] a, int[] b) => a.AsSpan().SequenceEqual(b);
}
