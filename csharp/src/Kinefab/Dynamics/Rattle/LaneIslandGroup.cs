using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Islands of locked axes alone, in lanes. All lanes try a plain RATTLE step together; those that it does not suffice
/// are taken out and go down the step controller by themselves, so that no lane's result depends on its neighbours'.
/// </summary>
internal sealed class LaneIslandGroup<V> : IslandGroup
    where V : struct, ILane<V>
{
    private readonly MultibodySystem _mechanism;
    private readonly Island[] _islands;
    private readonly LaneBatch<V>[] _batches;
    private readonly bool[] _converged = new bool[Lane<V>.Width];
    private readonly bool[] _isAlone = new bool[Lane<V>.Width];
    private readonly SubstepHistory[] _histories;
    private readonly LaneBatch<ScalarLane> _spare;
    private readonly StepController _controller;

    public LaneIslandGroup(MultibodySystem mechanism, List<Island> islands)
    {
        _mechanism = mechanism;
        _islands = islands.ToArray();
        int width = Lane<V>.Width;
        _batches = new LaneBatch<V>[(_islands.Length + width - 1) / width];
        var workspace = new Workspace<V>(_islands[0]);
        for (int i = 0; i < _batches.Length; i++)
        {
            // All of one shape object, so that what it says is read from memory once.
            var batch = new LaneBatch<V>(_islands[0], workspace);
            for (int lane = 0; lane < width; lane++)
            {
                LaneTransfer<V>.GatherConstants(batch, lane, Occupant(i, lane), mechanism);
            }

            _batches[i] = batch;
        }

        _histories = new SubstepHistory[_islands.Length];
        _spare = new LaneBatch<ScalarLane>(_islands[0], new Workspace<ScalarLane>(_islands[0]));
        _controller = new StepController(_spare);
    }

    /// <inheritdoc/>
    public override void Step(double dt, double tolerance)
    {
        for (int i = 0; i < _batches.Length; i++)
        {
            LaneBatch<V> batch = _batches[i];
            Load(batch, i, dt);
            RattleStep<V>.KickAndDrift(batch, dt, tolerance, _converged);
            bool hasClimbed = false;
            for (int lane = 0; lane < Lane<V>.Width; lane++)
            {
                bool hasFailed = !_converged[lane];
                if ((_isAlone[lane] || hasFailed) && IsOccupied(i, lane))
                {
                    hasClimbed = true;
                    AdvanceAlone(batch, i, lane, dt, tolerance, hasFailed);
                }

                _isAlone[lane] |= hasFailed;
                batch.Work.Active[lane] = _isAlone[lane] ? 0 : 1;
            }

            if (hasClimbed)
            {
                BilateralRows<V>.Place(batch);
            }

            RattleStep<V>.Build(batch);
            VelocityProjection<V>.Run(batch, dt, tolerance);
            RattleStep<V>.Accept(batch);
            GeometricStiffness<V>.Estimate(batch, batch.VelocityImpulses, dt / 2);
            RattleStep<V>.Accumulate(batch);
            LaneTransfer<V>.EndStep(batch);
            int occupied = Math.Min(Lane<V>.Width, _islands.Length - i * Lane<V>.Width);
            LaneTransfer<V>.Scatter(batch, occupied, _mechanism);
            Reactions<V>.Report(batch, occupied, _mechanism, dt);
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
    }

    private void Load(LaneBatch<V> batch, int index, double dt)
    {
        bool isMoved = LaneTransfer<V>.Gather(batch, _mechanism, dt);
        for (int lane = 0; lane < Lane<V>.Width && isMoved; lane++)
        {
            if (batch.Work.Moved[lane] != 0)
            {
                ClearHistory(batch, lane);
            }
        }

        LaneTransfer<V>.BeginStep(batch);
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            double stiffest = 0;
            for (int body = 0; body < batch.Shape.MovingBodies; body++)
            {
                stiffest = Math.Max(stiffest, batch.Bodies[LaneBatch<V>.Body(body, BodyLanes.Stiffness) + lane]);
            }

            _isAlone[lane] = StepLimit.Of(stiffest, batch.Work.Fastest[lane], dt) > 1 || (IsOccupied(index, lane) && History(index, lane).Halvings > 0);
            batch.Work.Active[lane] = _isAlone[lane] ? 0 : 1;
        }

        if (isMoved)
        {
            FreeMotion<V>.Stay(batch);
            RattleStep<V>.Rebuild(batch);
            LeaveOpenOnes(batch);
            LeaveForbiddenSpeeds(batch);
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

        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            batch.Work.Active[lane] = _isAlone[lane] ? 0 : 1;
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
            batch.Work.Active[lane] = _isAlone[lane] ? 0 : 1;
        }
    }

    // The world still holds the island's state before the step, the lane its impulses.
    private void AdvanceAlone(LaneBatch<V> batch, int index, int lane, double dt, double tolerance, bool hasFailed)
    {
        Island island = Occupant(index, lane);
        LaneTransfer<ScalarLane>.GatherConstants(_spare, 0, island, _mechanism);
        LaneTransfer<ScalarLane>.Gather(_spare, _mechanism, dt);
        LaneTransfer<ScalarLane>.BeginStep(_spare);
        for (int i = 0; i < _spare.VelocityImpulses.Length; i++)
        {
            _spare.VelocityImpulses[i] = batch.VelocityImpulses[i * Lane<V>.Width + lane];
        }

        for (int body = 0; body < _spare.Shape.MovingBodies; body++)
        {
            _spare.Bodies[LaneBatch<ScalarLane>.Body(body, BodyLanes.Stiffness)] = batch.Bodies[LaneBatch<V>.Body(body, BodyLanes.Stiffness) + lane];
        }

        FreeMotion<ScalarLane>.Stay(_spare);
        RattleStep<ScalarLane>.Rebuild(_spare);
        int stops = _controller.DampedSteps;
        _controller.Advance(dt, tolerance, ref History(index, lane), hasFailed, batch.Work.Moved[lane] != 0);
        Note(_controller, island, stops);
        LaneTransfer<V>.CopyLane(batch, lane, _spare);
    }

    private static void ClearHistory(LaneBatch<V> batch, int lane)
    {
        for (int i = lane; i < batch.VelocityImpulses.Length; i += Lane<V>.Width)
        {
            batch.VelocityImpulses[i] = 0;
        }
    }

    private ref SubstepHistory History(int batch, int lane) => ref _histories[batch * Lane<V>.Width + lane];

    private bool IsOccupied(int batch, int lane) => batch * Lane<V>.Width + lane < _islands.Length;

    // Lanes without an island of their own work on a copy of the batch's first.
    private Island Occupant(int batch, int lane) =>
        _islands[IsOccupied(batch, lane) ? batch * Lane<V>.Width + lane : batch * Lane<V>.Width];
}
