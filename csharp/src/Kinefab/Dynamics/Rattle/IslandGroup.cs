using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Islands that are stepped one after the other or, being of one shape, side by side.</summary>
internal abstract class IslandGroup
{
    /// <summary>One step of all islands.</summary>
    public abstract void Step(double dt, double tolerance);

    /// <summary>What the next step takes from those before it.</summary>
    public abstract void Exchange(StateTape tape);

    /// <summary>Tells the mechanism what a ladder's last step has to say of an island.</summary>
    /// <param name="mechanism">Takes the notes.</param>
    /// <param name="ladder">The one that made the step.</param>
    /// <param name="island">The island that was stepped.</param>
    /// <param name="stopsBefore">The ladder's stops before the step.</param>
    protected static void Note(MultibodySystem mechanism, Ladder ladder, Island island, int stopsBefore)
    {
        if (ladder.HasClosed)
        {
            mechanism.Closed.Add(ladder.Closed(island));
        }

        if (ladder.Stops > stopsBefore)
        {
            mechanism.Stops += ladder.Stops - stopsBefore;
            mechanism.Unsolved.Add(ladder.Unsolved(island));
        }
    }
}

/// <summary>
/// Islands of locked axes alone, in lanes. All lanes try a plain RATTLE step together; those that it does not suffice
/// are taken out and go down the ladder by themselves, so that no lane's result depends on its neighbours'.
/// </summary>
internal sealed class IslandGroup<V> : IslandGroup
    where V : struct, ILane<V>
{
    private readonly MultibodySystem _mechanism;
    private readonly Island[] _islands;
    private readonly Batch<V>[] _batches;
    private readonly bool[] _converged = new bool[Lane<V>.Width];
    private readonly bool[] _isHard = new bool[Lane<V>.Width];
    private readonly StepCut[] _cuts;
    private readonly Batch<ScalarLane> _spare;
    private readonly Ladder _ladder;

    public IslandGroup(MultibodySystem mechanism, List<Island> islands)
    {
        _mechanism = mechanism;
        _islands = islands.ToArray();
        int width = Lane<V>.Width;
        _batches = new Batch<V>[(_islands.Length + width - 1) / width];
        var workspace = new Workspace<V>(_islands[0]);
        for (int i = 0; i < _batches.Length; i++)
        {
            var batch = new Batch<V>(_islands[i * width], workspace);
            for (int lane = 0; lane < width; lane++)
            {
                Transfer<V>.LoadConstants(batch, lane, Occupant(i, lane), mechanism);
            }

            _batches[i] = batch;
        }

        _cuts = new StepCut[_islands.Length];
        _spare = new Batch<ScalarLane>(_islands[0], new Workspace<ScalarLane>(_islands[0]));
        _ladder = new Ladder(_spare);
    }

    /// <inheritdoc/>
    public override void Step(double dt, double tolerance)
    {
        for (int i = 0; i < _batches.Length; i++)
        {
            Batch<V> batch = _batches[i];
            Load(batch, i, dt);
            RattleStep<V>.Fly(batch, dt, tolerance, _converged);
            bool hasClimbed = false;
            for (int lane = 0; lane < Lane<V>.Width; lane++)
            {
                bool hasFailed = !_converged[lane];
                if ((_isHard[lane] || hasFailed) && IsOccupied(i, lane))
                {
                    hasClimbed = true;
                    Climb(batch, i, lane, dt, tolerance, hasFailed);
                }

                _isHard[lane] |= hasFailed;
                batch.Work.Active[lane] = _isHard[lane] ? 0 : 1;
            }

            if (hasClimbed)
            {
                RigidRows<V>.Place(batch);
            }

            RattleStep<V>.Build(batch);
            VelocityProjection<V>.Run(batch, dt, tolerance);
            RattleStep<V>.Accept(batch);
            Stiffness<V>.Measure(batch, batch.Half, dt / 2);
            RattleStep<V>.AddUp(batch);
            Transfer<V>.Finish(batch);
            int occupied = Math.Min(Lane<V>.Width, _islands.Length - i * Lane<V>.Width);
            Transfer<V>.Store(batch, occupied, _mechanism);
            Reactions<V>.Report(batch, occupied, _mechanism, dt);
        }
    }

    /// <inheritdoc/>
    public override void Exchange(StateTape tape)
    {
        foreach (Batch<V> batch in _batches)
        {
            batch.Exchange(tape);
        }

        tape.Array(_cuts);
    }

    private void Load(Batch<V> batch, int index, double dt)
    {
        bool isMoved = Transfer<V>.Load(batch, _mechanism, dt);
        for (int lane = 0; lane < Lane<V>.Width && isMoved; lane++)
        {
            if (batch.Work.Moved[lane] != 0)
            {
                ClearHistory(batch, lane);
            }
        }

        Transfer<V>.Start(batch);
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            double stiffest = 0;
            for (int body = 0; body < batch.Shape.MovingBodies; body++)
            {
                stiffest = Math.Max(stiffest, batch.Bodies[Batch<V>.Body(body, BodySlot.Stiffness) + lane]);
            }

            _isHard[lane] = StepDemand.Of(stiffest, batch.Work.Fastest[lane], dt) > 1 || (IsOccupied(index, lane) && Cut(index, lane).Halvings > 0);
            batch.Work.Active[lane] = _isHard[lane] ? 0 : 1;
        }

        if (isMoved)
        {
            Flight<V>.Stay(batch);
            RattleStep<V>.Rebuild(batch);
            LeaveOpenOnes(batch);
        }
    }

    // Moved lanes that stand open are the ladder's to close.
    private void LeaveOpenOnes(Batch<V> batch)
    {
        if (batch.Shape.IsInexact)
        {
            return;
        }

        RigidRows<V>.Evaluate(batch);
        RigidRows<V>.Rate(batch);
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            _isHard[lane] |= batch.Work.Moved[lane] != 0 && batch.Work.MaxError[lane] > PoseClosure.MostOpen;
            batch.Work.Active[lane] = _isHard[lane] ? 0 : 1;
        }
    }

    // The world still holds the island's state before the step, the lane its impulses.
    private void Climb(Batch<V> batch, int index, int lane, double dt, double tolerance, bool hasFailed)
    {
        Island island = Occupant(index, lane);
        Transfer<ScalarLane>.LoadConstants(_spare, 0, island, _mechanism);
        Transfer<ScalarLane>.Load(_spare, _mechanism, dt);
        Transfer<ScalarLane>.Start(_spare);
        for (int i = 0; i < _spare.Half.Length; i++)
        {
            _spare.Half[i] = batch.Half[i * Lane<V>.Width + lane];
        }

        for (int body = 0; body < _spare.Shape.MovingBodies; body++)
        {
            _spare.Bodies[Batch<ScalarLane>.Body(body, BodySlot.Stiffness)] = batch.Bodies[Batch<V>.Body(body, BodySlot.Stiffness) + lane];
        }

        Flight<ScalarLane>.Stay(_spare);
        RattleStep<ScalarLane>.Rebuild(_spare);
        int stops = _ladder.Stops;
        _ladder.Step(dt, tolerance, ref Cut(index, lane), hasFailed, batch.Work.Moved[lane] != 0);
        Note(_mechanism, _ladder, island, stops);
        Transfer<V>.CopyFrom(batch, lane, _spare);
    }

    private static void ClearHistory(Batch<V> batch, int lane)
    {
        for (int i = lane; i < batch.Half.Length; i += Lane<V>.Width)
        {
            batch.Half[i] = 0;
        }
    }

    private ref StepCut Cut(int batch, int lane) => ref _cuts[batch * Lane<V>.Width + lane];

    private bool IsOccupied(int batch, int lane) => batch * Lane<V>.Width + lane < _islands.Length;

    // Lanes without an island of their own work on a copy of the batch's first.
    private Island Occupant(int batch, int lane) =>
        _islands[IsOccupied(batch, lane) ? batch * Lane<V>.Width + lane : batch * Lane<V>.Width];
}
