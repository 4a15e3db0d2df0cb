using System;
using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>What each lane has as the row about the axis of each hinge, decided at the start of a step: by what its joint asks for and where it stands.</summary>
internal sealed class AxisRecords<V>
    where V : struct, ILane<V>
{
    /// <summary>Share of a spring's impulse before the drift, and of a motor's: that of a step that can follow it.</summary>
    public const double Share = 0.5;

    private readonly LaneRecords<V> _batch;

    /// <param name="batch">Whose.</param>
    /// <param name="blocks">The blocks of its hinges that have such a row.</param>
    public AxisRecords(LaneRecords<V> batch, int[] blocks)
    {
        _batch = batch;
        Blocks = blocks;
        Numbers = new double[AxisLanes.Count * blocks.Length * Lane<V>.Width];
        Kinds = new AxisRowKind[blocks.Length * Lane<V>.Width];
        First = new double[blocks.Length * Lane<V>.Width];
    }

    /// <summary>The block of each hinge k.</summary>
    public int[] Blocks { get; }

    /// <summary>A hinge's, from k * AxisLanes.Count * Width on.</summary>
    public double[] Numbers { get; }

    /// <summary>What a lane has as the row of hinge k, at k * Width + lane.</summary>
    public AxisRowKind[] Kinds { get; }

    /// <summary>Its impulse before the last drift, there too, N m s.</summary>
    public double[] First { get; }

    /// <summary>Takes from all lanes what they have as rows; then <see cref="TryBegin"/> gives it to each.</summary>
    public void Clear()
    {
        int w = Lane<V>.Width;
        Array.Clear(Kinds, 0, Kinds.Length);
        for (int k = 0; k < Blocks.Length; k++)
        {
            int o = AxisLanes.Count * k * w;
            Array.Clear(Numbers, o, AxisLanes.Response * w);
            MeasureResponse(k, o);
            HingeTurn<V>.Measure(_batch, Blocks[k], Numbers, o + AxisLanes.StartCosine * w);
        }
    }

    /// <summary>What a lane's hinges ask for in a step, by its momenta at the start pose. False where the lane cannot do it.</summary>
    /// <param name="lane">One whose bodies nobody has moved.</param>
    /// <param name="h">Step, s.</param>
    /// <param name="reach">C up to which a limit counts as reached, radians.</param>
    public bool TryBegin(int lane, double h, double reach)
    {
        int w = Lane<V>.Width;
        for (int k = 0; k < Blocks.Length; k++)
        {
            JointModel joint = _batch.Models[Blocks[k] * w + lane]!;
            RowBlock block = _batch.Shape.Blocks[Blocks[k]];
            bool isReached = block.Watch == WatchForm.Twist && !(HingeRange.LeftOf(joint, joint.LastTwist) > reach);
            bool canGo = block.IsAxisDriven ? !isReached && TryDrive(joint, k, lane, h) : !isReached || TryHold(joint, k, lane);
            if (!canGo)
            {
                return false;
            }

            if (Kinds[k * w + lane] == AxisRowKind.None)
            {
                _batch.VelocityImpulses[RowOf(k) + lane] = 0;
            }
        }

        return true;
    }

    /// <summary>A lane does not take part: its rows are not there.</summary>
    public void Leave(int lane)
    {
        for (int k = 0; k < Blocks.Length; k++)
        {
            Set(k, lane, AxisRowKind.None);
        }
    }

    /// <summary>Whether a lane has a row in this step.</summary>
    public bool HasRow(int lane)
    {
        bool isAny = false;
        for (int i = lane; i < Kinds.Length; i += Lane<V>.Width)
        {
            isAny |= Kinds[i] != AxisRowKind.None;
        }

        return isAny;
    }

    /// <summary>Whether a motor turns a lane's hinge in this step.</summary>
    public bool HasMotor(int lane)
    {
        bool isAny = false;
        for (int i = lane; i < Kinds.Length; i += Lane<V>.Width)
        {
            isAny |= Kinds[i] == AxisRowKind.Motor;
        }

        return isAny;
    }

    /// <summary>Where a hinge's row stands in vectors over all rows.</summary>
    public int RowOf(int k) => (_batch.Shape.Pattern.Rows[Blocks[k]] + _batch.Shape.Blocks[Blocks[k]].BilateralCount) * Lane<V>.Width;

    /// <summary>A number of hinge k in all lanes.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane<V> Load(int k, int slot) => Lane<V>.Load(Numbers, (AxisLanes.Count * k + slot) * Lane<V>.Width);

    private bool TryDrive(JointModel joint, int k, int lane, double h)
    {
        HingeDrive drive = HingeDrive.Of(joint);
        int w = Lane<V>.Width;
        int o = AxisLanes.Count * k * w + lane;
        double response = Numbers[o + AxisLanes.Response * w];
        if (!drive.IsLinear || !(response > ScalarRow.LeastResponse))
        {
            return false;
        }

        double scale = joint.DriveLimitsAreForces ? h : 1;
        double low = scale * drive.Minimum, high = scale * drive.Maximum;
        int row = RowOf(k) + lane;
        double guess = _batch.VelocityImpulses[row];
        Set(k, lane, drive.IsSpring ? AxisRowKind.Spring : AxisRowKind.Motor);
        Numbers[o + AxisLanes.Target * w] = drive.VelocityTarget;
        if (drive.IsSpring)
        {
            var law = new SpringLaw(drive.Gains, drive.VelocityTarget, drive.Error, h, response, false);
            if (law.CorrectionGain > 0)
            {
                return false;
            }

            guess = First[k * w + lane];
            Numbers[o + AxisLanes.Target * w] = law.RestImpulse / law.ImplicitDamping;
            Numbers[o + AxisLanes.Compliance * w] = 1 / (law.Theta * law.ImplicitDamping);
        }

        Numbers[o + AxisLanes.Low * w] = low;
        Numbers[o + AxisLanes.High * w] = high;
        _batch.VelocityImpulses[row] = guess;
        return guess > Share * low && guess < Share * high;
    }

    // A hinge that was held in the last step rests on the same end in this one; the first step on it, and a blow, are made alone.
    private bool TryHold(JointModel joint, int k, int lane)
    {
        int w = Lane<V>.Width;
        int o = AxisLanes.Count * k * w + lane;
        ref readonly AngularLimit limit = ref HingeRange.Of(joint);
        double impulse = _batch.VelocityImpulses[RowOf(k) + lane];
        bool isUpper = limit.Upper - joint.LastTwist < joint.LastTwist - limit.Lower;
        double end = isUpper ? limit.Upper : limit.Lower;

        // C grows with the turn at the lower end and falls with it at the upper.
        double inward = isUpper ? Numbers[o + AxisLanes.Speed * w] : -Numbers[o + AxisLanes.Speed * w];
        bool isBlow = limit.Response.Bounces(-inward);
        if (limit.Response.IsSoft || isBlow || !(isUpper ? impulse > 0 : impulse < 0) || !(Math.Abs(end - joint.LastTwist) <= ScalarRow.MostClosedByDrift))
        {
            return false;
        }

        Set(k, lane, AxisRowKind.Limit);
        if (Numbers[o + AxisLanes.End * w] != end || Numbers[o + AxisLanes.EndCosine * w] == 0)
        {
            Numbers[o + AxisLanes.End * w] = end;
            Numbers[o + AxisLanes.EndCosine * w] = Trigonometry.Cos(end);
            Numbers[o + AxisLanes.EndSine * w] = Trigonometry.Sin(end);
        }

        Numbers[o + AxisLanes.Low * w] = isUpper ? 0 : double.NegativeInfinity;
        Numbers[o + AxisLanes.High * w] = isUpper ? double.PositiveInfinity : 0;
        return true;
    }

    private void Set(int k, int lane, AxisRowKind kind)
    {
        int w = Lane<V>.Width;
        int o = AxisLanes.Count * k * w + lane;
        Kinds[k * w + lane] = kind;
        Numbers[o + AxisLanes.IsRow * w] = kind == AxisRowKind.None ? 0 : 1;
        Numbers[o + AxisLanes.IsSpring * w] = kind == AxisRowKind.Spring ? 1 : 0;
        Numbers[o + AxisLanes.IsMotor * w] = kind == AxisRowKind.Motor ? 1 : 0;
    }

    // J M^-1 J^T and J v at the start pose.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private void MeasureResponse(int k, int o)
    {
        int n = Blocks[k];
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

        response.Store(Numbers, o, AxisLanes.Response);
        speed.Store(Numbers, o, AxisLanes.Speed);
    }
}
