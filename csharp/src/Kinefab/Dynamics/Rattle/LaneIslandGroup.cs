using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Islands in lanes. All lanes try a plain RATTLE step together, those that rest on limits with rows for these; those that it does not suffice, or
/// whose limits and drives come to act otherwise, are taken out and go down the step controller by themselves, so that no lane's result depends on
/// its neighbours'.
/// </summary>
internal sealed class LaneIslandGroup<V> : IslandGroup
    where V : struct, ILane<V>
{
    private readonly MultibodySystem _mechanism;
    private readonly LaneStep<V>[] _free;

    // Of the same lanes, with the rows of limits; empty without such.
    private readonly LaneStep<V>[] _resting;
    private readonly bool[] _rests = new bool[Lane<V>.Width];
    private readonly SubstepHistory[] _histories;

    // Of islands with scalar rows, which they have only when they step alone; else empty.
    private readonly AloneMemory[] _memories;
    private readonly Standstill[] _stills;
    private readonly LaneBatch<ScalarLane> _spare;
    private readonly StepController _controller;

    public LaneIslandGroup(MultibodySystem mechanism, List<LaneIsland> islands)
        : base(Array.ConvertAll(islands.ToArray(), island => island.Alone))
    {
        _mechanism = mechanism;
        LaneIsland shape = islands[0];
        foreach (Island form in shape.Forms)
        {
            form.Order(mechanism.Cancellation);
        }

        _free = Steps(shape.InLanes, islands.ConvertAll(island => island.InLanes));
        _resting = shape.Resting is null ? Array.Empty<LaneStep<V>>() : Steps(shape.Resting, islands.ConvertAll(island => island.Resting!));
        _histories = new SubstepHistory[Islands.Length];
        _stills = Array.ConvertAll(Islands, _ => new Standstill());
        _memories = shape.Alone.ScalarCount == 0 ? Array.Empty<AloneMemory>() : Array.ConvertAll(Islands, island => new AloneMemory(island, mechanism.Bodies));
        _spare = new LaneBatch<ScalarLane>(shape.Alone, new Workspace<ScalarLane>(shape.Alone));
        _controller = new StepController(_spare);
    }

    /// <inheritdoc/>
    public override void Step(double dt, double tolerance, bool areReactionsAwaited)
    {
        foreach (AloneMemory memory in _memories)
        {
            memory.UndoShown();
        }

        for (int i = 0; i < _free.Length; i++)
        {
            LaneStep<V> free = _free[i];
            free.Load(dt);
            Sort(free, i, dt, tolerance);
            LoadResting(free, i);
            free.Begin(dt, tolerance);
            free.Drift(dt, tolerance);
            Rest(i, dt, tolerance, areReactionsAwaited);
            for (int lane = 0; lane < free.Occupied; lane++)
            {
                if (free.IsAlone(lane) && !free.IsTakenOver(lane))
                {
                    AdvanceAlone(free, i, lane, dt, tolerance);
                }
            }

            free.Project(dt, tolerance);
            EnterEnergies(free, i);
            for (int lane = 0; lane < free.Occupied; lane++)
            {
                if (free.HasLeftLate(lane))
                {
                    AdvanceAlone(free, i, lane, dt, tolerance);
                }
            }

            free.End(dt, areReactionsAwaited);
            for (int lane = 0; lane < free.Occupied; lane++)
            {
                if (free.IsActive(lane))
                {
                    Forget(i, lane, true);
                }
            }
        }
    }

    /// <inheritdoc/>
    public override void WriteReactions(JointReaction[] reactions)
    {
        Array.ForEach(_free, step => step.WriteReactions(reactions));
        Array.ForEach(_resting, step => step.WriteReactions(reactions));
    }

    /// <inheritdoc/>
    public override void Exchange(StateTape tape)
    {
        foreach (LaneStep<V> step in _free)
        {
            step.Exchange(tape);
        }

        foreach (LaneStep<V> step in _resting)
        {
            step.Exchange(tape);
        }

        tape.Array(_histories);
        foreach (AloneMemory memory in _memories)
        {
            memory.Exchange(tape);
        }
    }

    /// <inheritdoc/>
    public override void Exchange(StateTape tape, int island)
    {
        (int index, int lane) = (island / Lane<V>.Width, island % Lane<V>.Width);
        _free[index].Exchange(tape, lane);
        if (_resting.Length > 0)
        {
            _resting[index].Exchange(tape, lane);
        }

        tape.Value(ref _histories[island]);
        if (_memories.Length > 0)
        {
            _memories[island].Exchange(tape);
        }
    }

    // Which lanes take part: not those that are cut or turn fast, and not those at limits.
    private void Sort(LaneStep<V> free, int index, double dt, double tolerance)
    {
        Array.Clear(_rests, 0, _rests.Length);
        for (int lane = 0; lane < free.Occupied; lane++)
        {
            if (free.IsAlone(lane) || History(index, lane).IsAlone || free.Demand(lane, dt) > 1)
            {
                free.Leave(lane);
            }
            else if (free.IsAtLimit(lane, tolerance))
            {
                free.Leave(lane);
                _rests[lane] = _resting.Length > 0 && !free.IsMoved(lane);
            }
        }
    }

    private void LoadResting(LaneStep<V> free, int index)
    {
        if (Array.IndexOf(_rests, true) >= 0)
        {
            _resting[index].Load(free, _rests);
        }
        else if (_resting.Length > 0)
        {
            _resting[index].LeaveAll();
        }
    }

    // The step of the lanes that rest on limits; those that cannot do it so are left alone.
    private void Rest(int index, double dt, double tolerance, bool areReactionsAwaited)
    {
        if (Array.IndexOf(_rests, true) < 0)
        {
            return;
        }

        LaneStep<V> free = _free[index];
        LaneStep<V> resting = _resting[index];
        resting.Begin(dt, tolerance);
        resting.Drift(dt, tolerance);
        resting.Project(dt, tolerance);
        EnterEnergies(resting, index);
        resting.End(dt, areReactionsAwaited);
        bool areAll = resting.AreAllActive;
        if (areAll)
        {
            free.TakeOver(resting.Batch);
        }

        for (int lane = 0; lane < free.Occupied; lane++)
        {
            if (resting.IsActive(lane))
            {
                if (!areAll)
                {
                    free.TakeOver(lane, resting.Batch, lane);
                }

                Forget(index, lane, false);
            }
        }
    }

    private void EnterEnergies(LaneStep<V> step, int index)
    {
        for (int lane = 0; lane < step.Occupied; lane++)
        {
            if (step.IsActive(lane))
            {
                step.Enter(lane, ref History(index, lane).Energy);
            }
        }
    }

    // The world still holds the island's state before the step, the lane its impulses.
    private void AdvanceAlone(LaneStep<V> free, int index, int lane, double dt, double tolerance)
    {
        Island island = Islands[index * Lane<V>.Width + lane];
        LaneTransfer<ScalarLane>.GatherConstants(_spare, 0, island, _mechanism);
        LaneTransfer<ScalarLane>.Gather(_spare, _mechanism, dt);
        LaneTransfer<ScalarLane>.BeginStep(_spare);
        MovingFrame<ScalarLane>.Copy(free.Batch, lane, _spare, 0);
        MovingFrame<ScalarLane>.Enter(_spare);
        _spare.Reset();
        LaneCopy<V>.Guess(free.Batch, lane, _spare, 0);
        AxisRows<V>? axes = (_resting.Length > 0 ? _resting[index] : free).Batch.Axes;
        AloneMemory? memory = _memories.Length > 0 ? _memories[index * Lane<V>.Width + lane] : null;
        bool isMoved = free.IsMoved(lane);
        if (isMoved)
        {
            Forget(index, lane, true);
        }

        if (memory == null || !memory.TryRestore(_spare))
        {
            axes?.HandOver(lane, _spare);
        }

        FreeMotion<ScalarLane>.Stay(_spare);
        RattleStep<ScalarLane>.Rebuild(_spare);
        RattleStep<ScalarLane>.ReloadState(_spare);
        int stops = _controller.DampedSteps;
        _controller.Advance(dt, tolerance, ref History(index, lane), _stills[index * Lane<V>.Width + lane], free.HasFailed(lane), isMoved);
        Note(_controller, island, stops);
        memory?.Save(_spare, dt, _controller.DampedSteps == stops);
        axes?.TakeOver(lane, _spare);
        GeometricStiffness<ScalarLane>.Estimate(_spare, _spare.VelocityImpulses, dt / 2);
        _spare.Work.Active[0] = 1;
        LaneTransfer<ScalarLane>.EndStep(_spare);
        MovingFrame<ScalarLane>.Leave(_spare, dt);
        LaneTransfer<ScalarLane>.Scatter(_spare, 1, _mechanism);
        Reactions<ScalarLane>.Report(_spare, 1, _mechanism.Reactions, dt, _spare.Work.TotalImpulses);
        free.TakeOver(lane, _spare, 0);
    }

    // A step in lanes leaves no scalar rows to remember, and one without limits none of theirs.
    private void Forget(int index, int lane, bool isFree)
    {
        if (_memories.Length > 0)
        {
            _memories[index * Lane<V>.Width + lane].Forget();
        }

        if (isFree && _resting.Length > 0)
        {
            _resting[index].Batch.Axes!.Forget(lane);
        }
    }

    private ref SubstepHistory History(int batch, int lane) => ref _histories[batch * Lane<V>.Width + lane];

    private LaneStep<V>[] Steps(Island shape, List<Island> islands)
    {
        int w = Lane<V>.Width;
        var steps = new LaneStep<V>[(islands.Count + w - 1) / w];
        var workspace = new Workspace<V>(shape);
        for (int i = 0; i < steps.Length; i++)
        {
            int occupied = Math.Min(w, islands.Count - i * w);
            steps[i] = new LaneStep<V>(_mechanism, islands.GetRange(i * w, occupied).ToArray(), shape, workspace);
        }

        return steps;
    }
}
