using System;
using System.Collections.Generic;
using System.Threading;

namespace Kinefab.Kinematics;

/// <summary>What one block of tied freedoms can do: velocities at the exported pose, finite motions, rows that hold nothing.</summary>
internal sealed class LoopMobility
{
    // Length of a row, of about 1 at the start, that has to be left beside the rows before it for it to count.
    private const double IndependentRow = 1e-6;

    private readonly NewtonSolver _newton;
    private readonly FineClosing _closing;
    private readonly FreedomBlocks _blocks;
    private readonly MechanismState _state;

    /// <summary>Of a part, by itself.</summary>
    /// <param name="part">Which.</param>
    /// <param name="closed">The mechanism's exported pose, closed as well as it can be.</param>
    /// <param name="cancellation">Ends the counting early, with an OperationCanceledException.</param>
    public LoopMobility(IndependentLinkage part, MechanismState closed, CancellationToken cancellation)
    {
        Part = part;
        var newton = new NewtonSolver(part.Linkage, cancellation);
        MechanismState state = part.StateOf(closed);
        var closing = new FineClosing(part.Linkage, newton, state);
        var blocks = new FreedomBlocks(part.Linkage, newton.Firsts, newton.Motion.Linear.Length);
        Here = new VelocitySpace(part.Linkage, newton, blocks, state);
        (_newton, _closing, _blocks, _state) = (newton, closing, blocks, state);
        Rank = newton.Motion.Linear.Length - Here.Freedoms;
        Motions = Here.Basis;
        (Finite, AtGeneralPose) = (Here.Freedoms, Here.Freedoms);
        closing.Follow(Here.Dropped);
        if (!NoisyRows.Keep(newton, Here, state))
        {
            var finite = new FiniteMobility(part.Linkage, newton, blocks, closing, Here, state, cancellation);
            (Finite, AtGeneralPose) = (finite.Freedoms, finite.AtGeneralPose);
            Motions = Finite < FirstOrder ? finite.Motions : Motions;
        }
    }

    public IndependentLinkage Part { get; }

    /// <summary>The velocities at the exported pose.</summary>
    public VelocitySpace Here { get; }

    /// <summary>Freedoms of the velocities at the exported pose.</summary>
    public int FirstOrder => Here.Freedoms;

    /// <summary>Independent rows at the exported pose.</summary>
    public int Rank { get; }

    /// <summary>Freedoms of finite motion.</summary>
    public int Finite { get; }

    /// <summary>Freedoms of the velocities at poses in general position.</summary>
    public int AtGeneralPose { get; }

    /// <summary>Whether the file is open by more than a rounding, or rows that should repeat each other are off by more.</summary>
    /// <param name="gap">What the file is open by, in the mechanism's lengths or radians.</param>
    public bool IsNoisy(double gap) => NoisyRows.IsNoise(Math.Max(gap, Here.Dropped));

    /// <summary>
    /// How many freedoms more or fewer may be meant: those that little holds, and of a file that is open by more than a rounding those at a
    /// dead centre, which rows that are off by as much obstruct, hold for good or let go. More motions than velocities there are as much in doubt
    /// as fewer.
    /// </summary>
    /// <param name="gap">What the file is open by, in the mechanism's lengths or radians.</param>
    public int InDoubt(double gap)
    {
        int more = Here.HeldBy(gap) + FirstOrder - Finite;
        return Math.Max(Here.InDoubt, IsNoisy(gap) ? Math.Max(more, Finite - FirstOrder) : 0);
    }

    /// <summary>
    /// The velocities at the exported pose that lead into the finite motions; where others do not, known to the curvature of a trial step.
    /// </summary>
    public IReadOnlyList<double[]> Motions { get; }

    /// <summary>The velocities some way beside the exported pose, radians or lengths.</summary>
    public VelocitySpace Beside(double way)
    {
        MechanismState there = _state.Clone();
        _newton.Motion.Start(there.Poses);
        _newton.Motion.Move(there.Poses, Here.Mixture(0, way));
        _closing.Close(there);
        return new VelocitySpace(Part.Linkage, _newton, _blocks, there);
    }

    /// <summary>
    /// Notes for each closing joint, by the mechanism's index, how many rows repeat others: nothing of such a row is left beside
    /// the rows before it.
    /// </summary>
    public void CountRedundant(int[] redundant)
    {
        var elimination = new RowElimination(Rank + Here.Freedoms);
        int row = 0;
        foreach (int joint in Part.Linkage.Tree.Closures)
        {
            int last = row + MotionSubspace.Rows(Part.Linkage.Joints[joint]);
            int repeated = 0;
            for (; row < last; row++)
            {
                repeated += elimination.Take(Here.Rows.Columns(row), Here.Rows.Row(row), IndependentRow) > IndependentRow ? 0 : 1;
            }

            redundant[Part.Joints[joint]] = repeated;
        }
    }
}
