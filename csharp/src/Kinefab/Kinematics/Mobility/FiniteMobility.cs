using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Freedoms of finite motion of one block, which the velocities at one pose only bound from above: those that trial steps keep, at poses some
/// steps away, where an isolated singular pose is left and branches of motions that meet in it have parted. Of many freedoms only the
/// velocities are tried that second order leaves: where it obstructs many at once, steps along mixtures lead back to where they began.
/// </summary>
internal sealed class FiniteMobility
{
    private const int WalkSteps = 3;
    private const int MaxOtherWalks = 8;
    private const double WalkLength = 0.2;

    // Steps further away while it is in doubt what moves, as where branches touch, and the mixtures of velocities that they take.
    private const int MostFurther = 5;
    private const int FurtherRounds = WalkSteps * (MaxOtherWalks + 1);

    private readonly Linkage _linkage;
    private readonly NewtonSolver _newton;
    private readonly FreedomBlocks _blocks;
    private readonly FineClosing _closing;
    private readonly CancellationToken _cancellation;
    private readonly VelocitySpace _start;
    private readonly TrialSteps _here;
    private readonly SecondOrder? _left;

    // Where nothing is left of mixtures, of the velocities in which bodies stand still: what is obstructed takes a motion beside it back along,
    // as in a linkage that cannot move but for a rod that spins.
    private readonly TrialSteps? _atRest;

    /// <summary>Of a linkage all of whose freedoms are one block's, at a closed state.</summary>
    public FiniteMobility(Linkage linkage, NewtonSolver newton, FreedomBlocks blocks, FineClosing closing, VelocitySpace here, MechanismState state, CancellationToken cancellation)
    {
        _linkage = linkage;
        _newton = newton;
        _blocks = blocks;
        _closing = closing;
        _cancellation = cancellation;
        _start = here;
        _left = Left(here, state);
        _here = Trials(here, _left, state);
        AtGeneralPose = here.Freedoms;
        for (int walk = 0; walk <= MaxOtherWalks && (walk == 0 || Freedoms < Math.Max(_here.Motions.Count, AtGeneralPose)); walk++)
        {
            AtGeneralPose = Math.Min(AtGeneralPose, Elsewhere(state.Clone(), walk, walk == 0 || Freedoms < _here.Motions.Count));
        }

        if (Freedoms == 0 && here.Freedoms > 1 && _closing.IsFew)
        {
            _atRest = new TrialSteps(newton, closing, here.AtRest(), state, cancellation);
            Freedoms = _atRest.MixturesMove() ? _atRest.Motions.Count : Math.Min(1, _atRest.Motions.Count);
        }
    }

    /// <summary>The finite freedoms: of branches of motions that meet at the state, those of the largest.</summary>
    public int Freedoms { get; private set; }

    /// <summary>Freedoms of the velocities at poses in general position, the least found.</summary>
    public int AtGeneralPose { get; private set; }

    /// <summary>The velocities at the state that lead into the finite motions.</summary>
    public IReadOnlyList<double[]> Motions
    {
        get
        {
            TrialSteps trials = _atRest ?? _here;
            return Freedoms < trials.Motions.Count ? trials.LargestBranch() : trials.Motions;
        }
    }

    // Freedoms of the velocities where a walk leads, whose motions are counted too.
    private int Elsewhere(MechanismState state, int walk, bool isCounted)
    {
        for (int i = 0; i < WalkSteps; i++)
        {
            VelocitySpace from = i == 0 ? _start : new VelocitySpace(_linkage, _newton, _blocks, state);
            SecondOrder? leftThere = !isCounted ? null : i == 0 ? _left : Left(from, state);
            Walk(state, from, leftThere, walk * WalkSteps + i);
        }

        for (int further = 0; ; further++)
        {
            var space = new VelocitySpace(_linkage, _newton, _blocks, state);
            if (!isCounted)
            {
                return space.Freedoms;
            }

            if (_closing.HoldsByAllRows(state, space.Rows))
            {
                int all = _newton.Motion.Linear.Length - space.Rows.Count;
                Freedoms = Math.Max(Freedoms, all);
                return all;
            }

            SecondOrder? left = Left(space, state);
            TrialSteps there = Trials(space, left, state);
            bool isSure = there.IsSure && there.MixturesMove();
            if (isSure || further == MostFurther)
            {
                Freedoms = Math.Max(Freedoms, there.Motions.Count);
                return space.Freedoms;
            }

            Walk(state, space, left, FurtherRounds + further);
        }
    }

    // What second order leaves, of many freedoms.
    private SecondOrder? Left(VelocitySpace space, MechanismState state) =>
        _closing.IsFew ? null : new SecondOrder(_newton, space, state, _cancellation);

    private TrialSteps Trials(VelocitySpace space, SecondOrder? left, MechanismState state) =>
        new(_newton, _closing, left is null ? space.Basis : left.Basis(), state, _cancellation);

    // A step along a mixture of all allowed velocities, the same on every machine; back along it when the joints do not close, as where the
    // motions end in a cusp, and undone when they do not close there either.
    private void Walk(MechanismState state, VelocitySpace space, SecondOrder? left, int round)
    {
        _cancellation.ThrowIfCancellationRequested();
        double[] step = left is null ? space.Mixture(round, WalkLength) : left.Mixture(round, WalkLength);
        MechanismState before = state.Clone();
        for (int way = 0; way < 2; way++)
        {
            _newton.Motion.Start(state.Poses);
            _newton.Motion.Move(state.Poses, step);
            if (_closing.Close(state))
            {
                return;
            }

            state.CopyFrom(before);
            DenseVector.Divide(step, -1);
        }
    }
}
