using System;
using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// One row about the axis of each hinge that has a drive or limits, in lanes, J = (0, x; 0, -x), whose speed is that of the turn reversed: a spring, a
/// motor, or the end of a limit that the hinge rests on. The same steps as the active set's, of a row that stays free; a lane of which one
/// reaches its bound, or whose hinge has more than one row to obey, is to leave the lanes for that step.
/// </summary>
internal sealed class AxisRows<V>
    where V : struct, ILane<V>
{
    // Compliance of a spring in the projection, in which it does not answer: what is left of an impulse is below rounding.
    private const double Endless = 1e40;

    private readonly LaneRecords<V> _batch;
    private readonly AxisRecords<V> _records;
    private readonly int[] _blocks;

    // What the factored matrix has of each row.
    private readonly AxisRowKind[] _factored;

    private AxisRows(LaneRecords<V> batch, int[] blocks)
    {
        _batch = batch;
        _records = new AxisRecords<V>(batch, blocks);
        _blocks = blocks;
        _factored = new AxisRowKind[_records.Kinds.Length];
    }

    /// <summary>Those of a batch; null without any.</summary>
    public static AxisRows<V>? Of(LaneRecords<V> batch)
    {
        RowBlock[] blocks = batch.Shape.Blocks;
        int[] all = Array.FindAll(System.Linq.Enumerable.ToArray(System.Linq.Enumerable.Range(0, blocks.Length)), n => blocks[n].HasAxisRow);
        return all.Length == 0 ? null : new AxisRows<V>(batch, all);
    }

    /// <inheritdoc cref="AxisRecords{V}.Clear"/>
    public void Clear() => _records.Clear();

    /// <inheritdoc cref="AxisRecords{V}.TryBegin"/>
    public bool TryBegin(int lane, double h, double reach) => _records.TryBegin(lane, h, reach);

    /// <inheritdoc cref="AxisRecords{V}.Leave"/>
    public void Leave(int lane) => _records.Leave(lane);

    /// <inheritdoc cref="AxisRecords{V}.HasRow"/>
    public bool HasRow(int lane) => _records.HasRow(lane);

    /// <inheritdoc cref="AxisRecords{V}.HasMotor"/>
    public bool HasMotor(int lane) => _records.HasMotor(lane);

    /// <summary>Whether the matrix is that of the drift: of the same rows, and no spring is to act.</summary>
    public bool IsFactoredForDrift()
    {
        for (int i = 0; i < _records.Kinds.Length; i++)
        {
            if (_records.Kinds[i] == AxisRowKind.Spring || _records.Kinds[i] != _factored[i])
            {
                return false;
            }
        }

        return true;
    }

    /// <summary>Whether a lane has a spring, for which the matrix is wanted again in the drift.</summary>
    public bool HasSprings() => Array.IndexOf(_records.Kinds, AxisRowKind.Spring) >= 0;

    /// <summary>Whether the kept matrix has the same rows as the drift: but for what springs have on the diagonal it is the drift's.</summary>
    public bool IsKeptForDrift()
    {
        bool isKept = false;
        for (int i = 0; i < _records.Kinds.Length; i++)
        {
            isKept |= _factored[i] == AxisRowKind.Spring;
            if (_records.Kinds[i] != _factored[i])
            {
                return false;
            }
        }

        return isKept;
    }

    /// <summary>J of the rows where the frames were last placed, 0 where there is none.</summary>
    public void WriteRows()
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            WriteRow(k);
        }
    }

    /// <summary>The rows' part of the diagonal of the assembled matrix.</summary>
    /// <param name="isDrift">Springs answer in the drift alone.</param>
    public void AddToDiagonal(bool isDrift)
    {
        int w = Lane<V>.Width;
        Lane<V> one = Lane<V>.Splat(1);
        for (int k = 0; k < _blocks.Length; k++)
        {
            int n = _blocks[k];
            int cell = (_batch.Shape.Pattern.Diagonal(n) + _batch.Shape.Blocks[n].BilateralCount * (_batch.Shape.Blocks[n].Rows + 1)) * w;
            Lane<V> compliance = isDrift ? _records.Load(k, AxisLanes.Compliance) : Lane<V>.Splat(Endless);
            Lane<V> diagonal = Lane<V>.Load(_batch.Matrix, cell);
            Lane<V> held = Lane<V>.Select(_records.Load(k, AxisLanes.IsSpring), diagonal + compliance, diagonal * Lane<V>.Splat(1 + ScalarRow.RigidShare));
            Lane<V>.Select(_records.Load(k, AxisLanes.IsRow), held, one).Store(_batch.Matrix, cell);
        }

        Array.Copy(_records.Kinds, _factored, _records.Kinds.Length);
    }

    /// <summary>Residuals of the rows at the end of the drift as errors, radians.</summary>
    public void Evaluate(double h)
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            if (_batch.Shape.Blocks[_blocks[k]].IsAxisDriven)
            {
                EvaluateDrive(k, h);
            }
            else
            {
                EvaluateLimit(k);
            }
        }
    }

    /// <summary>Whether the impulses of a lane's drift are within their bounds.</summary>
    public bool HasFreeDrift(int lane)
    {
        int w = Lane<V>.Width;
        bool isFree = true;
        for (int k = 0; k < _blocks.Length; k++)
        {
            int o = AxisLanes.Count * k * w + lane;
            double impulse = _batch.Work.PositionImpulses[_records.RowOf(k) + lane];
            double low = AxisRecords<V>.Share * _records.Numbers[o + AxisLanes.Low * w], high = AxisRecords<V>.Share * _records.Numbers[o + AxisLanes.High * w];
            isFree &= _records.Kinds[k * w + lane] == AxisRowKind.None || (impulse >= low && impulse <= high);
        }

        return isFree;
    }

    /// <summary>At the end pose: gives springs the rest of their impulse, in the active lanes.</summary>
    public void BeginVelocities()
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            GiveRest(k);
        }
    }

    /// <summary>Adds the speeds that the rows shall have to the right-hand side of the projection.</summary>
    public void AddTargets()
    {
        Lane<V> zero = Lane<V>.Splat(0);
        for (int k = 0; k < _blocks.Length; k++)
        {
            int row = _records.RowOf(k);
            Lane<V> target = Lane<V>.Select(_records.Load(k, AxisLanes.IsMotor), _records.Load(k, AxisLanes.Target), zero);
            Lane<V> speed = Lane<V>.Load(_batch.Work.Solution, row) + target;
            Lane<V>.Select(_records.Load(k, AxisLanes.IsSpring), zero, Lane<V>.Select(_records.Load(k, AxisLanes.IsRow), speed, zero)).Store(_batch.Work.Solution, row);
        }
    }

    /// <summary>Whether the impulses of a lane's projection are within their bounds.</summary>
    public bool HasFreeProjection(int lane)
    {
        int w = Lane<V>.Width;
        bool isFree = true;
        for (int k = 0; k < _blocks.Length; k++)
        {
            int o = AxisLanes.Count * k * w + lane;
            double impulse = _batch.VelocityImpulses[_records.RowOf(k) + lane];
            AxisRowKind kind = _records.Kinds[k * w + lane];
            const double share = 1 - AxisRecords<V>.Share;
            double low = share * _records.Numbers[o + AxisLanes.Low * w], high = share * _records.Numbers[o + AxisLanes.High * w];
            isFree &= kind != AxisRowKind.Motor || (impulse >= low && impulse <= high);

            // What pushed the joint back out of its stop on the way is no speed to leave it with.
            double sum = impulse + _batch.Work.PositionImpulses[_records.RowOf(k) + lane];
            isFree &= kind != AxisRowKind.Limit || (sum >= _records.Numbers[o + AxisLanes.Low * w] && sum <= _records.Numbers[o + AxisLanes.High * w]);
        }

        return isFree;
    }

    /// <summary>What the drives gave in the step: a spring its impulse along the drift, a motor its own at its speed, J.</summary>
    public Lane<V> Work(double h)
    {
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> sum = zero;
        for (int k = 0; k < _blocks.Length; k++)
        {
            Lane<V> spring = Lane<V>.Splat(-1 / (AxisRecords<V>.Share * h)) * Lane<V>.Load(_batch.Work.PositionImpulses, _records.RowOf(k)) * _records.Load(k, AxisLanes.Turn);
            Lane<V> motor = Lane<V>.Load(_batch.Work.TotalImpulses, _records.RowOf(k)) * _records.Load(k, AxisLanes.Target);
            sum += Lane<V>.Select(_records.Load(k, AxisLanes.IsSpring), spring, Lane<V>.Select(_records.Load(k, AxisLanes.IsMotor), motor, zero));
        }

        return sum;
    }

    /// <summary>Where a step of a lane ends that kept to the lanes.</summary>
    public void Finish(int lane)
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            _records.First[k * Lane<V>.Width + lane] = _batch.Work.PositionImpulses[_records.RowOf(k) + lane];
        }
    }

    /// <summary>A lane's rows have no impulse to begin the next step with.</summary>
    public void Forget(int lane)
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            _records.First[k * Lane<V>.Width + lane] = 0;
            _batch.VelocityImpulses[_records.RowOf(k) + lane] = 0;
        }
    }

    /// <summary>Torque on body 0 of the limit that a lane's hinge rests on, in the whole step, over its axis; 0 without one.</summary>
    public double LimitImpulse(int block, int lane, double[] impulses)
    {
        int k = Array.IndexOf(_blocks, block);
        return k >= 0 && _records.Kinds[k * Lane<V>.Width + lane] == AxisRowKind.Limit ? impulses[_records.RowOf(k) + lane] : 0;
    }

    /// <summary>Gives a lane's impulses to the rows of the same hinges of an island that is to step alone.</summary>
    public void HandOver(int lane, LaneRecords<ScalarLane> to)
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            RowBlock block = to.Shape.Blocks[_blocks[k]];
            int first = to.Scalars!.First(_blocks[k]);
            double impulse = _batch.VelocityImpulses[_records.RowOf(k) + lane];
            if (block.Drives > 0)
            {
                ref ScalarRow drive = ref to.Scalars.Rows[first];
                double sign = Orientation(_batch.Models[_blocks[k] * Lane<V>.Width + lane]!);
                drive.ImpulseFirstHalf = sign * _records.First[k * Lane<V>.Width + lane];
                to.VelocityImpulses[drive.Index] = sign * impulse;
            }
            else if (impulse != 0)
            {
                // The lower end's row is reversed.
                to.VelocityImpulses[to.Scalars.Rows[impulse < 0 ? first : first + 1].Index] = Math.Abs(impulse);
            }
        }
    }

    /// <summary>Takes them back after the step.</summary>
    public void TakeOver(int lane, LaneRecords<ScalarLane> from)
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            RowBlock block = from.Shape.Blocks[_blocks[k]];
            int first = from.Scalars!.First(_blocks[k]);
            int at = _records.RowOf(k) + lane;
            if (block.Drives > 0)
            {
                ref ScalarRow drive = ref from.Scalars.Rows[first];
                double sign = Orientation(_batch.Models[_blocks[k] * Lane<V>.Width + lane]!);
                _records.First[k * Lane<V>.Width + lane] = sign * drive.ImpulseFirstHalf;
                _batch.VelocityImpulses[at] = sign * from.VelocityImpulses[drive.Index];
            }
            else
            {
                _batch.VelocityImpulses[at] = from.VelocityImpulses[from.Scalars.Rows[first + 1].Index] - from.VelocityImpulses[from.Scalars.Rows[first].Index];
            }
        }
    }

    /// <summary>What the next step takes from those before it.</summary>
    public void Exchange(StateTape tape)
    {
        tape.Array(_factored);
        tape.Array(_records.First);
    }

    /// <summary>The same of one lane.</summary>
    public void Exchange(StateTape tape, int lane)
    {
        tape.Lane(_factored, lane, Lane<V>.Width);
        tape.Lane(_records.First, lane, Lane<V>.Width);
    }

    // A motor's row is about the axis reversed.
    private static double Orientation(JointModel joint) => joint is RevoluteJoint { MotorEnabled: true } ? -1 : 1;

    [MethodImpl(MethodImplOptions.NoInlining)]
    private void WriteRow(int k)
    {
        int n = _blocks[k];
        Lane<V> zero = Lane<V>.Splat(0);
        LaneVector<V> axis = LaneVector<V>.Select(_records.Load(k, AxisLanes.IsRow), HingeTurn<V>.Axis(_batch, n), new LaneVector<V>(zero, zero, zero));
        int o = _batch.Row(n, _batch.Shape.Blocks[n].BilateralCount, 0);
        axis.Store(_batch.Angular, o);
        (-axis).Store(_batch.Angular, o, 3);
    }

    // Of a drive its speed in the drift, the turn over the step, against its own: a motor's, or what a spring's impulse leaves it.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private void EvaluateDrive(int k, double h)
    {
        int row = _records.RowOf(k);
        HingeTurn<V>.Measure(_batch, _blocks[k], _records.Numbers, (AxisLanes.Count * k + AxisLanes.Cosine) * Lane<V>.Width);
        Lane<V> c0 = _records.Load(k, AxisLanes.StartCosine), s0 = _records.Load(k, AxisLanes.StartSine), c1 = _records.Load(k, AxisLanes.Cosine), s1 = _records.Load(k, AxisLanes.Sine);
        Lane<V> two = Lane<V>.Splat(2);
        Lane<V> turn = two * LaneTrigonometry<V>.Atan((s1 * c0 - c1 * s0) / (Lane<V>.Splat(1) + (c1 * c0 + s1 * s0)));
        turn.Store(_records.Numbers, (AxisLanes.Count * k + AxisLanes.Turn) * Lane<V>.Width);
        Lane<V> rest = _records.Load(k, AxisLanes.Compliance) * Lane<V>.Load(_batch.Work.PositionImpulses, row) - _records.Load(k, AxisLanes.Target);
        Lane<V>.Select(_records.Load(k, AxisLanes.IsRow), Lane<V>.Splat(h) * rest - turn, Lane<V>.Splat(0)).Store(_batch.Work.Error, row);
    }

    // Of a limit the sine of what the turn is short of its end.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private void EvaluateLimit(int k)
    {
        HingeTurn<V>.Measure(_batch, _blocks[k], _records.Numbers, (AxisLanes.Count * k + AxisLanes.Cosine) * Lane<V>.Width);
        Lane<V> left = _records.Load(k, AxisLanes.EndSine) * _records.Load(k, AxisLanes.Cosine) - _records.Load(k, AxisLanes.EndCosine) * _records.Load(k, AxisLanes.Sine);
        Lane<V>.Select(_records.Load(k, AxisLanes.IsRow), left, Lane<V>.Splat(0)).Store(_batch.Work.Error, _records.RowOf(k));
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private void GiveRest(int k)
    {
        int n = _blocks[k];
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> gives = Lane<V>.Select(_records.Load(k, AxisLanes.IsSpring), Lane<V>.Load(_batch.Work.Active, 0), zero);
        Lane<V> impulse = Lane<V>.Select(gives, Lane<V>.Splat((1 - AxisRecords<V>.Share) / AxisRecords<V>.Share) * Lane<V>.Load(_batch.Work.PositionImpulses, _records.RowOf(k)), zero);
        LaneVector<V> turn = impulse * HingeTurn<V>.Axis(_batch, n);
        for (int side = 0; side < 2; side++)
        {
            int body = _batch.Shape.Blocks[n].Bodies[side];
            if (body < _batch.Shape.MovingBodies)
            {
                int at = LaneRecords<V>.Body(body, 0);
                LaneVector<V> momentum = LaneVector<V>.Load(_batch.Bodies, at, BodyLanes.L);
                (side == 0 ? momentum + turn : momentum - turn).Store(_batch.Bodies, at, BodyLanes.L);
            }
        }
    }
}
