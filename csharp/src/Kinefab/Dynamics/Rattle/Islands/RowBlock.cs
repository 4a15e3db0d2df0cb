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

    /// <summary>Index in the mechanism's joints or couplings.</summary>
    public readonly int Index;

    /// <summary>Bodies in the island, no two the same: actor 0 and 1 of a joint, up to four of a coupling.</summary>
    public readonly int[] Bodies;

    /// <summary>Locked linear axes of frame 0 as a bit mask; 7 is written in the world's axes instead.</summary>
    public readonly int LinearMask;
    public readonly AngularForm Angular;
    public readonly int BilateralCount;

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

    /// <summary>For a coupling, which of Bodies are actor 0 and 1 of its first joint and of its second.</summary>
    public readonly int[] CouplingSides = System.Array.Empty<int>();

    public RowBlock(JointModel joint, int index, int[] bodies)
    {
        Joint = joint;
        Index = index;
        Bodies = bodies;
        var classes = new List<RowClass>();
        int linearDrives = 0;
        if (joint is RevoluteJoint hinge)
        {
            LinearMask = 7;
            bool isLocked = hinge.LimitEnabled && hinge.Limit.Lower >= hinge.Limit.Upper;
            Angular = isLocked ? AngularForm.All : AngularForm.HingeX;
            if (!isLocked)
            {
                Drives = hinge.MotorEnabled || hinge.Spring.IsActive ? 1 : 0;
                AngleLimits = hinge.LimitEnabled ? 2 : 0;
            }
        }
        else if (joint is D6Joint d6)
        {
            LinearMask = Locked(d6.Linear(d6.X), 1) | Locked(d6.Linear(d6.Y), 2) | Locked(d6.Linear(d6.Z), 4);
            int angular = Locked(d6.Twist, 1) | Locked(d6.Swing(d6.Swing1), 2) | Locked(d6.Swing(d6.Swing2), 4);
            Angular = angular switch
            {
                0 => AngularForm.None,
                6 => AngularForm.HingeX,
                5 => AngularForm.HingeY,
                3 => AngularForm.HingeZ,
                7 => AngularForm.All,
                _ => AngularForm.Prepared,
            };
            linearDrives = CountLinearDrives(d6);
            Drives = CountDrives(d6);
            bool swing1 = d6.Swing(d6.Swing1) == AxisMotion.Limited;
            bool swing2 = d6.Swing(d6.Swing2) == AxisMotion.Limited;
            HasCone = swing1 && swing2;
            AngleLimits = (swing1 ^ swing2 ? 2 : 0) + (d6.Twist == AxisMotion.Limited ? 2 : 0);
            HasDistance = IsLimited(d6, d6.X) || IsLimited(d6, d6.Y) || IsLimited(d6, d6.Z);
        }
        else
        {
            Drives = CountDrives(joint);
            linearDrives = Drives;
        }

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

        for (int i = 0; i < ScalarCount; i++)
        {
            bool isLinear = i < linearDrives || (HasDistance && i == ScalarCount - 1);
            classes.Add(isLinear ? RowClass.General : RowClass.Angular);
        }

        Classes = classes.ToArray();
        HasGeneralRows = classes.Contains(RowClass.General);
        IsPointJoint = LinearMask == 7 && !HasGeneralRows && Angular != AngularForm.Prepared;
    }

    public RowBlock(CoordinateCoupling coupling, int index, int[] bodies, int[] sides)
    {
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

    /// <summary>Rows that obey a scalar row.</summary>
    public int ScalarCount => Drives + Limits;

    /// <summary>Of these, the ones of limits.</summary>
    public int Limits => (HasCone ? 1 : 0) + AngleLimits + (HasDistance ? 1 : 0);

    public int Rows => Classes.Length;

    /// <summary>Whether some rows come from the joint's or coupling's own Prepare, one mechanism at a time.</summary>
    public bool IsAssembled => Coupling != null || ScalarCount > 0 || Angular == AngularForm.Prepared;

    /// <summary>Whether prepared rows are worth a second look at the end of the drift; a hinge's axis on the world stays.</summary>
    public bool HasMovingRows => Angular == AngularForm.Prepared || Limits > 0 || (Drives > 0 && !(Joint is RevoluteJoint && Joint.Body0 == JointModel.World));

    /// <summary>Whether the other block has the same rows between the same bodies.</summary>
    public bool HasShapeOf(RowBlock other)
    {
        if (Bodies.Length != other.Bodies.Length || LinearMask != other.LinearMask || Angular != other.Angular
            || IsAssembled || other.IsAssembled)
        {
            return false;
        }

        for (int i = 0; i < Bodies.Length; i++)
        {
            if (Bodies[i] != other.Bodies[i])
            {
                return false;
            }
        }

        return true;
    }

    /// <summary>Everything of a joint that decides which rows it has.</summary>
    public static int Signature(JointModel joint)
    {
        if (joint is RevoluteJoint hinge)
        {
            return (hinge.LimitEnabled ? 1 : 0) | (hinge.LimitEnabled && hinge.Limit.Lower >= hinge.Limit.Upper ? 2 : 0)
                | (hinge.MotorEnabled || hinge.Spring.IsActive ? 4 : 0);
        }

        if (joint is D6Joint d6)
        {
            return (int)d6.Linear(d6.X) | ((int)d6.Linear(d6.Y) << 2) | ((int)d6.Linear(d6.Z) << 4) | ((int)d6.Twist << 6) | ((int)d6.Swing(d6.Swing1) << 8)
                | ((int)d6.Swing(d6.Swing2) << 10) | (CountDrives(d6) << 12) | (d6.DriveSlerp.IsActive ? 1 << 16 : 0);
        }

        return 0;
    }

    private static bool IsLimited(D6Joint d6, AxisMotion motion) => d6.Linear(motion) == AxisMotion.Limited;

    private static int Locked(AxisMotion motion, int bit) => motion == AxisMotion.Locked ? bit : 0;

    // Other joints than PhysX's two may have drive rows alone.
    private static int CountDrives(JointModel joint)
    {
        System.Span<ConstraintRow> rows = stackalloc ConstraintRow[JointModel.MaxRows];
        return joint.Prepare(Pose.Identity, Pose.Identity, rows);
    }

    // The same conditions as in D6Joint.LinearDrives and AngularDrives.
    private static int CountLinearDrives(D6Joint d6) =>
        (d6.DriveX.IsActive && d6.Linear(d6.X) != AxisMotion.Locked ? 1 : 0)
        + (d6.DriveY.IsActive && d6.Linear(d6.Y) != AxisMotion.Locked ? 1 : 0)
        + (d6.DriveZ.IsActive && d6.Linear(d6.Z) != AxisMotion.Locked ? 1 : 0);

    private static int CountDrives(D6Joint d6)
    {
        int count = CountLinearDrives(d6);
        bool twist = d6.Twist != AxisMotion.Locked;
        bool swing1 = d6.Swing(d6.Swing1) != AxisMotion.Locked;
        bool swing2 = d6.Swing(d6.Swing2) != AxisMotion.Locked;
        if (d6.DriveSlerp.IsActive && twist && swing1 && swing2)
        {
            return count + 3;
        }

        count += d6.DriveTwist.IsActive && twist ? 1 : 0;
        count += d6.DriveSwing.IsActive && swing1 ? 1 : 0;
        count += d6.DriveSwing.IsActive && swing2 ? 1 : 0;
        return count;
    }
}
