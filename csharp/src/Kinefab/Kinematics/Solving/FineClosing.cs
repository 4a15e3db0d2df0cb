using System;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Brings states of one linkage that are near by onto its joints, to rounding even where velocities are obstructed. What the fourth power of
/// the way x obstructs has a singular value of x cubed, and the damping of NewtonSolver's normal equations hides all below 3e-5; here steps
/// are taken by singular values, where the freedoms are few enough for that.
/// </summary>
internal sealed class FineClosing
{
    /// <summary>An error, or a singular value that does not count, beyond this is noise of the file, in the mechanism's lengths or radians.</summary>
    public const double LargestRounding = 1e-9;

    // Up to so many freedoms singular values are taken, or of so many bodies: as many as in Python.
    private const int Few = 20;
    private const int FewBodies = 12;

    // Singular values below this share of the largest, or of a row's unit where that is larger, take no part in a step: where a joint holds
    // nothing of what the others leave, all of its rows are a rounding.
    private const double Cut = 1e-10;

    // Rows that repeat others, but not quite, hold nothing up to this many times what they are off by, and no step is asked to come nearer
    // than so far off along the shortest way; an obstructed velocity's row has grown to more than the least singular value there.
    private const double NoiseBeside = 10;
    private const double ShortestWay = 0.01;
    private const double LeastObstructing = 1e-4;

    // Share of the square of the least singular value that a state may miss its rows by to have one of the mechanism's near it: Newton's method
    // converges from half of it, over the rows' curvature (Kantorovich 1948).
    private const double SureShare = 0.01;

    // Error that is rounding. Times what a state is closed to up to which another came back onto the joints beyond doubt, and beyond which
    // it got stuck: what is closed to a rounding of the file here may be closed to many there.
    private const double Rounding = 1e-14;
    private const double Beside = 10;
    private const double Stuck = 1e4;
    private const double LargestStep = 0.3;

    // Times what closes links in line that closing may turn by.
    private const double Far = 4;

    // Of rows: most that an error is beside its linearisation, over the square of the step; lengths and angles of 1 make 1 or 2.
    private const double Curvature = 4;
    private const int MaxIterations = 60;

    // A step that makes the error this many times as large is taken back and halved, down to the least share of it.
    private const double Worse = 2;
    private const double LeastShare = 1e-3;

    // An error that shrinks by less than this so many times has met its floor; steps that were cut get more of them.
    private const double Stalled = 0.9;
    private const int MostStalled = 3;
    private const int MostStalledCut = 11;

    private readonly NewtonSolver _newton;
    private readonly Pose[] _before;
    private readonly Pose[] _best;
    private readonly double[] _toBest;
    private double _goal = Rounding;
    private double _cut;

    /// <summary>Of a solver's linkage, closing a state of it first: what that cannot be closed to, no other is asked for.</summary>
    public FineClosing(Linkage linkage, NewtonSolver newton, MechanismState state)
    {
        _newton = newton;
        _before = new Pose[linkage.BodyCount];
        _best = new Pose[linkage.BodyCount];
        _toBest = new double[newton.Motion.Linear.Length];
        Closing = new double[newton.Motion.Linear.Length];
        IsFew = Closing.Length <= Few || linkage.Tree.Order.Length <= FewBodies;
        CloseFirst(linkage, state);
        _goal = Math.Max(Rounding, 2 * Worst);
        newton.Accepted = Math.Max(newton.Accepted, 4 * Worst);
    }

    /// <summary>
    /// Asks for no more from now on than rows that should repeat each other do: axes that a CAD program left 1e-7 rad off would lock at other
    /// poses what moves there.
    /// </summary>
    /// <param name="noise">The largest singular value of the rows that do not count.</param>
    public void Follow(double noise)
    {
        _cut = Math.Min(NoiseBeside * noise, LeastObstructing);
        _goal += ShortestWay * _cut;
        _newton.Accepted = Math.Max(_newton.Accepted, _goal);
    }

    /// <summary>Sum of the steps of the last Close.</summary>
    public double[] Closing { get; }

    /// <summary>Worst error that the last Close left, in the mechanism's lengths or radians.</summary>
    public double Worst { get; private set; }

    /// <summary>Whether the last Close came back onto the joints beyond doubt.</summary>
    public bool IsExact => IsFew ? Worst <= Beside * _goal : Worst <= _newton.Accepted;

    /// <summary>Whether the last Close may have led to a pose of the mechanism.</summary>
    public bool IsClosed => Worst <= (IsFew ? Stuck * _goal : _newton.Accepted);

    /// <summary>Whether the freedoms are few enough for singular values.</summary>
    public bool IsFew { get; }

    /// <summary>
    /// Whether no row repeats others at a state, beyond doubt, so that each velocity there is a motion. Beside a singular pose rows are
    /// independent by little, less than the gap in which a rank is put asks for; of a pose that is left where a velocity is obstructed both the
    /// error and the square of the least singular value are the closing's.
    /// </summary>
    /// <param name="state">Closed as well as it can be.</param>
    /// <param name="rows">Its rows.</param>
    public bool HoldsByAllRows(MechanismState state, PackedRows rows)
    {
        int freedoms = Closing.Length;
        if (!IsFew || rows.Count == 0 || rows.Count >= freedoms)
        {
            return false;
        }

        double least = new SingularValues(rows.Matrix(freedoms)).Values[rows.Count - 1];
        return Math.Max(_goal, _newton.ErrorOf(state)) <= SureShare * least * least;
    }

    /// <summary>Brings a state onto the joints as near as it goes; whether that may be a pose of them.</summary>
    public bool Close(MechanismState state)
    {
        _newton.ClearDriven();
        if (IsFew)
        {
            Iterate(state);
        }
        else
        {
            _newton.Close(state);
            _newton.Closing.CopyTo(Closing, 0);
            Worst = _newton.Equations.Worst;
        }

        return IsClosed;
    }

    // Links in line that miss their joints by a gap close it turned by about its root. What went much further ran after rows that are off by as
    // much and nearly repeat each other, to another pose than the file's.
    private void CloseFirst(Linkage linkage, MechanismState state)
    {
        _newton.ClearDriven();
        double gap = _newton.ErrorOf(state);
        MechanismState closed = state.Clone();
        Close(closed);
        double turned = MechanismScale.Turned(gap, MechanismScale.LinkShare(linkage, state.Poses));
        if (gap <= LargestRounding || DenseVector.Largest(Closing) <= Far * turned)
        {
            state.CopyFrom(closed);
            return;
        }

        Array.Clear(Closing, 0, Closing.Length);
        Worst = gap;
    }

    private void Iterate(MechanismState state)
    {
        Array.Clear(Closing, 0, Closing.Length);
        _newton.Motion.Start(state.Poses);
        PackedRows rows = _newton.Rows(state);
        Worst = _newton.Equations.Worst;
        double share = 1;
        double least = Worst;
        Array.Copy(state.Poses, _best, _best.Length);
        Array.Clear(_toBest, 0, _toBest.Length);
        int stalled = 0;
        for (int n = 0; n < MaxIterations && Worst > _goal && stalled < (share < 1 ? MostStalledCut : MostStalled); n++)
        {
            _newton.Cancellation.ThrowIfCancellationRequested();
            double[] step = Step(rows, share);
            Array.Copy(state.Poses, _before, _before.Length);
            _newton.Motion.Move(state.Poses, step);
            PackedRows there = _newton.Rows(state);
            double now = _newton.Equations.Worst;
            if (now > Worse * Worst && share > LeastShare)
            {
                // What a step along the weak rows bends, the strong ones make up for, as far as they can.
                double[] straight = Step(there, 1, Curvature * DenseVector.Dot(step, step));
                _newton.Motion.Move(state.Poses, straight);
                (there, now) = (_newton.Rows(state), _newton.Equations.Worst);
                DenseVector.Add(step, 1, straight);
            }

            if (now > Worse * Worst && share > LeastShare)
            {
                Array.Copy(_before, state.Poses, _before.Length);
                _newton.Motion.Start(state.Poses);
                share /= 2;
                stalled++;
                continue;
            }

            share = Math.Min(1, 2 * share);
            stalled = now > Stalled * Worst ? stalled + 1 : 0;
            DenseVector.Add(Closing, 1, step);
            (rows, Worst) = (there, now);
            if (Worst <= least)
            {
                least = Worst;
                Array.Copy(state.Poses, _best, _best.Length);
                Array.Copy(Closing, _toBest, _toBest.Length);
            }
        }

        // Joints that no pose closes push it ever further off.
        if (!(Worst <= least))
        {
            Array.Copy(_best, state.Poses, _best.Length);
            Array.Copy(_toBest, Closing, _toBest.Length);
            Worst = least;
        }

        _newton.ReadValues(state);
    }

    // A share of the least step after which the rows miss 0 by no more than its own curvature may make of it, no longer than the largest; it
    // ends before the weak rows that would make it longer than it may be.
    // The weakest rows ask for the longest steps, and nothing of them is known before the others are closed: where o o = 0 and o s = 0, a
    // step that obeyed both would halve the motion s each time that it halves o.
    private double[] Step(PackedRows rows, double share, double longest = double.PositiveInfinity)
    {
        double[,] matrix = rows.Matrix(Closing.Length);
        var errors = new double[rows.Count];
        for (int r = 0; r < errors.Length; r++)
        {
            // A steep coupling's row would hide what the others tell beside it.
            double size = Math.Max(1, DenseVector.Length(rows.Row(r)));
            errors[r] = rows.Errors[r] / size;
            for (int i = 0; i < Closing.Length; i++)
            {
                matrix[r, i] /= size;
            }
        }

        var values = new SingularValues((double[,])matrix.Clone());
        double[] along = Along(values, matrix, errors, _cut);
        var step = new double[Closing.Length];
        double left = DenseVector.Dot(along, along);
        double squares = 0;
        for (int k = 0; k < along.Length && left > Curvature * squares * (Curvature * squares); k++)
        {
            double size = along[k] / values.Values[k];
            squares += size * size;
            if (squares > longest * longest)
            {
                break;
            }

            left -= along[k] * along[k];
            for (int i = 0; i < step.Length; i++)
            {
                step[i] -= share * size * values.Vector(i, k);
            }
        }

        double largest = DenseVector.Largest(step);
        if (largest > LargestStep)
        {
            DenseVector.Divide(step, largest / LargestStep);
        }

        return step;
    }

    // The errors along the left singular vectors that count.
    private static double[] Along(SingularValues values, double[,] matrix, double[] errors, double cut)
    {
        int columns = values.Values.Length;
        var along = new double[columns == 0 ? 0 : values.Rank(Math.Max(cut, Cut * Math.Max(1, values.Values[0])))];
        for (int k = 0; k < along.Length; k++)
        {
            for (int r = 0; r < errors.Length; r++)
            {
                double rate = 0;
                for (int i = 0; i < columns; i++)
                {
                    rate += matrix[r, i] * values.Vector(i, k);
                }

                along[k] += rate * errors[r];
            }

            along[k] /= values.Values[k];
        }

        return along;
    }
}
