using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Moving bodies that hang together by joints and couplings, with the fixed bodies they touch.</summary>
internal sealed class Island
{
    private readonly double[] _inverseMasses;
    private readonly Vector3d[] _inverseInertias;
    private readonly IslandMatrix _matrix;

    // Steps ask for it for every row.
    private BlockPattern? _pattern;
    private bool[]? _isAngular;

    /// <param name="bodies">Index in the mechanism (or Joint.World) of each body, the moving ones first.</param>
    /// <param name="movingBodies">How many move.</param>
    /// <param name="blocks">Joints and couplings, their bodies as in the first list.</param>
    /// <param name="all">The mechanism's bodies.</param>
    public Island(int[] bodies, int movingBodies, RowBlock[] blocks, Bodies all)
        : this(
            bodies,
            movingBodies,
            blocks,
            Array.ConvertAll(bodies.AsSpan(0, movingBodies).ToArray(), body => all.InverseMasses[body]),
            Array.ConvertAll(bodies.AsSpan(0, movingBodies).ToArray(), body => all.InverseInertias[body]),
            null)
    {
    }

    // The origin is the island that this is a form of.
    private Island(int[] bodies, int movingBodies, RowBlock[] blocks, double[] inverseMasses, Vector3d[] inverseInertias, Island? origin)
    {
        Bodies = bodies;
        MovingBodies = movingBodies;
        Blocks = blocks;
        IsStatic = new bool[bodies.Length];
        for (int b = 0; b < bodies.Length; b++)
        {
            IsStatic[b] = bodies[b] == JointModel.World;
        }

        foreach (RowBlock block in blocks)
        {
            RowCount += block.Rows;
            HasAssembledRows |= block.IsAssembled;
            ScalarCount += block.ScalarCount;
        }

        _matrix = new IslandMatrix(blocks, movingBodies, origin?._matrix);
        Hubs = _matrix.Hubs;

        HasJointLoops = Array.FindAll(blocks, block => block.Joint != null).Length >= LeastWithLoop;
        HasKinematic = Array.IndexOf(IsStatic, false, movingBodies) >= 0;
        _inverseMasses = inverseMasses;
        _inverseInertias = inverseInertias;
        RotationSplittings = new RotationSplitting[movingBodies];
        for (int b = 0; b < movingBodies; b++)
        {
            RotationSplittings[b] = new RotationSplitting(inverseInertias[b]);
        }

        LockedInertiaBodies = FindLockedInertia(inverseInertias);
        MeanRateBodies = FindMeanRate(blocks, movingBodies);
    }

    /// <summary>Index in the mechanism (or Joint.World) of each of the island's bodies, the moving ones first.</summary>
    public int[] Bodies { get; }

    public int MovingBodies { get; }

    /// <summary>Whether a body is the world; the other fixed ones are kinematic.</summary>
    public bool[] IsStatic { get; }

    /// <summary>How each moving body's rotation is split.</summary>
    public RotationSplitting[] RotationSplittings { get; }

    public RowBlock[] Blocks { get; }

    /// <summary>Rows of all blocks.</summary>
    public int RowCount { get; }

    /// <inheritdoc cref="IslandMatrix.Hubs"/>
    public int[] Hubs { get; }

    /// <inheritdoc cref="IslandMatrix.Pattern"/>
    public BlockPattern Pattern => _pattern ??= _matrix.Pattern;

    /// <summary>Whether the pattern has been found.</summary>
    public bool IsOrdered => _matrix.IsOrdered;

    /// <inheritdoc cref="IslandMatrix.BodyLinks"/>
    public IslandMatrix.BodyLink[] BodyLinks => _matrix.BodyLinks;

    /// <inheritdoc cref="IslandMatrix.HubLinks"/>
    public IslandMatrix.HubLink[] HubLinks => _matrix.HubLinks;

    /// <summary>Whether a body of theirs moves as it is told.</summary>
    public bool HasKinematic { get; }

    /// <summary>Whether nothing holds it from outside, so that its momentum is its own.</summary>
    public bool IsFloating => Bodies.Length == MovingBodies && LockedInertiaBodies.Length == 0;

    // As many as hang up the bodies, and one.
    private int LeastWithLoop => MovingBodies + (Bodies.Length > MovingBodies ? 1 : 0);

    /// <summary>Whether there are more joints and couplings than it takes to hang up the bodies, all that does not move being one.</summary>
    public bool HasLoops => Blocks.Length >= LeastWithLoop;

    /// <summary>The same of joints alone: whether axes may contradict each other round a loop.</summary>
    public bool HasJointLoops { get; }

    /// <summary>Whether rows may repeat each other or ask for a turn that a body does not make: by loops or by infinite moments.</summary>
    public bool IsRedundant => HasLoops || LockedInertiaBodies.Length > 0;

    /// <summary>Moving bodies with an infinite moment of inertia.</summary>
    public int[] LockedInertiaBodies { get; }

    /// <summary>Moving bodies of joints with scalar rows, whose mean rates in the drift the scalar rows ask for.</summary>
    public int[] MeanRateBodies { get; }

    /// <summary>How well its loops close: see <see cref="LoopConsistencyProbe"/>.</summary>
    public LoopConsistency Loops { get; set; }

    public bool IsInconsistent => Loops == LoopConsistency.Inconsistent;

    /// <summary>Whether a row, in the vectors' order, locks an angle.</summary>
    public bool[] IsAngular => _isAngular ??= FindAngular();

    /// <summary>Scalar rows of all blocks.</summary>
    public int ScalarCount { get; }

    /// <summary>Whether some rows have no closed form in lanes.</summary>
    public bool HasAssembledRows { get; }

    /// <summary>
    /// The same as it is stepped in lanes, while none of its limits is reached or while hinges rest on them. Itself, where it has no rows that are not
    /// in closed form; null, where it has others than those that have one there.
    /// </summary>
    /// <param name="holdsLimits">Whether hinges with limits have a row for the end that they rest on.</param>
    public Island? InLanes(bool holdsLimits)
    {
        if (!HasAssembledRows)
        {
            return this;
        }

        RowBlock[] plain = Array.ConvertAll(Blocks, block => block.InLanes(Blocks, holdsLimits));

        // Axis rows are in lanes where no body is a hub and no angle gives.
        bool hasAxisRowOutOfPlace = (IsInconsistent || Hubs.Length > 0) && Array.Exists(plain, block => block.HasAxisRow);
        return hasAxisRowOutOfPlace || Array.Exists(plain, block => block.IsAssembled || block.Rows == 0)
            ? null
            : new Island(Bodies, MovingBodies, plain, _inverseMasses, _inverseInertias, this) { Loops = Loops };
    }

    /// <summary>The joint of a row, in the vectors' order; of a coupling's row that of the coordinate that is driven.</summary>
    public JointModel JointOf(int row)
    {
        RowBlock block = Blocks[BlockOf(row)];
        return block.Joint ?? block.Coupling!.Coordinates[^1].Joint;
    }

    /// <summary>Whether C of a row, in the vectors' order, is in radians; that of a coupling is in the unit of the coordinate that is driven.</summary>
    public bool IsInRadians(int row)
    {
        CoordinateCoupling? coupling = Blocks[BlockOf(row)].Coupling;
        return coupling != null ? coupling.Coordinates[^1].IsAngle : IsAngular[row];
    }

    /// <summary>Whether the other island is of the same build, so that both can share lanes.</summary>
    public bool HasShapeOf(Island other)
    {
        bool isAlike = MovingBodies == other.MovingBodies && Blocks.Length == other.Blocks.Length && Loops == other.Loops
            && IsStatic.AsSpan().SequenceEqual(other.IsStatic) && LockedInertiaBodies.AsSpan().SequenceEqual(other.LockedInertiaBodies);
        for (int b = 0; b < MovingBodies && isAlike; b++)
        {
            isAlike = RotationSplittings[b].Equals(other.RotationSplittings[b]);
        }

        for (int n = 0; n < Blocks.Length && isAlike; n++)
        {
            isAlike = Blocks[n].HasShapeOf(other.Blocks[n]);
        }

        return isAlike;
    }

    /// <summary>Whether the other one holds the same bodies, of the same masses, by the same joints with the same rows: what was kept of it still holds.</summary>
    public bool IsSameAs(Island other)
    {
        bool isSame = Loops == other.Loops && Blocks.Length == other.Blocks.Length && Bodies.AsSpan().SequenceEqual(other.Bodies) && MovingBodies == other.MovingBodies
            && _inverseMasses.AsSpan().SequenceEqual(other._inverseMasses) && _inverseInertias.AsSpan().SequenceEqual(other._inverseInertias);
        for (int n = 0; n < Blocks.Length && isSame; n++)
        {
            isSame = Blocks[n].IsSameAs(other.Blocks[n]);
        }

        return isSame;
    }

    private int BlockOf(int row) => Array.FindLastIndex(Pattern.Rows, first => first <= row);

    private static int[] FindMeanRate(RowBlock[] blocks, int movingBodies)
    {
        var rated = new SortedSet<int>();
        foreach (RowBlock block in blocks)
        {
            if (block.ScalarCount > 0)
            {
                rated.UnionWith(block.Bodies);
            }
        }

        rated.RemoveWhere(body => body >= movingBodies);
        return new List<int>(rated).ToArray();
    }

    private static int[] FindLockedInertia(Vector3d[] inverseInertias)
    {
        var locked = new List<int>();
        for (int b = 0; b < inverseInertias.Length; b++)
        {
            Vector3d inverse = inverseInertias[b];
            if (inverse.X == 0 || inverse.Y == 0 || inverse.Z == 0)
            {
                locked.Add(b);
            }
        }

        return locked.ToArray();
    }

    private bool[] FindAngular()
    {
        var angular = new bool[RowCount];
        int row = 0;
        foreach (RowBlock block in Blocks)
        {
            for (int i = 0; i < block.Rows; i++)
            {
                angular[row++] = block.IsLockedAngle(i);
            }
        }

        return angular;
    }

    /// <inheritdoc cref="IslandMatrix.Order"/>
    public void Order(CancellationToken cancellation) => _matrix.Order(cancellation);

    /// <inheritdoc cref="IslandMatrix.TakePattern"/>
    public void TakePattern(Island other) => _matrix.TakePattern(other._matrix);

    /// <inheritdoc cref="IslandMatrix.IsHub"/>
    public bool IsHub(int body) => Hubs.Length > 0 && _matrix.IsHub(body);
}
