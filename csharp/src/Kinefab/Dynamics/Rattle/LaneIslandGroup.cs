using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Islands in lanes. All lanes try a plain RATTLE step together; those that it does not suffice, or whose limits come into play, are taken
/// out and go down the step controller by themselves, so that no lane's result depends on its neighbours'.
/// </summary>
internal sealed class LaneIslandGroup<V> : IslandGroup
    where V : struct, ILane<V>
{
    private readonly MultibodySystem _mechanism;
    private readonly LaneIsland[] _islands;
    private readonly LaneBatch<V>[] _batches;
    private readonly WatchedLimits<V>? _limits;

    // Batches of which all lanes made the last step alone, so that their rows are not those of the pose.
    private readonly bool[] _isLeft;
    private readonly bool[] _converged = new bool[Lane<V>.Width];
    private readonly bool[] _isAlone = new bool[Lane<V>.Width];
    private readonly SubstepHistory[] _histories;

    // Of islands with scalar rows, which they have only when they step alone; else empty.
    private readonly AloneMemory[] _memories;
    private readonly LaneBatch<ScalarLane> _spare;
    private readonly StepController _controller;

    public LaneIslandGroup(MultibodySystem mechanism, List<LaneIsland> islands)
    {
        _mechanism = mechanism;
        _islands = islands.ToArray();
        Island shape = _islands[0].InLanes;
        int width = Lane<V>.Width;
        _batches = new LaneBatch<V>[(_islands.Length + width - 1) / width];
        _isLeft = new bool[_batches.Length];
        var workspace = new Workspace<V>(shape);
        for (int i = 0; i < _batches.Length; i++)
        {
            // All of one shape object, so that what it says is read from memory once.
            var batch = new LaneBatch<V>(shape, workspace);
            for (int lane = 0; lane < width; lane++)
            {
                LaneTransfer<V>.GatherConstants(batch, lane, Occupant(i, lane).InLanes, mechanism);
            }

            _batches[i] = batch;
        }

        _limits = WatchedLimits<V>.Of(shape);
        _histories = new SubstepHistory[_islands.Length];
        Island alone = _islands[0].Alone;
        _memories = alone.ScalarCount == 0 ? Array.Empty<AloneMemory>() : Array.ConvertAll(_islands, island => new AloneMemory(island.Alone, mechanism.Bodies));
        _spare = new LaneBatch<ScalarLane>(alone, new Workspace<ScalarLane>(alone));
        _controller = new StepController(_spare);
    }

    /// <inheritdoc/>
    public override void Step(double dt, double tolerance)
    {
        foreach (AloneMemory memory in _memories)
        {
            memory.BeginStep();
        }

        for (int i = 0; i < _batches.Length; i++)
        {
            LaneBatch<V> batch = _batches[i];
            Load(batch, i, dt, tolerance);
            bool isAny = IsAnyActive(batch);
            Drift(batch, isAny, dt, tolerance);
            bool hasClimbed = false;
            for (int lane = 0; lane < Lane<V>.Width; lane++)
            {
                bool hasFailed = isAny && !_converged[lane];
                _isAlone[lane] = _isAlone[lane] || hasFailed || (_limits != null && _limits.IsPassed(batch, lane, tolerance));
                if (_isAlone[lane] && IsOccupied(i, lane))
                {
                    hasClimbed = true;
                    AdvanceAlone(batch, i, lane, dt, tolerance, hasFailed);
                }

                batch.Work.Active[lane] = _isAlone[lane] ? 0 : 1;
            }

            if (hasClimbed)
            {
                BilateralRows<V>.Place(batch);
            }

            Project(batch, i, dt, tolerance);
            RattleStep<V>.Accept(batch);
            GeometricStiffness<V>.Estimate(batch, batch.VelocityImpulses, dt / 2);
            RattleStep<V>.Accumulate(batch);
            LaneTransfer<V>.EndStep(batch);
            int occupied = Math.Min(Lane<V>.Width, _islands.Length - i * Lane<V>.Width);
            LaneTransfer<V>.Scatter(batch, occupied, _mechanism);
            Reactions<V>.Report(batch, occupied, _mechanism, dt);
            for (int lane = 0; lane < occupied; lane++)
            {
                FinishLane(batch, i, lane);
            }
        }
    }

    /// <inheritdoc/>
    public override void Exchange(StateTape tape)
    {
        foreach (LaneBatch<V> batch in _batches)
        {
            batch.Exchange(tape);
        }

        tape.Array(_histories);
        tape.Array(_isLeft);
        foreach (AloneMemory memory in _memories)
        {
            memory.Exchange(tape);
        }
    }

    private void Load(LaneBatch<V> batch, int index, double dt, double tolerance)
    {
        LaneTransfer<V>.Gather(batch, _mechanism, dt);
        bool isMoved = false;
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            if (batch.Work.Moved[lane] != 0 && IsOccupied(index, lane))
            {
                isMoved = true;
                ClearHistory(batch, lane);
            }
        }

        LaneTransfer<V>.BeginStep(batch);
        CoupledTurns<V>.Gather(batch);
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            double stiffest = 0;
            for (int body = 0; body < batch.Shape.MovingBodies; body++)
            {
                stiffest = Math.Max(stiffest, batch.Bodies[LaneBatch<V>.Body(body, BodyLanes.Stiffness) + lane]);
            }

            _isAlone[lane] = !IsOccupied(index, lane) || StepLimit.Of(stiffest, batch.Work.Fastest[lane], dt) > 1 || History(index, lane).Halvings > 0;
        }

        if (isMoved)
        {
            FreeMotion<V>.Stay(batch);
            RattleStep<V>.Rebuild(batch);
            LeaveOpenOnes(batch);
            LeaveForbiddenSpeeds(batch);
        }

        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            _isAlone[lane] = _isAlone[lane] || (_limits != null && _limits.IsReached(batch, lane, tolerance));
            batch.Work.Active[lane] = _isAlone[lane] ? 0 : 1;
        }

        if (!isMoved && _isLeft[index] && IsAnyActive(batch))
        {
            FreeMotion<V>.Stay(batch);
            RattleStep<V>.Rebuild(batch);
        }
    }

    private void Drift(LaneBatch<V> batch, bool isAny, double dt, double tolerance)
    {
        if (isAny)
        {
            RattleStep<V>.KickAndDrift(batch, dt, tolerance, _converged);
            _limits?.Measure(batch);
        }
    }

    // Of lanes that are all alone only what the next step's start asks for is made.
    private void Project(LaneBatch<V> batch, int index, double dt, double tolerance)
    {
        _isLeft[index] = !IsAnyActive(batch);
        if (_isLeft[index])
        {
            DelassusMatrix<V>.InverseInertias(batch);
            return;
        }

        RattleStep<V>.Build(batch);
        VelocityProjection<V>.Run(batch, dt, tolerance);
    }

    private void FinishLane(LaneBatch<V> batch, int index, int lane)
    {
        if (!_isAlone[lane])
        {
            CoupledTurns<V>.Finish(batch, lane);
            if (_limits != null)
            {
                _limits.FinishAngles(batch, lane);
                _memories[index * Lane<V>.Width + lane].Forget();
            }
        }
    }

    // So are those with speeds that the joints forbid.
    private void LeaveForbiddenSpeeds(LaneBatch<V> batch)
    {
        Impulses<V>.NegativeSpeeds(batch);
        double[] speeds = batch.Work.Solution;
        for (int i = 0; i < speeds.Length; i++)
        {
            int lane = i % Lane<V>.Width;
            _isAlone[lane] |= batch.Work.Moved[lane] != 0 && Math.Abs(speeds[i]) > InitialVelocityProjection.MostForbidden;
        }
    }

    // Moved lanes that stand open are the step controller's to close.
    private void LeaveOpenOnes(LaneBatch<V> batch)
    {
        if (batch.Shape.IsInconsistent)
        {
            return;
        }

        BilateralRows<V>.Evaluate(batch);
        BilateralRows<V>.MeasureErrors(batch);
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            _isAlone[lane] |= batch.Work.Moved[lane] != 0 && batch.Work.MaxError[lane] > PositionProjection.MostOpen;
        }
    }

    // The world still holds the island's state before the step, the lane its impulses.
    private void AdvanceAlone(LaneBatch<V> batch, int index, int lane, double dt, double tolerance, bool hasFailed)
    {
        Island island = Occupant(index, lane).Alone;
        LaneTransfer<ScalarLane>.GatherConstants(_spare, 0, island, _mechanism);
        LaneTransfer<ScalarLane>.Gather(_spare, _mechanism, dt);
        LaneTransfer<ScalarLane>.BeginStep(_spare);
        LaneTransfer<V>.CopyGuess(batch, lane, _spare);
        AloneMemory? memory = _memories.Length > 0 ? _memories[index * Lane<V>.Width + lane] : null;
        bool isMoved = batch.Work.Moved[lane] != 0;
        if (isMoved)
        {
            memory?.Forget();
        }

        memory?.Restore(_spare);
        FreeMotion<ScalarLane>.Stay(_spare);
        RattleStep<ScalarLane>.Rebuild(_spare);
        RattleStep<ScalarLane>.ReloadState(_spare);
        int stops = _controller.DampedSteps;
        _controller.Advance(dt, tolerance, ref History(index, lane), hasFailed, isMoved);
        Note(_controller, island, stops);
        memory?.Save(_spare, _controller.DampedSteps == stops);
        LaneTransfer<ScalarLane>.EndStep(_spare);
        LaneTransfer<ScalarLane>.Scatter(_spare, 1, _mechanism);
        _spare.Work.Active[0] = 1;
        Reactions<ScalarLane>.Report(_spare, 1, _mechanism, dt);
        LaneTransfer<V>.CopyLane(batch, lane, _spare);
    }

    private static void ClearHistory(LaneBatch<V> batch, int lane)
    {
        for (int i = lane; i < batch.VelocityImpulses.Length; i += Lane<V>.Width)
        {
            batch.VelocityImpulses[i] = 0;
        }
    }

    private static bool IsAnyActive(LaneBatch<V> batch)
    {
        bool isAny = false;
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            isAny |= batch.Work.Active[lane] != 0;
        }

        return isAny;
    }

    private ref SubstepHistory History(int batch, int lane) => ref _histories[batch * Lane<V>.Width + lane];

    private bool IsOccupied(int batch, int lane) => batch * Lane<V>.Width + lane < _islands.Length;

    // Lanes without an island of their own hold a copy of the batch's first, which is never active.
    private LaneIsland Occupant(int batch, int lane) =>
        _islands[IsOccupied(batch, lane) ? batch * Lane<V>.Width + lane : batch * Lane<V>.Width];
}
