using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>One batch of a group and the parts of its step. Lanes may leave at any of them; they take no further part until the next step.</summary>
internal sealed class LaneStep<V>
    where V : struct, ILane<V>
{
    private readonly MultibodySystem _mechanism;
    private readonly WatchedLimits<V>? _limits;
    private readonly bool[] _converged = new bool[Lane<V>.Width];
    private readonly bool[] _isAlone = new bool[Lane<V>.Width];
    private readonly bool[] _hasFailed = new bool[Lane<V>.Width];
    private readonly bool[] _hasLeftLate = new bool[Lane<V>.Width];

    private readonly bool[] _isStressed = new bool[Lane<V>.Width];
    private readonly bool[] _isTakenOver = new bool[Lane<V>.Width];

    // Lanes of which the last step has not written what their joints did, its length, and its impulses.
    private readonly bool[] _isUnread = new bool[Lane<V>.Width];
    private readonly double[] _unread;
    private double _unreadStep;

    // Lanes of which the rows are those of the pose that their last step has left.
    private readonly bool[] _isBuilt = new bool[Lane<V>.Width];

    /// <param name="mechanism">Where the islands are.</param>
    /// <param name="islands">One a lane, as they are in lanes.</param>
    /// <param name="shape">What they look like: one object for all batches, so that what it says is read from memory once.</param>
    /// <param name="workspace">Shared by all batches of the shape.</param>
    public LaneStep(MultibodySystem mechanism, Island[] islands, Island shape, Workspace<V> workspace)
    {
        _mechanism = mechanism;
        Occupied = islands.Length;
        Batch = new LaneBatch<V>(shape, workspace);
        _unread = new double[workspace.TotalImpulses.Length];
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            // Lanes without an island of their own hold a copy of the first, which is never active.
            LaneTransfer<V>.GatherConstants(Batch, lane, islands[lane < islands.Length ? lane : 0], mechanism);
        }

        _limits = WatchedLimits<V>.Of(shape);
    }

    public LaneBatch<V> Batch { get; }

    /// <summary>Lanes with an island of their own, the first ones.</summary>
    public int Occupied { get; }

    /// <summary>Whether a lane has left the step.</summary>
    public bool IsAlone(int lane) => _isAlone[lane];

    /// <summary>Whether it did so since its drift did not arrive.</summary>
    public bool HasFailed(int lane) => _hasFailed[lane];

    /// <summary>Whether it did so after the drift of all.</summary>
    public bool HasLeftLate(int lane) => _hasLeftLate[lane];

    /// <summary>Whether its step was made elsewhere.</summary>
    public bool IsTakenOver(int lane) => _isTakenOver[lane];

    /// <summary>Whether every lane with an island takes part.</summary>
    public bool AreAllActive => Array.IndexOf(_isAlone, true, 0, Occupied) < 0;

    public bool IsActive(int lane) => !_isAlone[lane];

    /// <summary>Whether a body of the lane is not where the last step left it.</summary>
    public bool IsMoved(int lane) => Batch.Work.Moved[lane] != 0;

    public void Leave(int lane) => _isAlone[lane] = true;

    /// <summary>No lane takes part in this step.</summary>
    public void LeaveAll()
    {
        Array.Fill(_isAlone, true);
        Array.Clear(_isBuilt, 0, _isBuilt.Length);
        Array.Clear(_isUnread, 0, _isUnread.Length);
    }

    /// <summary>The step's start from the world. Lanes that stand open, or move as their joints forbid, are left to the step controller.</summary>
    public void Load(double dt)
    {
        LaneTransfer<V>.Gather(Batch, _mechanism, dt);
        bool isMoved = false;
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            _isAlone[lane] = lane >= Occupied;
            _isUnread[lane] = false;
            if (lane < Occupied && IsMoved(lane))
            {
                isMoved = true;
                ClearHistory(lane);
            }
        }

        LaneTransfer<V>.BeginStep(Batch);
        MovingFrame<V>.Find(Batch, dt);
        MovingFrame<V>.Enter(Batch);
        CoupledTurns<V>.Gather(Batch);
        if (isMoved)
        {
            Rebuild();
            LeaveOpenOnes();
            LeaveForbiddenSpeeds();
        }
    }

    /// <summary>The same of some lanes, as another batch has found them.</summary>
    public void Load(LaneStep<V> from, bool[] lanes)
    {
        LaneCopy<V>.Start(from.Batch, Batch);
        CoupledTurns<V>.Gather(Batch);
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            _isAlone[lane] = !lanes[lane];
            _isUnread[lane] = false;
            Batch.Work.Moved[lane] = 0;
            LaneCopy<V>.Guess(from.Batch, lane, Batch, lane);
            MovingFrame<V>.Copy(from.Batch, lane, Batch, lane);
        }
    }

    /// <summary>Into how many parts the step of a lane would have to be cut, up to 1 into none.</summary>
    public double Demand(int lane, double dt) => StepLimit.Of(StepLimit.Stiffest(Batch, lane), Batch.Work.Fastest[lane], dt);

    /// <summary>Whether a lane stands at a limit for which there is no row here.</summary>
    public bool IsAtLimit(int lane, double tolerance) => _limits != null && _limits.IsReached(Batch, lane, tolerance);

    /// <summary>Builds what is not, and sets the rows of drives and limits; lanes that cannot do the step with these leave.</summary>
    public void Begin(double dt, double tolerance)
    {
        bool isBuilt = true;
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            _hasFailed[lane] = false;
            _hasLeftLate[lane] = false;
            _isTakenOver[lane] = false;
            isBuilt &= _isAlone[lane] || _isBuilt[lane];
        }

        if (!isBuilt)
        {
            Rebuild();
        }

        LaneEnergy<V>.Kinetic(Batch).Store(Batch.Work.StartKinetic, 0);
        Lane<V>.Splat(0).Store(Batch.Work.CompliantWork, 0);
        Batch.Axes?.Clear();
        for (int lane = 0; lane < Occupied && Batch.Axes != null; lane++)
        {
            if (_isAlone[lane] || IsMoved(lane) || !Batch.Axes.TryBegin(lane, dt, ActiveSet<V>.Reach * tolerance))
            {
                _isAlone[lane] = true;
                Batch.Axes.Leave(lane);
            }
        }
    }

    /// <summary>The drift of the lanes that take part; those that do not arrive, or pass a limit or a bound, leave.</summary>
    public void Drift(double dt, double tolerance)
    {
        if (!Activate())
        {
            return;
        }

        RattleStep<V>.KickAndDrift(Batch, dt, tolerance, _converged);
        _limits?.Measure(Batch);
        TakeOutSelfStress(dt, tolerance);
        for (int lane = 0; lane < Occupied; lane++)
        {
            if (!_isAlone[lane])
            {
                _hasFailed[lane] = !_converged[lane] || FreeMotion<V>.HasTurnedFar(Batch, lane);
                _isAlone[lane] = _hasFailed[lane] || _isStressed[lane] || (_limits != null && _limits.IsPassed(Batch, lane, tolerance)) || (Batch.Axes != null && !Batch.Axes.HasFreeDrift(lane));
            }
        }
    }

    /// <summary>The end of the step of the lanes that take part; those whose rows leave their bounds leave late.</summary>
    public void Project(double dt, double tolerance)
    {
        if (Array.IndexOf(_isTakenOver, true) >= 0)
        {
            BilateralRows<V>.Place(Batch);
        }

        if (!Activate())
        {
            Array.Clear(_isBuilt, 0, _isBuilt.Length);
            return;
        }

        CompliantAngles<V>.AddDrift(Batch);
        RattleStep<V>.Build(Batch);
        VelocityProjection<V>.Run(Batch, dt, tolerance);
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            _hasLeftLate[lane] = !_isAlone[lane] && Batch.Axes != null && !Batch.Axes.HasFreeProjection(lane);
            _isAlone[lane] |= _hasLeftLate[lane];
            _isBuilt[lane] = !_isAlone[lane] || (_isTakenOver[lane] && !_hasLeftLate[lane]);
        }

        RattleStep<V>.Accumulate(Batch);
        MeasureEnergy(dt);
    }

    /// <summary>Enters the step of a lane, which has taken part in it to its end, into the account of its energy; where that does not allow it, the lane leaves.</summary>
    public void Enter(int lane, ref EnergyLedger ledger)
    {
        if (!LaneEnergy<V>.IsKnown(Batch, lane))
        {
            return;
        }

        double gain = Batch.Work.Gain[lane];
        double moving = Batch.Work.Moving[lane];
        bool isLed = LaneEnergy<V>.IsLed(Batch, lane);
        bool mayLose = isLed || Batch.Work.Slowed[lane] > 0 || CompliantAngles<V>.HaveActed(Batch, lane, moving) || (Batch.Axes != null && Batch.Axes.HasRow(lane));
        if (ledger.Allows(gain, moving, mayLose))
        {
            // Where J v is not 0, no factor on all speeds may change them.
            if (isLed || (Batch.Axes != null && Batch.Axes.HasMotor(lane)))
            {
                return;
            }

            double takeable = LaneEnergy<V>.Takeable(Batch, lane, Batch.Work.Kinetic[lane], out CommonMotion common);
            if (ledger.CanTake(gain, moving, takeable))
            {
                LaneEnergy<V>.Take(Batch, lane, ledger.Enter(gain, moving, takeable, mayLose), takeable, common);
                return;
            }
        }

        _isAlone[lane] = true;
        _isBuilt[lane] = false;
        _hasLeftLate[lane] = true;
        _hasFailed[lane] = true;
    }

    /// <summary>What the lanes that take part have come to, back to the world.</summary>
    /// <param name="dt">Step, s.</param>
    /// <param name="areReactionsAwaited">Whether what the joints did is to be written at once, or when it is asked for.</param>
    public void End(double dt, bool areReactionsAwaited)
    {
        if (!Activate())
        {
            return;
        }

        if (Array.IndexOf(_hasLeftLate, true) >= 0)
        {
            BilateralRows<V>.Place(Batch);
            DelassusMatrix<V>.InverseInertias(Batch);
        }

        MovingFrame<V>.Leave(Batch, dt);
        RattleStep<V>.Accept(Batch);
        GeometricStiffness<V>.Estimate(Batch, Batch.VelocityImpulses, dt / 2);
        LaneTransfer<V>.EndStep(Batch);
        LaneTransfer<V>.Scatter(Batch, Occupied, _mechanism);
        if (areReactionsAwaited)
        {
            Reactions<V>.Report(Batch, Occupied, _mechanism.Reactions, dt, Batch.Work.TotalImpulses);
        }
        else
        {
            Array.Copy(Batch.Work.TotalImpulses, _unread, _unread.Length);
            _unreadStep = dt;
        }

        for (int lane = 0; lane < Occupied; lane++)
        {
            _isUnread[lane] = !_isAlone[lane] && !areReactionsAwaited;
            if (!_isAlone[lane])
            {
                CoupledTurns<V>.Finish(Batch, lane);
                _limits?.FinishAngles(Batch, lane);
                Batch.Axes?.Finish(lane);
            }
        }
    }

    /// <summary>What the joints did in the last step, where it has not written it.</summary>
    public void WriteReactions(JointReaction[] reactions)
    {
        for (int lane = 0; lane < Occupied; lane++)
        {
            Batch.Work.Active[lane] = _isUnread[lane] ? 1 : 0;
        }

        Reactions<V>.Report(Batch, Occupied, reactions, _unreadStep, _unread);
    }

    /// <summary>A lane's step was made elsewhere.</summary>
    public void TakeOver<S>(int lane, LaneBatch<S> from, int fromLane)
        where S : struct, ILane<S>
    {
        LaneCopy<V>.OneLane(Batch, lane, from, fromLane);
        _isTakenOver[lane] = true;
    }

    /// <summary>The steps of all lanes were made elsewhere, in the same lanes.</summary>
    public void TakeOver(LaneBatch<V> from)
    {
        LaneCopy<V>.AllLanes(Batch, from);
        Array.Fill(_isTakenOver, true);
    }

    /// <summary>What the next step takes from those before it.</summary>
    public void Exchange(StateTape tape)
    {
        Batch.Exchange(tape);
        Batch.Axes?.Exchange(tape);
        tape.Array(_isBuilt);
    }

    /// <summary>The same of one lane, between steps.</summary>
    public void Exchange(StateTape tape, int lane)
    {
        Batch.Exchange(tape, lane);
        Batch.Axes?.Exchange(tape, lane);
        tape.Value(ref _isBuilt[lane]);
    }

    private void TakeOutSelfStress(double dt, double tolerance)
    {
        if (!Batch.Shape.IsRedundant || Batch.Shape.Loops != LoopConsistency.Exact)
        {
            return;
        }

        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            Batch.Work.Active[lane] = !_isAlone[lane] && _converged[lane] ? 1 : 0;
        }

        SelfStress.TakeOut(Batch, dt, tolerance, _isStressed);
    }

    private void MeasureEnergy(double dt)
    {
        Workspace<V> work = Batch.Work;
        Lane<V> kinetic = LaneEnergy<V>.Kinetic(Batch);
        Lane<V> given = LaneEnergy<V>.Work(Batch) + Lane<V>.Load(work.CompliantWork, 0);
        given = Batch.Axes == null ? given : given + Batch.Axes.Work(dt);
        given = Batch.Shape.HasKinematic ? given + LaneEnergy<V>.KinematicWorkBound(Batch, Batch.Work.TotalImpulses) : given;
        kinetic.Store(work.Kinetic, 0);
        Lane<V>.Max(kinetic, LaneEnergy<V>.FirstWork(Batch, dt)).Store(work.Moving, 0);
        (kinetic - Lane<V>.Load(work.StartKinetic, 0) - given).Store(work.Gain, 0);
    }

    private void Rebuild()
    {
        FreeMotion<V>.Stay(Batch);
        RattleStep<V>.Rebuild(Batch);
        Array.Fill(_isBuilt, true);
    }

    private bool Activate()
    {
        bool isAny = false;
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            Batch.Work.Active[lane] = _isAlone[lane] ? 0 : 1;
            isAny |= !_isAlone[lane];
        }

        return isAny;
    }

    private void LeaveForbiddenSpeeds()
    {
        Impulses<V>.NegativeSpeeds(Batch);
        double[] speeds = Batch.Work.Solution;
        for (int n = 0; n < Batch.Shape.Blocks.Length; n++)
        {
            int first = Batch.Shape.Pattern.Rows[n] * Lane<V>.Width;
            int end = first + Batch.Shape.Blocks[n].BilateralCount * Lane<V>.Width;
            for (int i = first; i < end; i++)
            {
                int lane = i % Lane<V>.Width;
                _isAlone[lane] |= IsMoved(lane) && Math.Abs(speeds[i]) > InitialVelocityProjection.MostForbidden;
            }
        }
    }

    private void LeaveOpenOnes()
    {
        BilateralRows<V>.Evaluate(Batch);
        BilateralRows<V>.MeasureErrors(Batch);
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            double open = Batch.Shape.IsInconsistent ? Batch.Work.MaxGap[lane] : Batch.Work.MaxError[lane];
            _isAlone[lane] |= IsMoved(lane) && open > PositionProjection.MostOpen;
        }
    }

    private void ClearHistory(int lane)
    {
        for (int i = lane; i < Batch.VelocityImpulses.Length; i += Lane<V>.Width)
        {
            Batch.VelocityImpulses[i] = 0;
        }

        Batch.Axes?.Forget(lane);
    }
}
