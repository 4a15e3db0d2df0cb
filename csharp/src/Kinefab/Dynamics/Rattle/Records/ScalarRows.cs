using Kinefab.Joints;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The scalar rows of one island: as their joints write them, with what they keep from step to step. Which of them act is the active set's.
/// </summary>
internal sealed class ScalarRows
{
    private readonly Island _shape;
    private readonly ScalarRow[] _rows;
    private readonly int[] _first;
    private bool _isFactored;

    public ScalarRows(Island shape)
    {
        _shape = shape;
        _rows = new ScalarRow[shape.ScalarCount];
        _first = new int[shape.Blocks.Length];
        int next = 0;
        for (int n = 0; n < _first.Length; n++)
        {
            RowBlock block = shape.Blocks[n];
            _first[n] = next;
            for (int i = 0; i < block.ScalarCount; i++)
            {
                int blockRow = block.BilateralCount + i;
                _rows[next++] = new ScalarRow { Block = n, BlockRow = blockRow, Index = shape.Pattern.Rows[n] + blockRow };
            }
        }
    }

    /// <summary>All rows, those of a block side by side.</summary>
    public ScalarRow[] Rows => _rows;

    /// <summary>Whether the matrix is that of the rows as they stand now, held as their <see cref="ScalarRow.ProjectedAs"/> says.</summary>
    public bool IsFactored
    {
        get => _isFactored;
        set => _isFactored = value;
    }

    /// <summary>Index of a block's first row.</summary>
    public int First(int block) => _first[block];

    /// <summary>Before a block's rows are written: it has none yet.</summary>
    public void Clear(int block)
    {
        int end = _first[block] + _shape.Blocks[block].ScalarCount;
        for (int i = _first[block]; i < end; i++)
        {
            _rows[i].IsActive = false;
        }
    }

    /// <summary>A block's row as Prepare wrote it.</summary>
    public void Set(int block, int slot, in ConstraintRow row)
    {
        ref ScalarRow scalar = ref _rows[_first[block] + slot];
        scalar.IsActive = true;
        _isFactored &= scalar.ProjectedAs == ProjectedAs.Inactive || row.HasJacobianOf(scalar.Built);
        scalar.Built = row;
        scalar.Pace.Slow(ref scalar.Built);
    }

    /// <summary>The bodies have moved or the matrix was changed: it is to be assembled anew.</summary>
    public void Invalidate() => _isFactored = false;

    /// <summary>Before a block's rows at the end of the drift are written.</summary>
    public void ClearEndRows(int block)
    {
        int end = _first[block] + _shape.Blocks[block].ScalarCount;
        for (int i = _first[block]; i < end; i++)
        {
            _rows[i].HasEnd = false;
        }
    }

    /// <summary>A block's row at the end of the drift.</summary>
    public void SetEndRow(int block, int slot, in ConstraintRow row)
    {
        ref ScalarRow scalar = ref _rows[_first[block] + slot];
        scalar.HasEnd = true;
        scalar.End = row;
        scalar.Pace.Slow(ref scalar.End);
    }

    /// <summary>A block's rows at the end of the drift as those of the pose that is built.</summary>
    public void AdoptEndRows(int block)
    {
        int end = _first[block] + _shape.Blocks[block].ScalarCount;
        for (int i = _first[block]; i < end; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.IsActive = scalar.HasEnd;
            if (scalar.HasEnd)
            {
                scalar.Built = scalar.End;
            }
        }
    }

    /// <summary>Forgets impulses and states.</summary>
    public void ClearHistory()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].ImpulseFirstHalf = 0;
            _rows[i].ImpulseSecondHalf = 0;
            _rows[i].State = RowState.AtBound;
            _rows[i].Limit.Allowed = 0;
        }
    }

    /// <summary>Impulses of a step of another length as a guess.</summary>
    public void ScaleHistory(double factor)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].ImpulseFirstHalf *= factor;
        }
    }

    /// <summary>Nothing is known of steps before, as of another island.</summary>
    public void Reset()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i] = new ScalarRow { Block = _rows[i].Block, BlockRow = _rows[i].BlockRow, Index = _rows[i].Index };
        }
    }

    /// <summary>What the next step takes from those before it.</summary>
    public void Exchange(StateTape tape)
    {
        tape.Array(_rows);
        tape.Value(ref _isFactored);
    }

    /// <summary>Keeps, or brings back, impulses, states and the account of work.</summary>
    public void Save(WarmStart[] to)
    {
        for (int i = 0; i < to.Length; i++)
        {
            to[i] = new WarmStart(_rows[i]);
        }
    }

    public void Restore(WarmStart[] from)
    {
        for (int i = 0; i < from.Length; i++)
        {
            _rows[i].ImpulseFirstHalf = from[i].ImpulseFirstHalf;
            _rows[i].State = from[i].State;
            _rows[i].Spring.Work = from[i].Work;
        }

        Invalidate();
    }
}
