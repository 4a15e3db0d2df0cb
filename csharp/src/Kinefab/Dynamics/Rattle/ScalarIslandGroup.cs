using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Islands that always have assembled rows, one at a time.</summary>
internal sealed class ScalarIslandGroup : IslandGroup
{
    private readonly MultibodySystem _mechanism;
    private readonly LaneBatch<ScalarLane>[] _batches;
    private readonly StepController[] _controllers;
    private readonly StiffSpringCorrection?[] _corrections;
    private readonly SubstepHistory[] _histories;
    private readonly Standstill[] _stills;

    public ScalarIslandGroup(MultibodySystem mechanism, List<Island> islands)
        : base(islands.ToArray())
    {
        _mechanism = mechanism;
        _batches = new LaneBatch<ScalarLane>[Islands.Length];
        _controllers = new StepController[Islands.Length];
        _corrections = new StiffSpringCorrection?[Islands.Length];
        _histories = new SubstepHistory[Islands.Length];
        _stills = Array.ConvertAll(Islands, _ => new Standstill());
        for (int i = 0; i < Islands.Length; i++)
        {
            Islands[i].Order(mechanism.Cancellation);
            _batches[i] = new LaneBatch<ScalarLane>(Islands[i], new Workspace<ScalarLane>(Islands[i]));
            _controllers[i] = new StepController(_batches[i]);
            _corrections[i] = Islands[i].ScalarCount > 0 ? new StiffSpringCorrection(Islands[i], mechanism.Bodies) : null;
            LaneTransfer<ScalarLane>.GatherConstants(_batches[i], 0, Islands[i], mechanism);
        }
    }

    /// <inheritdoc/>
    public override void Step(double dt, double tolerance, bool areReactionsAwaited)
    {
        for (int i = 0; i < Islands.Length; i++)
        {
            LaneBatch<ScalarLane> batch = _batches[i];
            _corrections[i]?.Undo();
            bool isMoved = LaneTransfer<ScalarLane>.Gather(batch, _mechanism, dt);
            LaneTransfer<ScalarLane>.BeginStep(batch);
            MovingFrame<ScalarLane>.Find(batch, dt);
            MovingFrame<ScalarLane>.Enter(batch);
            if (isMoved)
            {
                batch.ClearHistory();
                FreeMotion<ScalarLane>.Stay(batch);
                RattleStep<ScalarLane>.Rebuild(batch);
            }

            RattleStep<ScalarLane>.ReloadState(batch);
            int stops = _controllers[i].DampedSteps;
            _controllers[i].Advance(dt, tolerance, ref _histories[i], _stills[i], false, isMoved);
            Note(_controllers[i], Islands[i], stops);
            if (_controllers[i].DampedSteps == stops)
            {
                _corrections[i]?.Apply(batch, dt);
            }

            LaneTransfer<ScalarLane>.EndStep(batch);
            batch.Work.Active[0] = 1;
            MovingFrame<ScalarLane>.Leave(batch, dt);
            LaneTransfer<ScalarLane>.Scatter(batch, 1, _mechanism);
            Reactions<ScalarLane>.Report(batch, 1, _mechanism.Reactions, dt, batch.Work.TotalImpulses);
        }
    }

    /// <inheritdoc/>
    public override void Exchange(StateTape tape)
    {
        for (int i = 0; i < Islands.Length; i++)
        {
            Exchange(tape, i);
        }
    }

    /// <inheritdoc/>
    public override void Exchange(StateTape tape, int island)
    {
        _batches[island].Exchange(tape);

        // They stand with the factor, which the next step may take over.
        tape.Array(_batches[island].Work.Response);
        _corrections[island]?.Exchange(tape);
        tape.Value(ref _histories[island]);
    }
}
