using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>Hard limits that the joint comes to on its way: how far they are, and the blow when they are reached.</content>
internal sealed partial class ActiveSet<V>
    where V : struct, ILane<V>
{
    // Speed, m/s or rad/s, against which a row's is nothing.
    private const double Least = 1e-10;

    /// <summary>The least C at the end of the drift of the limits, hard and soft, that were not reached at its start, m or rad; infinite without one.</summary>
    public double NearestApart()
    {
        double least = double.PositiveInfinity;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            bool isOne = scalar.Limit.IsApart && scalar.HasEnd && scalar.End.Has(RowFlags.Limit);
            least = isOne ? Math.Min(least, scalar.End.GeometricError) : least;
        }

        return least;
    }

    /// <summary>Of these limits the one that is passed at the end of the drift and was reached first, as far as can be told; -1 where none is.</summary>
    /// <param name="h">Length of the drift, s.</param>
    public int FirstReached(double h)
    {
        int first = -1;
        double soonest = double.PositiveInfinity;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            bool isOne = scalar.Limit.IsApart && scalar.HasEnd && scalar.End.Has(RowFlags.Limit) && scalar.End.GeometricError < 0;
            double at = isOne ? scalar.ReachedAt(h) : double.PositiveInfinity;
            if (isOne && (first < 0 || at < soonest))
            {
                soonest = at;
                first = i;
            }
        }

        return first;
    }

    /// <summary>Whether a limit is to be left in the drift, see <see cref="LimitEvent.IsLeft"/>.</summary>
    public bool HasLeft() => Array.Exists(_rows, row => row.Limit.IsLeft);

    /// <summary>A part begins: nothing is known of the last blow of any limit.</summary>
    public void BeginPart()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].Limit.Flight = double.PositiveInfinity;
        }
    }

    /// <summary>A piece of a part begins: no limit is left yet.</summary>
    /// <param name="left">Longest that it may be, s.</param>
    public void BeginPiece(double left)
    {
        _left = left;
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].Limit.IsLeft = false;
            _rows[i].Limit.IsHeldBack = false;
        }
    }

    /// <summary>
    /// Where no drift is short enough not to pass a limit: holds it from the piece's start on, where its joint is thrown back and comes to it again at once, as
    /// where a drive without limit of force pushes it, or so soon that bounces have died out. False where it is another.
    /// </summary>
    /// <param name="index">The row's.</param>
    /// <param name="isAny">Whether any hard limit is held so: a joint that is thrown back by a stiff damper, or moved by closing other rows.</param>
    /// <param name="isSpent">Whether it is passed so soon that a limit which is struck again then is at rest.</param>
    /// <param name="tolerance">Largest C, m or rad.</param>
    public bool HoldBack(int index, bool isAny, bool isSpent, double tolerance)
    {
        ref ScalarRow scalar = ref _rows[index];
        bool hardlyLeaves = scalar.StartError <= Reach * tolerance && IsThrownBack(scalar, tolerance) && (isSpent || HasEndless());
        bool isOne = (isAny || hardlyLeaves) && scalar.IsActive && scalar.Built.IsHardLimit && !scalar.Limit.IsLeft && !scalar.Limit.IsHeldBack;
        scalar.Limit.IsHeldBack |= isOne;
        return isOne;
    }

    /// <summary>
    /// At the end pose, with momenta that satisfy all other rows: holds the limits that are reached there, each with its speed before the blow.
    /// Springs and motors of finite force give nothing in no time. False when the drift came to no limit.
    /// </summary>
    /// <param name="reach">C up to which a limit counts as reached, m or rad.</param>
    /// <param name="piece">Length of the drift, s.</param>
    /// <param name="leastFlight">A limit that was struck on the same side less than this time ago throws nothing back: bounces that die out come to rest, s.</param>
    public bool BeginImpact(double reach, double piece, double leastFlight)
    {
        bool isAny = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            bool wasReached = scalar.StartError <= reach;
            scalar.Limit.Flight = (wasReached ? 0 : scalar.Limit.Flight) + piece;
            isAny |= scalar.Limit.IsApart && scalar.IsActive && scalar.Built.IsHardLimit && scalar.Built.GeometricError <= reach;
        }

        _isBlow = isAny;
        for (int i = 0; i < _rows.Length && isAny; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            _batch.VelocityImpulses[scalar.Index] = 0;
            scalar.ImpulseSecondHalf = 0;
            bool isLimit = scalar.IsActive && scalar.Built.IsHardLimit;
            if (isLimit)
            {
                bool isSpent = scalar.Limit.IsApart && scalar.Limit.Flight < leastFlight && Vector3d.Dot(scalar.Built.Linear0, scalar.Limit.LeftAlong) >= 0;
                scalar.Kind = RowKind.Limit;
                scalar.Limit.IsApart = false;
                scalar.ImpulseFirstHalf = 0;
                scalar.StartSpeed = isSpent ? 0 : StartSpeed(scalar);
                scalar.State = scalar.IsReached(reach) ? RowState.Free : RowState.AtBound;
            }
            else if (scalar.AsksForSpeed && scalar.HoldsThroughBlows && !scalar.Drive.IsHeld)
            {
                // One that stalls pushes back at once what would throw it back.
                scalar.StartSpeed = StartSpeed(scalar);
                scalar.State = RowState.Free;
            }
            else
            {
                scalar.State = RowState.AtBound;
            }
        }

        return isAny;
    }

    /// <summary>As <see cref="BeginImpact"/> without a blow: limits that are reached are left at rest, whatever the joint came with.</summary>
    public void BeginRest(double reach)
    {
        _isBlow = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.Kind = scalar.FindKind(0);
            scalar.Limit.IsApart = false;
            scalar.ImpulseFirstHalf = 0;
            scalar.ImpulseSecondHalf = 0;
            scalar.StartSpeed = 0;
            scalar.Spring.CorrectionSpeed = double.NaN;
            _batch.VelocityImpulses[scalar.Index] = 0;
            scalar.State = scalar.Kind == RowKind.Limit && scalar.IsReached(reach) ? RowState.Free : RowState.AtBound;
        }
    }

    /// <summary>
    /// Adds to the right-hand side at the start pose the speeds that the free rows shall have: a limit may be reached within the step, a motor's is
    /// its own, a spring's what its impulse leaves it.
    /// </summary>
    public void AddStepTargets(double h)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            _batch.Work.Solution[scalar.Index] = scalar.State == RowState.AtBound ? 0 : _batch.Work.Solution[scalar.Index] + scalar.Kind switch
            {
                RowKind.Limit => -Math.Max(0, scalar.StartError) / h,
                RowKind.SpeedMotor => scalar.Built.VelocityTarget,
                RowKind.Motion => (scalar.EndError - scalar.StartError) / h,
                _ => (scalar.Spring.Law.RestImpulse - _batch.Work.PositionImpulses[scalar.Index]) / scalar.Spring.Law.ImplicitDamping,
            };
        }
    }

    /// <summary>After a solve with them: moves rows that left their state; true when one had to.</summary>
    public bool UpdateStep(double h, int pass)
    {
        bool isChanged = false;
        for (int i = 0; i < _rows.Length && pass < MaxPasses && !(isChanged && pass >= FreePasses); i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.PendingImpulse = 0;
            if (scalar.Kind == RowKind.None)
            {
                continue;
            }

            scalar.ImpulseFirstHalf = _batch.Work.PositionImpulses[scalar.Index];
            if (scalar.State == RowState.Free)
            {
                isChanged |= ClampToBounds(ref scalar);
                continue;
            }

            double speed = StartSpeed(scalar);
            double slack = Least * (1 + Math.Abs(scalar.StartSpeed));
            double wanted = scalar.Kind switch
            {
                RowKind.Spring => (scalar.Spring.Law.RestImpulse - scalar.ImpulseFirstHalf) / scalar.Spring.Law.ImplicitDamping,
                RowKind.Motion => (scalar.EndError - scalar.StartError) / h,
                _ => scalar.Built.VelocityTarget,
            } - speed;
            bool leaves = scalar.Kind == RowKind.Limit
                ? speed + Math.Max(0, scalar.StartError) / h < -slack
                : (scalar.ImpulseFirstHalf >= scalar.High && wanted < -slack) || (scalar.ImpulseFirstHalf <= scalar.Low && wanted > slack);
            scalar.State = leaves ? RowState.Free : scalar.State;
            isChanged |= leaves;
        }

        return isChanged;
    }
}
