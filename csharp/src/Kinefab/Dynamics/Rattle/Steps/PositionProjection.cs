using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Closes a pose that stands open, of a scene as it starts or written from outside, by position alone: the drift would do
/// it with speeds of gap / h, most of which stay. Gauss-Newton on C in the metric of the masses: x += M^-1 J^T l with
/// J M^-1 J^T l = -C, the whole of it shortened where a body would turn far. Hard limits that are passed take part, and those that a move would pass.
/// Locked turns count by their angle, which leads back from anywhere; the sines of <see cref="BilateralRows{V}"/> lead to the
/// wrong side beyond a right angle.
/// </summary>
internal sealed class PositionProjection
{
    /// <summary>A pose less open than this is the drift's to close, m or rad.</summary>
    public const double MostOpen = ScalarRow.MostClosedByDrift;

    private const int MaxIterations = 300;

    // Iterations without a smaller error after which there is no place where all rows hold.
    private const int MaxIdle = 30;

    // The same of a drift's end, in the metric of the masses: another comes after it.
    private const int MaxIdleOfEnd = 2;

    // An error that does not fall below this share of itself in an iteration falls slowly.
    private const double SlowShare = 0.5;

    // Such iterations in a row that the matrix's compliance may have.
    private const int MostSlow = 5;

    // Largest turn of a body in an iteration, rad.
    private const double MostTurn = 0.5;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly ConjugateGradient _conjugateGradient;
    private readonly EqualMasses _equalMasses;
    private readonly double[] _start;

    // Velocities and angular momenta, whose place the moves take.
    private readonly double[] _momenta;
    private bool _keepsAllowed;

    // Whether limits that a move would pass take part in it.
    private bool _looksAhead = true;

    public PositionProjection(LaneBatch<ScalarLane> batch, ConjugateGradient conjugateGradient)
    {
        _conjugateGradient = conjugateGradient;
        _batch = batch;
        _equalMasses = new EqualMasses(batch);
        _start = new double[7 * batch.Shape.MovingBodies];
        _momenta = new double[6 * batch.Shape.MovingBodies];
    }

    /// <summary>The row that was farthest from closed where the last <see cref="TryClose"/> began.</summary>
    public int Worst { get; private set; }

    /// <summary>By how much, m or rad.</summary>
    public double WorstError { get; private set; }

    /// <summary>The farthest that a centre of mass, and a body's rotation, was moved, m and rad.</summary>
    public double Distance { get; private set; }

    public double Angle { get; private set; }

    /// <summary>Whether the end pose stands open by more than <see cref="MostOpen"/>; the rows have to be built anew after it.</summary>
    public bool IsOpen() => !(Evaluate() <= MostOpen);

    /// <summary>
    /// Moves the bodies from their start pose to the nearest closed one, their speeds turned with them, and builds the rows
    /// there. False, with all as it was, when it is open by too little or does not close.
    /// </summary>
    /// <param name="tolerance">Largest C, m or rad.</param>
    public bool TryClose(double tolerance)
    {
        SaveStart();
        bool isOpen = IsOpen();
        bool isTorn = isOpen && AreJointsOpen();
        bool isClosed = isOpen && (Iterate(tolerance) || TryLimitByLimit(tolerance) || (isTorn && TryWithLimitsAsTheyStand(tolerance)));
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            Finish(body, isClosed);
        }

        if (isClosed)
        {
            RattleStep<ScalarLane>.Accept(_batch);
        }
        else
        {
            FreeMotion<ScalarLane>.Stay(_batch);
        }

        RattleStep<ScalarLane>.Rebuild(_batch);
        return isClosed;
    }

    /// <summary>
    /// Moves the bodies from the end of a drift to the nearest closed pose, their speeds turned with them; the rows are to be built there. False,
    /// with all as it was, when it does not close.
    /// </summary>
    /// <param name="tolerance">Largest C, m or rad.</param>
    public bool TryCloseEnd(double tolerance)
    {
        SaveStart();
        _keepsAllowed = true;

        bool isClosed = IterateAsADrift(tolerance, MaxIdleOfEnd) || TryWithEqualMasses(tolerance);
        _keepsAllowed = false;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            Finish(body, isClosed);
        }

        return isClosed;
    }

    // As far as a drift of RATTLE's: where a loop is singular, closing a gap C takes a way of the order of its root, which lifts what hangs there.
    private bool IterateAsADrift(double tolerance, int maxIdle) =>
        Iterate(tolerance, maxIdle, ChordIteration<ScalarLane>.MostGaps, ChordIteration<ScalarLane>.MostLeftOpen);

    // From where it began, in the metric of equal masses.
    private bool TryWithEqualMasses(double tolerance)
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            Array.Copy(_start, 7 * body, _batch.Bodies, o + BodyLanes.EndX, 7);
            LaneQuaternion<ScalarLane>.Load(_batch.Bodies, o, BodyLanes.EndQ).StoreMatrix(_batch.Bodies, o, BodyLanes.R);
        }

        _equalMasses.Apply();
        bool isClosed = IterateAsADrift(tolerance, MaxIdle);
        _equalMasses.TakeBack();
        return isClosed;
    }

    // After IsOpen: whether it is joints, not limits alone.
    private bool AreJointsOpen()
    {
        for (int n = 0; n < _batch.Shape.Blocks.Length; n++)
        {
            int first = _batch.Shape.Pattern.Rows[n];
            for (int row = first; row < first + _batch.Shape.Blocks[n].BilateralCount; row++)
            {
                if (!(Math.Abs(_batch.Work.Error[row]) <= MostOpen))
                {
                    return true;
                }
            }
        }

        return false;
    }

    // By the limits alone that are passed before each move, which have less to agree on.
    private bool TryLimitByLimit(double tolerance)
    {
        if (_batch.ActiveSet == null)
        {
            return false;
        }

        ReturnToStart();
        _looksAhead = false;
        bool isClosed = Iterate(tolerance);
        _looksAhead = true;
        return isClosed;
    }

    // Limits that cannot be closed with the rest stay passed as far as they are: see LimitEvent.Allowed.
    private bool TryWithLimitsAsTheyStand(double tolerance)
    {
        ReturnToStart();
        if (_batch.ActiveSet == null || !_batch.ActiveSet.AllowPassed())
        {
            return false;
        }

        _keepsAllowed = true;
        bool isClosed = Iterate(tolerance);
        _keepsAllowed = false;
        return isClosed;
    }

    private void ReturnToStart()
    {
        FreeMotion<ScalarLane>.Stay(_batch);
        RattleStep<ScalarLane>.Rebuild(_batch);
    }

    // maxIdle: iterations without a smaller error after which it is given up; gaps, angles: by how many tolerances anchors may be apart and angles may stay
    // open.
    private bool Iterate(double tolerance, int maxIdle = MaxIdle, double gaps = 1, double angles = 1)
    {
        double least = double.PositiveInfinity;
        double last = double.PositiveInfinity;
        int slow = 0;
        int idle = 0;
        for (int iteration = 0; iteration < MaxIterations && idle < maxIdle; iteration++)
        {
            double error = Evaluate();
            if (iteration == 0)
            {
                WorstError = error;
                Worst = Array.FindIndex(_batch.Work.Error, c => Math.Abs(c) == error);
            }

            if (error < angles * tolerance && LargestGap() < gaps * tolerance)
            {
                return true;
            }

            idle = error < least ? 0 : idle + 1;
            least = Math.Min(least, error);

            // What falls slowly is what the compliance hides; far from closed, rows that repeat each other differ by more than that.
            slow = error < last && (slow > MostSlow || error > SlowShare * last) ? slow + 1 : 0;
            last = error;
            if (!(error < double.MaxValue) || !Move(_keepsAllowed || slow > MostSlow))
            {
                return false;
            }
        }

        return false;
    }

    // Largest C of all rows that hold where the bodies are at the end.
    private double Evaluate()
    {
        DelassusMatrix<ScalarLane>.InverseInertias(_batch);
        BilateralRows<ScalarLane>.Evaluate(_batch);
        BilateralRows<ScalarLane>.Build(_batch);
        _batch.ActiveSet?.ActivateViolated(_keepsAllowed);
        for (int n = 0; n < _batch.Shape.Blocks.Length; n++)
        {
            MeasureRotations(n, _batch.Shape.Blocks[n]);
        }

        LeaveCompliant();

        return DenseVector.Largest(_batch.Work.Error);
    }

    // After Evaluate: the largest C of a row that is not angular alone, m.
    private double LargestGap()
    {
        double gap = 0;
        for (int row = 0; row < _batch.Work.Error.Length; row++)
        {
            gap = _batch.Shape.IsAngular[row] ? gap : Math.Max(gap, Math.Abs(_batch.Work.Error[row]));
        }

        return gap;
    }

    // C of locked turns is the turn from frame 1 to frame 0 along axes of frame 0, or the world's where all are locked; of a
    // hinge only that of its axis.
    private void MeasureRotations(int n, RowBlock block)
    {
        if (block.LockedRotations == 0)
        {
            return;
        }

        Quaterniond q0 = FrameOf(n, block, 0);
        Quaterniond q1 = FrameOf(n, block, 1);
        block.RotationPlane(0, out int axis, out int free);
        Vector3d turn = block.LockedRotations == 3 ? RotationVector(q0 * q1.Conjugate()) : RotationBetween(q1 * Unit(free), q0 * Unit(free), q0 * Unit(axis));
        int first = block.BilateralCount - block.LockedRotations;
        for (int i = 0; i < block.LockedRotations; i++)
        {
            block.RotationPlane(i, out axis, out _);
            Vector3d along = block.LockedRotations == 3 ? Unit(i) : q0 * Unit(axis);
            _batch.Work.Error[_batch.Shape.Pattern.Rows[n] + first + i] = Vector3d.Dot(along, turn);
            LaneTransfer<ScalarLane>.Write(_batch.Angular, _batch.Row(n, first + i, 0), along);
            LaneTransfer<ScalarLane>.Write(_batch.Angular, _batch.Row(n, first + i, 1), -1 * along);
        }
    }

    // Angles that are springs stand as they stand.
    private void LeaveCompliant()
    {
        for (int row = 0; row < _batch.Work.Error.Length && _batch.Shape.IsInconsistent; row++)
        {
            _batch.Work.Error[row] = _batch.Shape.IsAngular[row] ? 0 : _batch.Work.Error[row];
        }
    }

    // The least move, in the metric of the masses, that closes what is open to first order and passes no limit: a quadratic program, whose active set is found
    // as those of the steps are.
    private void FindMove(bool byTrueResponse)
    {
        double[] solution = _batch.Work.Solution;
        for (int pass = 0; ; pass++)
        {
            DelassusMatrix<ScalarLane>.Assemble(_batch, _batch.Shape.IsInconsistent ? DelassusMatrix<ScalarLane>.UnconstrainedShare : _batch.AngularShare);
            _batch.ActiveSet?.AddToDiagonal(false);
            DelassusMatrix<ScalarLane>.Factor(_batch);
            for (int i = 0; i < solution.Length; i++)
            {
                solution[i] = -_batch.Work.Error[i];
            }

            if (byTrueResponse && !_batch.Shape.IsInconsistent)
            {
                _conjugateGradient.Solve(false);
            }
            else
            {
                DelassusMatrix<ScalarLane>.Solve(_batch, solution);
            }

            for (int body = 0; body < _batch.Shape.MovingBodies; body++)
            {
                Array.Clear(_batch.Bodies, LaneBatch<ScalarLane>.Body(body, BodyLanes.V), 6);
            }

            _batch.Work.Active[0] = 1;
            Impulses<ScalarLane>.Apply(_batch, solution);
            if (_batch.ActiveSet == null || !_looksAhead || !_batch.ActiveSet.UpdateClosing(pass, solution, _keepsAllowed))
            {
                return;
            }
        }
    }

    private bool Move(bool byTrueResponse)
    {
        FindMove(byTrueResponse);
        Island shape = _batch.Shape;
        double[] a = _batch.Bodies;
        double widest = 0;
        for (int body = 0; body < shape.MovingBodies; body++)
        {
            double turn = Impulses<ScalarLane>.AngularVelocity(_batch, body).Length;
            widest = Math.Max(widest, turn);
        }

        double share = widest > MostTurn ? MostTurn / widest : 1;
        for (int body = 0; body < shape.MovingBodies && share > 0; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            Vector3d turn = Impulses<ScalarLane>.AngularVelocity(_batch, body) * share;
            double angle = turn.Length;
            Quaterniond q = LaneTransfer<ScalarLane>.ReadQuaternion(a, o + BodyLanes.EndQ);
            q = angle > 0 ? (Quaterniond.AxisAngle(turn * (1 / angle), angle) * q).Normalized() : q;
            for (int i = 0; i < 3; i++)
            {
                a[o + BodyLanes.EndX + i] += share * a[o + BodyLanes.V + i];
            }

            LaneTransfer<ScalarLane>.Write(a, o + BodyLanes.EndQ, q);
            LaneQuaternion<ScalarLane>.Load(a, o, BodyLanes.EndQ).StoreMatrix(a, o, BodyLanes.R);
        }

        return share > 0;
    }

    private void SaveStart()
    {
        Distance = 0;
        Angle = 0;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            Array.Copy(_batch.Bodies, LaneBatch<ScalarLane>.Body(body, BodyLanes.EndX), _start, 7 * body, 7);
            Array.Copy(_batch.Bodies, LaneBatch<ScalarLane>.Body(body, BodyLanes.V), _momenta, 6 * body, 6);
        }
    }

    // The momenta come back, the angular one turned as its body was, so that it keeps its energy.
    private void Finish(int body, bool isClosed)
    {
        double[] a = _batch.Bodies;
        int o = LaneBatch<ScalarLane>.Body(body, 0);
        Array.Copy(_momenta, 6 * body, a, o + BodyLanes.V, 6);
        if (isClosed)
        {
            Quaterniond turn = LaneTransfer<ScalarLane>.ReadQuaternion(a, o + BodyLanes.EndQ) * LaneTransfer<ScalarLane>.ReadQuaternion(_start, 7 * body + 3).Conjugate();
            LaneTransfer<ScalarLane>.Write(a, o + BodyLanes.L, turn * LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.L));
            Distance = Math.Max(Distance, (LaneTransfer<ScalarLane>.ReadVector(a, o + BodyLanes.EndX) - LaneTransfer<ScalarLane>.ReadVector(_start, 7 * body)).Length);
            Angle = Math.Max(Angle, RotationVector(turn).Length);
        }
    }

    private Quaterniond FrameOf(int n, RowBlock block, int side)
    {
        double[] joints = _batch.Joints;
        int o = LaneBatch<ScalarLane>.Joint(n, LaneBatch<ScalarLane>.Frame(side));
        Quaterniond frame = Quaterniond.FromAxes(LaneTransfer<ScalarLane>.ReadVector(joints, o + 3), LaneTransfer<ScalarLane>.ReadVector(joints, o + 6), LaneTransfer<ScalarLane>.ReadVector(joints, o + 9));
        return LaneTransfer<ScalarLane>.ReadQuaternion(_batch.Bodies, LaneBatch<ScalarLane>.Body(block.Bodies[side], BodyLanes.EndQ)) * frame;
    }

    private static Vector3d RotationVector(Quaterniond q)
    {
        double sine = q.Vector.Length;
        double angle = 2 * Trigonometry.Atan2(sine, Math.Abs(q.W));
        return sine > 0 ? q.Vector * ((q.W < 0 ? -angle : angle) / sine) : Vector3d.Zero;
    }

    // The turn from one direction to another, and about the third where they are opposite.
    private static Vector3d RotationBetween(Vector3d from, Vector3d to, Vector3d across)
    {
        Vector3d normal = Vector3d.Cross(from, to);
        double sine = normal.Length;
        double cosine = Vector3d.Dot(from, to);
        double angle = Trigonometry.Atan2(sine, cosine);
        return sine > 0 ? normal * (angle / sine) : cosine < 0 ? across * Math.PI : Vector3d.Zero;
    }

    private static Vector3d Unit(int axis) => axis == 0 ? Vector3d.UnitX : axis == 1 ? Vector3d.UnitY : Vector3d.UnitZ;
}
