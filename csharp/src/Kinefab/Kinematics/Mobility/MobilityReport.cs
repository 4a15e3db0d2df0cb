using System.Collections.Generic;
using System.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Kinematics;

/// <summary>What one body can still do at the exported pose.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class BodyMobility
{
    internal BodyMobility(int gameObject, int translations, int rotations, bool isInDoubt)
    {
        IsInDoubt = isInDoubt;
        GameObject = gameObject;
        Translations = translations;
        Rotations = rotations;
    }

    /// <summary>Index of the GameObject.</summary>
    public int GameObject { get; }

    /// <summary>Independent velocities without rotation, 0 to 3.</summary>
    public int Translations { get; }

    /// <summary>Independent angular velocities, 0 to 3.</summary>
    public int Rotations { get; }

    /// <summary>Whether it can do more, or less, as far as the file tells: some of its velocities are as small as what its joints are off by.</summary>
    internal bool IsInDoubt { get; }

    /// <summary>object 3: 0 translations, 1 rotation.</summary>
    public override string ToString() => $"object {GameObject}: {Invariant.Counted(Translations, "translation")}, {Invariant.Counted(Rotations, "rotation")}";
}

/// <summary>Bodies that hang together by joints or couplings, the ground left out.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class IslandMobility
{
    internal IslandMobility(IReadOnlyList<int> gameObjects, int mobility, int firstOrder, int redundant, int loops)
    {
        GameObjects = gameObjects;
        Mobility = mobility;
        FirstOrder = firstOrder;
        Redundant = redundant;
        Loops = loops;
    }

    /// <summary>Indices of the GameObjects, rising.</summary>
    public IReadOnlyList<int> GameObjects { get; }

    /// <summary>Freedoms of finite motion.</summary>
    public int Mobility { get; }

    /// <summary>Freedoms of the velocities at the exported pose.</summary>
    public int FirstOrder { get; }

    /// <summary>Rows that remove nothing at the exported pose.</summary>
    public int Redundant { get; }

    /// <summary>Joints beyond a spanning tree.</summary>
    public int Loops { get; }

    /// <summary>objects 1, 2, 3: mobility 1, 3 redundant rows, 1 loop.</summary>
    public override string ToString() => $"objects {string.Join(", ", GameObjects)}: mobility {Mobility}, {Invariant.Counted(Redundant, "redundant row")}, {Invariant.Counted(Loops, "loop")}";
}

/// <summary>Redundant rows of one joint, the rows of a loop being counted from its tree to its closing joints.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class RedundantRows
{
    internal RedundantRows(int gameObject, int component, int rows, int redundant)
    {
        GameObject = gameObject;
        Component = component;
        Rows = rows;
        Redundant = redundant;
    }

    /// <summary>Index of the GameObject that carries the joint.</summary>
    public int GameObject { get; }

    /// <summary>Index of the joint in its components.</summary>
    public int Component { get; }

    /// <summary>Freedoms that the joint removes between its bodies.</summary>
    public int Rows { get; }

    /// <summary>How many of its rows the others already hold.</summary>
    public int Redundant { get; }

    /// <summary>components[1] of object 3: 3 of 5 rows redundant.</summary>
    public override string ToString() => $"components[{Component}] of object {GameObject}: {Redundant} of {Rows} rows redundant";
}

/// <summary>Freedoms of some bodies that move nothing else, such as a rod's spin between its two balls.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class IdleFreedom
{
    internal IdleFreedom(IReadOnlyList<int> gameObjects, int count)
    {
        GameObjects = gameObjects;
        Count = count;
    }

    /// <summary>Indices of the GameObjects, rising.</summary>
    public IReadOnlyList<int> GameObjects { get; }

    /// <summary>How many.</summary>
    public int Count { get; }

    /// <summary>objects 4: 1 idle freedom.</summary>
    public override string ToString() => $"objects {string.Join(", ", GameObjects)}: {Invariant.Counted(Count, "idle freedom")}";
}

/// <summary>Mobility of a mechanism, counted from its joints.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class MobilityReport
{
    internal MobilityReport(
        int mobility, int firstOrder, int atGeneralPose, int rows, int redundant, double gap, int inDoubt, bool isNoisy, IReadOnlyList<IslandMobility> islands, IReadOnlyList<BodyMobility> bodies, IReadOnlyList<RedundantRows> joints,
        IReadOnlyList<IdleFreedom> idle)
    {
        Mobility = mobility;
        FirstOrder = firstOrder;
        AtGeneralPose = atGeneralPose;
        Rows = rows;
        Redundant = redundant;
        Gap = gap;
        InDoubt = inDoubt;
        IsNoisy = isNoisy;
        Islands = islands;
        Bodies = bodies;
        Joints = joints;
        Idle = idle;
    }

    /// <summary>Freedoms of finite motion.</summary>
    public int Mobility { get; }

    /// <summary>Freedoms of the velocities at the exported pose; more than <see cref="Mobility"/> where the pose is singular.</summary>
    public int FirstOrder { get; }

    /// <summary>
    /// Freedoms of the velocities at a pose in general position, some steps away. More than <see cref="Mobility"/> where the
    /// mechanism is singular at every pose: then Newton's method, and with it a drive, has nothing to hold on to.
    /// </summary>
    public int AtGeneralPose { get; }

    /// <summary>Rows of all joints and couplings.</summary>
    public int Rows { get; }

    /// <summary>Rows that remove nothing at the exported pose.</summary>
    public int Redundant { get; }

    /// <summary>Ratio of the least singular value that counts to the greatest that does not, over all loops; below 100 the counts are unsure.</summary>
    public double Gap { get; }

    /// <summary>How many more freedoms, or fewer, rows would leave that hold a velocity by little, were they counted otherwise.</summary>
    internal int InDoubt { get; }

    /// <summary>Whether the file is open by more than a rounding, or rows that should repeat each other are off by more.</summary>
    internal bool IsNoisy { get; }

    /// <summary>By their first GameObject.</summary>
    public IReadOnlyList<IslandMobility> Islands { get; }

    /// <summary>Every body that can move, by GameObject.</summary>
    public IReadOnlyList<BodyMobility> Bodies { get; }

    /// <summary>The joints with redundant rows, by GameObject and component.</summary>
    public IReadOnlyList<RedundantRows> Joints { get; }

    /// <summary>Freedoms of a loop's body, or of several that move as one between two joints, that move no other body.</summary>
    public IReadOnlyList<IdleFreedom> Idle { get; }

    /// <summary>mobility 1 (2 at first order), 10 rows, 3 redundant, 0 idle freedoms, 1 island.</summary>
    public override string ToString()
    {
        int idle = 0;
        foreach (IdleFreedom freedom in Idle)
            idle += freedom.Count;
        string firstOrder = FirstOrder == Mobility ? "" : $" ({FirstOrder} at first order)";
        return $"mobility {Mobility}{firstOrder}, {Invariant.Counted(Rows, "row")}, {Redundant} redundant, {Invariant.Counted(idle, "idle freedom")}, {Invariant.Counted(Islands.Count, "island")}";
    }
}
