using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Islands with scalar rows or other prepared rows, one at a time.</summary>
internal sealed class ScalarIslandGroup : IslandGroup
{
    private readonly MultibodySystem _mechanism;
    private readonly Island[] _islands;
    private readonly LaneBatch<ScalarLane>[] _batches;
    private readonly StepController[] _controllers;
    private readonly StiffSpringCorrection?[] _corrections;
    private readonly SubstepHistory[] _histories;
    private readonly Standstill[] _stills;

    public ScalarIslandGroup(MultibodySystem mechanism, List<Island> islands)
    {
        _mechanism = mechanism;
        _islands = islands.ToArray();
        _batches = new LaneBatch<ScalarLane>[_islands.Length];
        _controllers = new StepController[_islands.Length];
        _corrections = new StiffSpringCorrection?[_islands.Length];
        _histories = new SubstepHistory[_islands.Length];
        _stills = Array.ConvertAll(_islands, _ => new Standstill());
        for (int i = 0; i < _islands.Length; i++)
        {
            _islands[i].Order(mechanism.Cancellation);
            _batches[i] = new LaneBatch<ScalarLane>(_islands[i], new Workspace<ScalarLane>(_islands[i]));
            _controllers[i] = new StepController(_batches[i]);
            _corrections[i] = _islands[i].ScalarCount > 0 ? new StiffSpringCorrection(_islands[i], mechanism.Bodies) : null;
            LaneTransfer<ScalarLane>.GatherConstants(_batches[i], 0, _islands[i], mechanism);
        }
    }

    /// <inheritdoc/>
    public override void Step(double dt, double tolerance, bool areReactionsAwaited)
    {
        for (int i = 0; i < _islands.Length; i++)
        {
            LaneBatch<ScalarLane> batch = _batches[i];
            _corrections[i]?.Undo();
            bool isMoved = LaneTransfer<ScalarLane>.Gather(batch, _mechanism, dt);
            LaneTransfer<ScalarLane>.BeginStep(batch);
            if (isMoved)
            {
                batch.ClearHistory();
                FreeMotion<ScalarLane>.Stay(batch);
                RattleStep<ScalarLane>.Rebuild(batch);
            }

            RattleStep<ScalarLane>.ReloadState(batch);
            int stops = _controllers[i].DampedSteps;
            _controllers[i].Advance(dt, tolerance, ref _histories[i], _stills[i], false, isMoved);
            Note(_controllers[i], _islands[i], stops);
            if (_controllers[i].DampedSteps == stops)
            {
                _corrections[i]?.Apply(batch, dt);
            }

            LaneTransfer<ScalarLane>.EndStep(batch);
            batch.Work.Active[0] = 1;
            LaneTransfer<ScalarLane>.Scatter(batch, 1, _mechanism);
            Reactions<ScalarLane>.Report(batch, 1, _mechanism.Reactions, dt, batch.Work.TotalImpulses);
        }
    }

    /// <inheritdoc/>
    public override void Exchange(StateTape tape)
    {
        for (int i = 0; i < _batches.Length; i++)
        {
            _batches[i].Exchange(tape);
            _corrections[i]?.Exchange(tape);
        }

        tape.Array(_histories);
    }
}
