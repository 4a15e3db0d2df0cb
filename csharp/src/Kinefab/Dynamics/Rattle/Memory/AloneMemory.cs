using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>What an island that now and then leaves the lanes has to remember of the last step that it made alone: its scalar rows.</summary>
internal sealed class AloneMemory
{
    private readonly ScalarRow[] _rows;
    private readonly double[] _impulses;
    private readonly StiffSpringCorrection _correction;
    private bool _wasAlone;

    public AloneMemory(Island island, Bodies bodies)
    {
        _rows = new ScalarRow[island.ScalarCount];
        _impulses = new double[island.RowCount];
        _correction = new StiffSpringCorrection(island, bodies);
    }

    /// <summary>Takes back, before a step is loaded, what the last one only showed.</summary>
    public void UndoShown() => _correction.Undo();

    /// <summary>The island made a step in lanes: no limit acted.</summary>
    public void Forget() => _wasAlone = false;

    /// <summary>Gives a batch its scalar rows and impulses as they stood, where the last step was made alone.</summary>
    public bool TryRestore(LaneBatch<ScalarLane> batch)
    {
        if (_wasAlone)
        {
            Array.Copy(_rows, batch.Scalars!.Rows, _rows.Length);
            Array.Copy(_impulses, batch.VelocityImpulses, _impulses.Length);
        }

        return _wasAlone;
    }

    /// <summary>Where a step that was made alone ends.</summary>
    /// <param name="batch">At its end.</param>
    /// <param name="dt">Step, s.</param>
    /// <param name="isSolved">Whether no part of it stood still.</param>
    public void Save(LaneBatch<ScalarLane> batch, double dt, bool isSolved)
    {
        if (isSolved)
        {
            _correction.Apply(batch, dt);
        }

        Array.Copy(batch.Scalars!.Rows, _rows, _rows.Length);
        Array.Copy(batch.VelocityImpulses, _impulses, _impulses.Length);
        _wasAlone = true;
    }

    /// <summary>What the next step takes from those before it.</summary>
    public void Exchange(StateTape tape)
    {
        tape.Array(_rows);
        tape.Array(_impulses);
        tape.Value(ref _wasAlone);
        _correction.Exchange(tape);
    }
}
