using System;
using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>What a lane has as its row about a hinge's axis.</summary>
internal enum AxisRowKind : byte
{
    /// <summary>Nothing.</summary>
    None,

    /// <summary>A speed held within bounds of torque.</summary>
    Motor,

    /// <summary>The end of its range that the hinge rests on.</summary>
    Limit,

    /// <summary>A spring that the step can follow.</summary>
    Spring,
}

/// <summary>
/// One row about the axis of each hinge that has a drive or limits, in lanes, J = (0, x; 0, -x), whose speed is that of the turn reversed: a spring, a
/// motor, or the end of a limit that the hinge rests on. The same steps as the active set's, of a row that stays free; a lane of which one
/// reaches its bound, or whose hinge has more than one row to obey, is to leave the lanes for that step.
/// </summary>
internal sealed class AxisRows<V>
    where V : struct, ILane<V>
{
    // Share of a spring's impulse before the drift, and of a motor's: that of a step that can follow it.
    private const double Share = 0.5;

    // Compliance of a spring in the projection, in which it does not answer: what is left of an impulse is below rounding.
    private const double Endless = 1e40;

    // Numbers of a row, each Width lanes wide. The first three are masks: where a lane has a row, where that is a spring, and where it is a motor.
    private const int IsRow = 0;
    private const int IsSpring = 1;
    private const int IsMotor = 2;
    private const int Target = 3;
    private const int Compliance = 4;
    private const int Low = 5;
    private const int High = 6;
    private const int Response = 7;
    private const int Speed = 8;
    private const int StartCosine = 9;
    private const int StartSine = 10;
    private const int Cosine = 11;
    private const int Sine = 12;
    private const int End = 13;
    private const int EndCosine = 14;
    private const int EndSine = 15;
    private const int Turn = 16;
    private const int Count = 17;

    private readonly LaneRecords<V> _batch;
    private readonly int[] _blocks;
    private readonly double[] _numbers;

    // What each lane has as the row, number k of it at k * Width + lane; that of the factored matrix, and impulses before the last drift.
    private readonly AxisRowKind[] _kinds;
    private readonly AxisRowKind[] _factored;
    private readonly double[] _first;

    private AxisRows(LaneRecords<V> batch, int[] blocks)
    {
        _batch = batch;
        _blocks = blocks;
        _numbers = new double[Count * blocks.Length * Lane<V>.Width];
        _kinds = new AxisRowKind[blocks.Length * Lane<V>.Width];
        _factored = new AxisRowKind[_kinds.Length];
        _first = new double[blocks.Length * Lane<V>.Width];
    }

    /// <summary>Those of a batch; null without any.</summary>
    public static AxisRows<V>? Of(LaneRecords<V> batch)
    {
        RowBlock[] blocks = batch.Shape.Blocks;
        int[] all = Array.FindAll(System.Linq.Enumerable.ToArray(System.Linq.Enumerable.Range(0, blocks.Length)), n => blocks[n].HasAxisRow);
        return all.Length == 0 ? null : new AxisRows<V>(batch, all);
    }

    /// <summary>Takes from all lanes what they have as rows; then <see cref="TryBegin"/> gives it to each.</summary>
    public void Clear()
    {
        int w = Lane<V>.Width;
        Array.Clear(_kinds, 0, _kinds.Length);
        for (int k = 0; k < _blocks.Length; k++)
        {
            int o = Count * k * w;
            Array.Clear(_numbers, o, Response * w);
            MeasureResponse(k, o);
            HingeTurn<V>.Measure(_batch, _blocks[k], _numbers, o + StartCosine * w);
        }
    }

    /// <summary>What a lane's hinges ask for in a step, by its momenta at the start pose. False where the lane cannot do it.</summary>
    /// <param name="lane">One whose bodies nobody has moved.</param>
    /// <param name="h">Step, s.</param>
    /// <param name="reach">C up to which a limit counts as reached, radians.</param>
    public bool TryBegin(int lane, double h, double reach)
    {
        int w = Lane<V>.Width;
        for (int k = 0; k < _blocks.Length; k++)
        {
            JointModel joint = _batch.Models[_blocks[k] * w + lane]!;
            RowBlock block = _batch.Shape.Blocks[_blocks[k]];
            bool isReached = block.Watch == WatchForm.Twist && !(HingeRange.LeftOf(joint, joint.LastTwist) > reach);
            bool canGo = block.IsAxisDriven ? !isReached && TryDrive(joint, k, lane, h) : !isReached || TryHold(joint, k, lane);
            if (!canGo)
            {
                return false;
            }

            if (_kinds[k * w + lane] == AxisRowKind.None)
            {
                _batch.VelocityImpulses[RowOf(k) + lane] = 0;
            }
        }

        return true;
    }

    /// <summary>A lane does not take part: its rows are not there.</summary>
    public void Leave(int lane)
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            Set(k, lane, AxisRowKind.None);
        }
    }

    /// <summary>Whether the matrix is that of the drift: of the same rows, and no spring is to act.</summary>
    public bool IsFactoredForDrift()
    {
        for (int i = 0; i < _kinds.Length; i++)
        {
            if (_kinds[i] == AxisRowKind.Spring || _kinds[i] != _factored[i])
            {
                return false;
            }
        }

        return true;
    }

    /// <summary>Whether a lane has a spring, for which the matrix is wanted again in the drift.</summary>
    public bool HasSprings() => Array.IndexOf(_kinds, AxisRowKind.Spring) >= 0;

    /// <summary>Whether the kept matrix has the same rows as the drift: but for what springs have on the diagonal it is the drift's.</summary>
    public bool IsKeptForDrift()
    {
        bool isKept = false;
        for (int i = 0; i < _kinds.Length; i++)
        {
            isKept |= _factored[i] == AxisRowKind.Spring;
            if (_kinds[i] != _factored[i])
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
            Lane<V> compliance = isDrift ? Load(k, Compliance) : Lane<V>.Splat(Endless);
            Lane<V> diagonal = Lane<V>.Load(_batch.Matrix, cell);
            Lane<V> held = Lane<V>.Select(Load(k, IsSpring), diagonal + compliance, diagonal * Lane<V>.Splat(1 + ScalarRow.RigidShare));
            Lane<V>.Select(Load(k, IsRow), held, one).Store(_batch.Matrix, cell);
        }

        Array.Copy(_kinds, _factored, _kinds.Length);
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
            int o = Count * k * w + lane;
            double impulse = _batch.Work.PositionImpulses[RowOf(k) + lane];
            isFree &= _kinds[k * w + lane] == AxisRowKind.None || (impulse >= Share * _numbers[o + Low * w] && impulse <= Share * _numbers[o + High * w]);
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
            int row = RowOf(k);
            Lane<V> target = Lane<V>.Select(Load(k, IsMotor), Load(k, Target), zero);
            Lane<V> speed = Lane<V>.Load(_batch.Work.Solution, row) + target;
            Lane<V>.Select(Load(k, IsSpring), zero, Lane<V>.Select(Load(k, IsRow), speed, zero)).Store(_batch.Work.Solution, row);
        }
    }

    /// <summary>Whether the impulses of a lane's projection are within their bounds.</summary>
    public bool HasFreeProjection(int lane)
    {
        int w = Lane<V>.Width;
        bool isFree = true;
        for (int k = 0; k < _blocks.Length; k++)
        {
            int o = Count * k * w + lane;
            double impulse = _batch.VelocityImpulses[RowOf(k) + lane];
            AxisRowKind kind = _kinds[k * w + lane];
            isFree &= kind != AxisRowKind.Motor || (impulse >= (1 - Share) * _numbers[o + Low * w] && impulse <= (1 - Share) * _numbers[o + High * w]);

            // What pushed the joint back out of its stop on the way is no speed to leave it with.
            double sum = impulse + _batch.Work.PositionImpulses[RowOf(k) + lane];
            isFree &= kind != AxisRowKind.Limit || (sum >= _numbers[o + Low * w] && sum <= _numbers[o + High * w]);
        }

        return isFree;
    }

    /// <summary>Whether a lane has a row in this step.</summary>
    public bool HasRow(int lane)
    {
        bool isAny = false;
        for (int i = lane; i < _kinds.Length; i += Lane<V>.Width)
        {
            isAny |= _kinds[i] != AxisRowKind.None;
        }

        return isAny;
    }

    /// <summary>Whether a motor turns a lane's hinge in this step.</summary>
    public bool HasMotor(int lane)
    {
        bool isAny = false;
        for (int i = lane; i < _kinds.Length; i += Lane<V>.Width)
        {
            isAny |= _kinds[i] == AxisRowKind.Motor;
        }

        return isAny;
    }

    /// <summary>What the drives gave in the step: a spring its impulse along the drift, a motor its own at its speed, J.</summary>
    public Lane<V> Work(double h)
    {
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> sum = zero;
        for (int k = 0; k < _blocks.Length; k++)
        {
            Lane<V> spring = Lane<V>.Splat(-1 / (Share * h)) * Lane<V>.Load(_batch.Work.PositionImpulses, RowOf(k)) * Load(k, Turn);
            Lane<V> motor = Lane<V>.Load(_batch.Work.TotalImpulses, RowOf(k)) * Load(k, Target);
            sum += Lane<V>.Select(Load(k, IsSpring), spring, Lane<V>.Select(Load(k, IsMotor), motor, zero));
        }

        return sum;
    }

    /// <summary>Where a step of a lane ends that kept to the lanes.</summary>
    public void Finish(int lane)
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            _first[k * Lane<V>.Width + lane] = _batch.Work.PositionImpulses[RowOf(k) + lane];
        }
    }

    /// <summary>A lane's rows have no impulse to begin the next step with.</summary>
    public void Forget(int lane)
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            _first[k * Lane<V>.Width + lane] = 0;
            _batch.VelocityImpulses[RowOf(k) + lane] = 0;
        }
    }

    /// <summary>Torque on body 0 of the limit that a lane's hinge rests on, in the whole step, over its axis; 0 without one.</summary>
    public double LimitImpulse(int block, int lane, double[] impulses)
    {
        int k = Array.IndexOf(_blocks, block);
        return k >= 0 && _kinds[k * Lane<V>.Width + lane] == AxisRowKind.Limit ? impulses[RowOf(k) + lane] : 0;
    }

    /// <summary>Gives a lane's impulses to the rows of the same hinges of an island that is to step alone.</summary>
    public void HandOver(int lane, LaneRecords<ScalarLane> to)
    {
        for (int k = 0; k < _blocks.Length; k++)
        {
            RowBlock block = to.Shape.Blocks[_blocks[k]];
            int first = to.Scalars!.First(_blocks[k]);
            double impulse = _batch.VelocityImpulses[RowOf(k) + lane];
            if (block.Drives > 0)
            {
                ref ScalarRow drive = ref to.Scalars.Rows[first];
                double sign = Orientation(_batch.Models[_blocks[k] * Lane<V>.Width + lane]!);
                drive.ImpulseFirstHalf = sign * _first[k * Lane<V>.Width + lane];
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
            int at = RowOf(k) + lane;
            if (block.Drives > 0)
            {
                ref ScalarRow drive = ref from.Scalars.Rows[first];
                double sign = Orientation(_batch.Models[_blocks[k] * Lane<V>.Width + lane]!);
                _first[k * Lane<V>.Width + lane] = sign * drive.ImpulseFirstHalf;
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
        tape.Array(_first);
    }

    /// <summary>The same of one lane.</summary>
    public void Exchange(StateTape tape, int lane)
    {
        tape.Lane(_factored, lane, Lane<V>.Width);
        tape.Lane(_first, lane, Lane<V>.Width);
    }

    // A motor's row is about the axis reversed.
    private static double Orientation(JointModel joint) => joint is RevoluteJoint { MotorEnabled: true } ? -1 : 1;

    private int RowOf(int k) => (_batch.Shape.Pattern.Rows[_blocks[k]] + _batch.Shape.Blocks[_blocks[k]].BilateralCount) * Lane<V>.Width;

    private bool TryDrive(JointModel joint, int k, int lane, double h)
    {
        HingeDrive drive = HingeDrive.Of(joint);
        int w = Lane<V>.Width;
        int o = Count * k * w + lane;
        double response = _numbers[o + Response * w];
        if (!drive.IsLinear || !(response > ScalarRow.LeastResponse))
        {
            return false;
        }

        double scale = joint.DriveLimitsAreForces ? h : 1;
        double low = scale * drive.Minimum, high = scale * drive.Maximum;
        int row = RowOf(k) + lane;
        double guess = _batch.VelocityImpulses[row];
        Set(k, lane, drive.IsSpring ? AxisRowKind.Spring : AxisRowKind.Motor);
        _numbers[o + Target * w] = drive.VelocityTarget;
        if (drive.IsSpring)
        {
            var law = new SpringLaw(drive.Gains, drive.VelocityTarget, drive.Error, h, response, false);
            if (law.CorrectionGain > 0)
            {
                return false;
            }

            guess = _first[k * w + lane];
            _numbers[o + Target * w] = law.RestImpulse / law.ImplicitDamping;
            _numbers[o + Compliance * w] = 1 / (law.Theta * law.ImplicitDamping);
        }

        _numbers[o + Low * w] = low;
        _numbers[o + High * w] = high;
        _batch.VelocityImpulses[row] = guess;
        return guess > Share * low && guess < Share * high;
    }

    // A hinge that was held in the last step rests on the same end in this one; the first step on it, and a blow, are made alone.
    private bool TryHold(JointModel joint, int k, int lane)
    {
        int w = Lane<V>.Width;
        int o = Count * k * w + lane;
        ref readonly AngularLimit limit = ref HingeRange.Of(joint);
        double impulse = _batch.VelocityImpulses[RowOf(k) + lane];
        bool isUpper = limit.Upper - joint.LastTwist < joint.LastTwist - limit.Lower;
        double end = isUpper ? limit.Upper : limit.Lower;

        // C grows with the turn at the lower end and falls with it at the upper.
        double inward = isUpper ? _numbers[o + Speed * w] : -_numbers[o + Speed * w];
        bool isBlow = limit.Response.Bounces(-inward);
        if (limit.Response.IsSoft || isBlow || !(isUpper ? impulse > 0 : impulse < 0) || !(Math.Abs(end - joint.LastTwist) <= ScalarRow.MostClosedByDrift))
        {
            return false;
        }

        Set(k, lane, AxisRowKind.Limit);
        if (_numbers[o + End * w] != end || _numbers[o + EndCosine * w] == 0)
        {
            _numbers[o + End * w] = end;
            _numbers[o + EndCosine * w] = Trigonometry.Cos(end);
            _numbers[o + EndSine * w] = Trigonometry.Sin(end);
        }

        _numbers[o + Low * w] = isUpper ? 0 : double.NegativeInfinity;
        _numbers[o + High * w] = isUpper ? double.PositiveInfinity : 0;
        return true;
    }

    private void Set(int k, int lane, AxisRowKind kind)
    {
        int w = Lane<V>.Width;
        int o = Count * k * w + lane;
        _kinds[k * w + lane] = kind;
        _numbers[o + IsRow * w] = kind == AxisRowKind.None ? 0 : 1;
        _numbers[o + IsSpring * w] = kind == AxisRowKind.Spring ? 1 : 0;
        _numbers[o + IsMotor * w] = kind == AxisRowKind.Motor ? 1 : 0;
    }

    private Lane<V> Load(int k, int slot) => Lane<V>.Load(_numbers, (Count * k + slot) * Lane<V>.Width);

    // J M^-1 J^T and J v at the start pose.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private void MeasureResponse(int k, int o)
    {
        int n = _blocks[k];
        LaneVector<V> axis = HingeTurn<V>.Axis(_batch, n);
        Lane<V> response = Lane<V>.Splat(0);
        Lane<V> speed = response;
        for (int side = 0; side < 2; side++)
        {
            int body = _batch.Shape.Blocks[n].Bodies[side];
            int at = LaneRecords<V>.Body(body, 0);
            Lane<V> rate = Lane<V>.Splat(0);
            if (body < _batch.Shape.MovingBodies)
            {
                LaneVector<V> turned = LaneVector<V>.Transform(_batch.Bodies, at, BodyLanes.WorldInverse, axis);
                response += LaneVector<V>.Dot(axis, turned);
                rate = LaneVector<V>.Dot(turned, LaneVector<V>.Load(_batch.Bodies, at, BodyLanes.L));
            }
            else if (!_batch.Shape.IsStatic[body])
            {
                rate = LaneVector<V>.Dot(axis, LaneVector<V>.Load(_batch.Bodies, at, BodyLanes.W));
            }

            speed = side == 0 ? speed + rate : speed - rate;
        }

        response.Store(_numbers, o, Response);
        speed.Store(_numbers, o, Speed);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private void WriteRow(int k)
    {
        int n = _blocks[k];
        Lane<V> zero = Lane<V>.Splat(0);
        LaneVector<V> axis = LaneVector<V>.Select(Load(k, IsRow), HingeTurn<V>.Axis(_batch, n), new LaneVector<V>(zero, zero, zero));
        int o = _batch.Row(n, _batch.Shape.Blocks[n].BilateralCount, 0);
        axis.Store(_batch.Angular, o);
        (-axis).Store(_batch.Angular, o, 3);
    }

    // Of a drive its speed in the drift, the turn over the step, against its own: a motor's, or what a spring's impulse leaves it.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private void EvaluateDrive(int k, double h)
    {
        int row = RowOf(k);
        HingeTurn<V>.Measure(_batch, _blocks[k], _numbers, (Count * k + Cosine) * Lane<V>.Width);
        Lane<V> c0 = Load(k, StartCosine), s0 = Load(k, StartSine), c1 = Load(k, Cosine), s1 = Load(k, Sine);
        Lane<V> two = Lane<V>.Splat(2);
        Lane<V> turn = two * LaneTrigonometry<V>.Atan((s1 * c0 - c1 * s0) / (Lane<V>.Splat(1) + (c1 * c0 + s1 * s0)));
        turn.Store(_numbers, (Count * k + Turn) * Lane<V>.Width);
        Lane<V> rest = Load(k, Compliance) * Lane<V>.Load(_batch.Work.PositionImpulses, row) - Load(k, Target);
        Lane<V>.Select(Load(k, IsRow), Lane<V>.Splat(h) * rest - turn, Lane<V>.Splat(0)).Store(_batch.Work.Error, row);
    }

    // Of a limit the sine of what the turn is short of its end.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private void EvaluateLimit(int k)
    {
        HingeTurn<V>.Measure(_batch, _blocks[k], _numbers, (Count * k + Cosine) * Lane<V>.Width);
        Lane<V> left = Load(k, EndSine) * Load(k, Cosine) - Load(k, EndCosine) * Load(k, Sine);
        Lane<V>.Select(Load(k, IsRow), left, Lane<V>.Splat(0)).Store(_batch.Work.Error, RowOf(k));
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private void GiveRest(int k)
    {
        int n = _blocks[k];
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> gives = Lane<V>.Select(Load(k, IsSpring), Lane<V>.Load(_batch.Work.Active, 0), zero);
        Lane<V> impulse = Lane<V>.Select(gives, Lane<V>.Splat((1 - Share) / Share) * Lane<V>.Load(_batch.Work.PositionImpulses, RowOf(k)), zero);
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
