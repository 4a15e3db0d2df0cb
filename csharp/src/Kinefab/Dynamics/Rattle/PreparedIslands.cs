using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Islands with laws or other prepared rows, one at a time.</summary>
internal sealed class PreparedIslands : IslandGroup
{
    private readonly MultibodySystem _mechanism;
    private readonly Island[] _islands;
    private readonly Batch<ScalarLane>[] _batches;
    private readonly Ladder[] _ladders;
    private readonly SpringAnswer?[] _answers;
    private readonly StepCut[] _cuts;

    public PreparedIslands(MultibodySystem mechanism, List<Island> islands)
    {
        _mechanism = mechanism;
        _islands = islands.ToArray();
        _batches = new Batch<ScalarLane>[_islands.Length];
        _ladders = new Ladder[_islands.Length];
        _answers = new SpringAnswer?[_islands.Length];
        _cuts = new StepCut[_islands.Length];
        for (int i = 0; i < _islands.Length; i++)
        {
            _batches[i] = new Batch<ScalarLane>(_islands[i], new Workspace<ScalarLane>(_islands[i]));
            _ladders[i] = new Ladder(_batches[i]);
            _answers[i] = _islands[i].Laws > 0 ? new SpringAnswer(_batches[i], mechanism.Bodies) : null;
            Transfer<ScalarLane>.LoadConstants(_batches[i], 0, _islands[i], mechanism);
        }
    }

    /// <inheritdoc/>
    public override void Step(double dt, double tolerance)
    {
        for (int i = 0; i < _islands.Length; i++)
        {
            Batch<ScalarLane> batch = _batches[i];
            _answers[i]?.TakeBack();
            bool isMoved = Transfer<ScalarLane>.Load(batch, _mechanism, dt);
            Transfer<ScalarLane>.Start(batch);
            if (isMoved)
            {
                batch.ClearHistory();
                Flight<ScalarLane>.Stay(batch);
                RattleStep<ScalarLane>.Rebuild(batch);
            }

            RattleStep<ScalarLane>.Reread(batch);
            int stops = _ladders[i].Stops;
            _ladders[i].Step(dt, tolerance, ref _cuts[i], false, isMoved);
            Note(_mechanism, _ladders[i], _islands[i], stops);
            if (_ladders[i].Stops == stops)
            {
                _answers[i]?.Give();
            }

            Transfer<ScalarLane>.Finish(batch);
            Transfer<ScalarLane>.Store(batch, 1, _mechanism);
            Reactions<ScalarLane>.Report(batch, 1, _mechanism, dt);
            foreach (Node node in _islands[i].Nodes)
            {
                if (node.Coupling != null)
                {
                    PreparedRows<ScalarLane>.FinishCoupling(batch, node);
                }
            }
        }
    }

    /// <inheritdoc/>
    public override void Exchange(StateTape tape)
    {
        for (int i = 0; i < _batches.Length; i++)
        {
            _batches[i].Exchange(tape);
            _answers[i]?.Exchange(tape);
        }

        tape.Array(_cuts);
    }
}
