using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Brings a state to poses where joints, couplings, held limits and driven coordinates all agree, by Gauss-Newton with
/// damping, changing the joints as little as it can.
/// </summary>
internal sealed class NewtonSolver
{
    // A pivot is the square of a singular value, and damping adds to it.
    private const double VanishedPivot = 100 * LeastDamping;

    // Most that a singular value changes with a step of length 1.
    private const double RankReach = 3;

    // Errors are lengths of the mechanism or radians.
    private const double Tolerance = 1e-13;
    private const double AcceptedError = 1e-10;
    private const double LeastDamping = 1e-9;
    private const double LargestStep = 0.5;

    // A step that tells nothing any more, of a closed mechanism.
    private const double Rounding = 1e-11;

    // The second step is to the first as the way's curvature is to its length, so halving the way lessens it: but not
    // where branches cross, there it stays, and what Newton's method finds is a matter of chance.
    private const double LeastFirstShrink = 0.15;
    private const double LeastShrink = 0.5;
    private const int MaxCloseIterations = 200;
    private const int MaxTrackIterations = 12;

    private readonly Linkage _linkage;
    private readonly NormalEquations _normal;
    private readonly Pose[] _before;
    private readonly double[] _step;
    private readonly int[] _driven;
    private readonly double[] _targets;
    private double _lastStep;
    private int _firstVanished;

    public NewtonSolver(Linkage linkage, CancellationToken cancellation = default)
    {
        _linkage = linkage;
        Cancellation = cancellation;
        _normal = new NormalEquations(linkage.Tree, linkage.FindRows(cancellation).All, cancellation);
        Motion = new TreeMotion(linkage, _normal.Firsts, _normal.Step.Length);
        Equations = new PositionEquations(linkage, Motion, _normal);
        Limits = new LimitSet(linkage);
        Closing = new double[_normal.Step.Length];
        _step = new double[_normal.Step.Length];
        _before = new Pose[linkage.BodyCount];
        _driven = new int[linkage.Coordinates.Length];
        _targets = new double[linkage.Coordinates.Length];
    }

    public TreeMotion Motion { get; }

    public PositionEquations Equations { get; }

    public LimitSet Limits { get; }

    /// <summary>Sum of the steps of the last Close.</summary>
    public double[] Closing { get; }

    /// <summary>Ends any call that iterates early, with an OperationCanceledException; the state then stands somewhere on the way.</summary>
    public CancellationToken Cancellation { get; set; }

    /// <summary>Iterations since it was set to 0.</summary>
    public int Iterations { get; set; }

    /// <summary>Worst error of joints and couplings at the last evaluation, metres.</summary>
    public double ErrorMetres => Equations.WorstLinear * _linkage.Length;

    /// <summary>Worst error of joints and couplings at the last evaluation, degrees.</summary>
    public double ErrorDegrees => Math.Max(Equations.WorstAngular, Motion.WorstError) * (180 / Math.PI);

    /// <summary>Error up to which a least-squares solution counts as closed: the scene's own misfit, if that is larger.</summary>
    public double Accepted { get; set; } = AcceptedError;

    /// <summary>Number of driven coordinates.</summary>
    public int DrivenCount { get; private set; }

    /// <summary>For each body the place of its first freedom in a step.</summary>
    public int[] Firsts => _normal.Firsts;

    /// <summary>Pivots of the last solved step's matrix.</summary>
    public ReadOnlySpan<double> Pivots => _normal.Pivots;

    /// <summary>Freedoms that the last solved step had no row for.</summary>
    public int Spare => _normal.Spare;

    /// <summary>
    /// Whether more freedoms may be left over where the last step of Track led than were at the first one since
    /// <see cref="BeginTracks"/>: then it may have led to a singular pose.
    /// </summary>
    public bool MayBeSingular => _normal.LeftOver(Math.Max(VanishedPivot, RankReach * RankReach * _lastStep * _lastStep)) > _firstVanished;

    /// <summary>The damped step for the rows last assembled; valid until the next assembly.</summary>
    public double[] SolveStep(double damping)
    {
        _normal.Solve(damping);
        return _normal.Step;
    }

    /// <summary>Factors the matrix of rows that were collected before.</summary>
    public void Factor(PackedRows rows, double damping) => _normal.Factor(rows, damping);

    /// <summary>The damped step for other errors of the rows last factored, before any other is assembled.</summary>
    public double[] Answer(PackedRows rows, IReadOnlyList<double> errors)
    {
        _normal.SolveFor(rows.TransposeTimes(errors, _normal.Step.Length));
        return _normal.Step;
    }

    /// <summary>The rows of a state as it stands, see <see cref="Assemble"/>.</summary>
    public PackedRows Rows(MechanismState state)
    {
        var rows = new PackedRows(Firsts);
        Equations.Sink = rows;
        Assemble(state);
        Equations.Sink = null;
        return rows;
    }

    /// <summary>The worst error of a state as it stands, in the mechanism's lengths or radians.</summary>
    public double ErrorOf(MechanismState state)
    {
        Motion.Start(state.Poses);
        Assemble(state);
        return Equations.Worst;
    }

    /// <summary>Drives nothing.</summary>
    public void ClearDriven() => DrivenCount = 0;

    /// <summary>Drives one more coordinate, radians or metres as the rows have it.</summary>
    public void Drive(int coordinate, double target)
    {
        _driven[DrivenCount] = coordinate;
        _targets[DrivenCount++] = target;
    }

    /// <summary>Forgets where the tracks so far began.</summary>
    public void BeginTracks() => _firstVanished = -1;

    /// <summary>
    /// Follows a motion: true when the state was brought to the targets by steps that shrank from the first on, as they do
    /// while the branch is not left. On false the state is somewhere between.
    /// </summary>
    /// <param name="state">Closed, or predicted; moved.</param>
    /// <param name="acceptsDoubleRoot">Whether steps that do not shrink may end at a pose that is closed to the accepted error.</param>
    public bool Track(MechanismState state, bool acceptsDoubleRoot = true)
    {
        Motion.Start(state.Poses);
        for (int i = 0; i < DrivenCount; i++)
        {
            Equations.Hold(_driven[i], _targets[i]);
        }

        bool isThere = Follow(state, acceptsDoubleRoot);
        for (int i = 0; i < DrivenCount; i++)
        {
            Equations.Hold(_driven[i], double.NaN);
        }

        return isThere;
    }

    private bool Follow(MechanismState state, bool acceptsDoubleRoot)
    {
        double previous = double.PositiveInfinity;
        _lastStep = 0;
        for (int n = 0; n < MaxTrackIterations; n++)
        {
            Cancellation.ThrowIfCancellationRequested();
            Iterations++;
            Assemble(state);
            if (Equations.Worst <= Tolerance)
            {
                return Finish(state);
            }

            _normal.Solve(LeastDamping);
            _firstVanished = _firstVanished < 0 ? _normal.LeftOver(VanishedPivot) : _firstVanished;
            double size = LargestEntry(_normal.Step);
            if (!(size <= LargestStep) || (n > 0 && size > Math.Max((n > 1 ? LeastShrink : LeastFirstShrink) * previous, 1e-9)))
            {
                // On a crossing itself the root is double and steps only halve: closed is closed there.
                return acceptsDoubleRoot && n > 0 && Equations.Worst <= Accepted && Finish(state);
            }

            if (size < Rounding && Equations.Worst <= Accepted)
            {
                return Finish(state);
            }

            previous = size;
            _lastStep = size;
            Motion.Move(state.Poses, _normal.Step);
        }

        Assemble(state);
        return Equations.Worst <= AcceptedError && Finish(state);
    }

    /// <summary>Closes from any start: damping grows until the errors shrink. On false the state holds the best poses found.</summary>
    public bool Close(MechanismState state)
    {
        Motion.Start(state.Poses);
        Assemble(state);
        double damping = LeastDamping;
        Array.Clear(Closing, 0, Closing.Length);
        for (int n = 0; n < MaxCloseIterations && Equations.Worst > Tolerance; n++)
        {
            Cancellation.ThrowIfCancellationRequested();
            Iterations++;
            double squares = Equations.Squares;
            Array.Copy(state.Poses, _before, _before.Length);
            _normal.Solve(damping);
            double size = Shorten(_normal.Step);
            if (size < 1e-14)
            {
                break;
            }

            Array.Copy(_normal.Step, _step, _step.Length);
            Motion.Move(state.Poses, _step);
            Assemble(state);
            if (Equations.Squares < squares)
            {
                for (int i = 0; i < _step.Length; i++)
                {
                    Closing[i] += _step[i];
                }

                damping = Math.Max(LeastDamping, damping * 0.1);
                continue;
            }

            Array.Copy(_before, state.Poses, _before.Length);
            Motion.Start(state.Poses);
            Assemble(state);
            damping *= 10;

            // Far from the origin the numbers themselves are coarser than the tolerance: what a small step does not lessen is rounding.
            if (damping > 1e3 || (size < Rounding && Equations.Worst <= Accepted))
            {
                break;
            }
        }

        return Finish(state) && Equations.Worst <= Accepted;
    }

    /// <summary>Rows of the state as it stands: joints, couplings, held limits, drivers.</summary>
    public void Assemble(MechanismState state)
    {
        Pose[] poses = state.Poses;
        Equations.Clear();
        Equations.AddClosures(poses, state.Values);
        for (int i = 0; i < Limits.Count; i++)
        {
            if (Limits.IsActive[i] && Limits.Row(i, poses, out Joints.ConstraintRow row))
            {
                Equations.AddLimit(Limits.JointOf(i), row, poses);
            }
        }

        for (int i = 0; i < DrivenCount; i++)
        {
            Equations.AddCoordinate(_driven[i], _targets[i], poses, state.Values);
        }
    }

    /// <summary>Brings a state's coordinates up to date with its poses.</summary>
    public void ReadValues(MechanismState state)
    {
        for (int i = 0; i < state.Values.Length; i++)
        {
            Equations.Evaluate(i, state.Poses, state.Values, out _);
        }
    }

    private bool Finish(MechanismState state)
    {
        ReadValues(state);
        return true;
    }

    private static double LargestEntry(double[] step)
    {
        double largest = 0;
        foreach (double entry in step)
        {
            // A NaN is carried on, so that the caller's test fails.
            largest = Math.Abs(entry) <= largest ? largest : Math.Abs(entry);
        }

        return largest;
    }

    private static double Shorten(double[] step)
    {
        double largest = LargestEntry(step);
        if (largest > LargestStep)
        {
            for (int i = 0; i < step.Length; i++)
            {
                step[i] *= LargestStep / largest;
            }
        }

        return largest;
    }
}
