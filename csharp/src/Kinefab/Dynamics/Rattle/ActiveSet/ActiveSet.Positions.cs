using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>The scalar rows in the drift: their residuals at its end, and which rows leave their state.</content>
internal sealed partial class ActiveSet<V>
    where V : struct, ILane<V>
{
    // Of what a drive without limit of force may need, so much is a row that runs away.
    private const double MostBeyond = 10;

    /// <summary>Residuals of the scalar rows at the end of the drift as errors, m or rad.</summary>
    public void Evaluate(double h)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            double error = 0;
            scalar.ImpulseFirstHalf = _batch.Work.PositionImpulses[scalar.Index];
            if (scalar.State == RowState.Free)
            {
                error = scalar.Kind switch
                {
                    RowKind.Limit => scalar.End.GeometricError - scalar.Limit.Allowed,
                    RowKind.Motion => scalar.Ahead,
                    RowKind.SpeedMotor => h * (DriftSpeed(scalar) - scalar.Built.VelocityTarget),
                    _ => h * (SpringSpeed(scalar) + (scalar.ImpulseFirstHalf / scalar.Theta - scalar.Spring.Law.RestImpulse) / scalar.Spring.Law.ImplicitDamping),
                };
            }

            _batch.Work.Error[scalar.Index] = error;
        }
    }

    /// <summary>
    /// The share of a move of the drift's impulses that leads to the first bound of a row; 1 where it leads beyond none. Of rows that nearly depend on each
    /// other, whose impulses grow without end before they agree, one has to give way, and what the move makes of the others is that of its not giving way.
    /// </summary>
    /// <param name="move">Of all rows.</param>
    /// <param name="first">The row; -1: none. Where moves before this one led rows beyond their bounds, the one that came to its bound first.</param>
    public double ShareOfMove(double[] move, out int first)
    {
        double least = 1;
        first = -1;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (scalar.State != RowState.Free || move[scalar.Index] == 0)
            {
                continue;
            }

            double bound = scalar.Theta * (move[scalar.Index] > 0 ? scalar.High : scalar.Low);
            double share = (bound - _batch.Work.PositionImpulses[scalar.Index]) / move[scalar.Index];
            if (share < least)
            {
                least = share;
                first = i;
            }
        }

        return Math.Max(0, least);
    }

    /// <summary>Whether a drive without limit of force that was not slowed down ran away in the step: what holds it is worth a look, see <see cref="HeldDrives"/>.</summary>
    public bool HasRunAway { get; private set; }

    /// <summary>Whether a move leads a drive without limit of force far beyond what no mechanism needs: rows that nearly depend on each other.</summary>
    /// <param name="move">Of all rows.</param>
    public bool RunsAway(double[] move)
    {
        bool isAny = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (scalar.State != RowState.Free || !scalar.AsksForSpeed || !scalar.IsEndless)
            {
                continue;
            }

            double impulse = _batch.Work.PositionImpulses[scalar.Index] + move[scalar.Index];
            if (impulse > MostBeyond * scalar.Theta * scalar.High || impulse < MostBeyond * scalar.Theta * scalar.Low)
            {
                isAny = true;
                HasRunAway |= scalar.Pace.Slowdowns == 0;
            }
        }

        return isAny;
    }

    /// <summary>Holds a row at the bound to which a move led it.</summary>
    public void HoldAtBound(int index)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].PendingImpulse = 0;
        }

        ref ScalarRow scalar = ref _rows[index];
        scalar.ImpulseFirstHalf = _batch.Work.PositionImpulses[scalar.Index];
        HoldAtBound(ref scalar, scalar.ImpulseFirstHalf > scalar.Theta * (scalar.Low + scalar.High) / 2);
    }

    /// <summary>
    /// Whether the end of the drift passed a hard limit that it was to hold: one that had no row at its start, of a distance or cone in the
    /// middle; one whose row no impulse could hold; or one of an angle that turned so far that no pose tells how often it went round.
    /// </summary>
    /// <param name="h">Length of the drift, s.</param>
    /// <param name="tolerance">Largest C, m or rad.</param>
    public bool HasMissedEvent(double h, double tolerance)
    {
        if (HasTurnedFar(h))
        {
            return true;
        }

        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            double allowed = scalar.IsActive ? scalar.Limit.Allowed : 0;
            if (!scalar.Limit.IsApart && scalar.HasEnd && scalar.End.IsHardLimit && scalar.End.GeometricError - allowed < -MostPassed * tolerance)
            {
                return true;
            }
        }

        return false;
    }

    /// <summary>Whether an angle with limits turned so far in the drift that no pose tells how often it went round.</summary>
    /// <param name="h">Length of the drift, s.</param>
    public bool HasTurnedFar(double h)
    {
        const double mostTurn = 2.5;
        bool isFar = false;
        for (int i = 0; i < _rows.Length && !isFar; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            bool isAngle = scalar.IsActive && scalar.HasEnd && scalar.Built.Has(RowFlags.Limit) && scalar.Built.Has(RowFlags.Angular);
            isFar = isAngle && !(Math.Abs(DriftSpeed(scalar)) * h < mostTurn);
        }

        return isFar;
    }

    /// <summary>Gives the momenta what the last <see cref="UpdatePositions"/> changed of the impulses.</summary>
    public void ApplyPending()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            if (_rows[i].PendingImpulse != 0)
            {
                Impulses<V>.ApplyRow(_batch, _rows[i].Block, _rows[i].Built, _rows[i].PendingImpulse);
                _rows[i].PendingImpulse = 0;
            }
        }
    }

    /// <summary>
    /// Moves rows that have left their state; true when one had to. Where the states come round again, one row at a time moves from then on; where
    /// they do so once more, a limit that draws while it is held and is passed while it is not is left by its joint and come back to within
    /// the drift: it is apart, see <see cref="LimitEvent.IsLeft"/>.
    /// </summary>
    public bool UpdatePositions(int pass, double tolerance)
    {
        if (pass == 0)
        {
            _seenCount = 0;
            _movesAll = true;
        }

        if (pass == MaxPasses)
        {
            return false;
        }

        ulong states = States();
        bool isSeen = Array.IndexOf(_seen, states, 0, _seenCount) >= 0;
        _seen[_seenCount++] = states;
        if (isSeen)
        {
            _seenCount = 0;
            if (!_movesAll)
            {
                return LeaveLimits(tolerance);
            }

            _movesAll = false;
        }

        bool isChanged = false;
        for (int i = 0; i < _rows.Length && (_movesAll || !isChanged); i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.PendingImpulse = 0;
            if (scalar.Kind == RowKind.None)
            {
                continue;
            }

            if (scalar.State == RowState.Free)
            {
                isChanged |= ClampToBounds(ref scalar);
            }
            else if (LeavesBound(scalar, scalar.BoundShare * scalar.Low, scalar.BoundShare * scalar.High, tolerance))
            {
                scalar.State = RowState.Free;
                isChanged = true;
            }
        }

        return isChanged;
    }

    // Which rows act; two sets with the same number are taken for the same.
    private ulong States()
    {
        ulong number = 0;
        for (int i = 0; i < _rows.Length; i++)
        {
            number = number * 0x9E3779B97F4A7C15 + (_rows[i].State == RowState.Free ? 1UL : 2UL);
        }

        return number;
    }

    private bool LeaveLimits(double tolerance)
    {
        bool isAny = false;
        for (int i = 0; i < _rows.Length && LocatesEvents; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.PendingImpulse = 0;
            if (scalar.Kind == RowKind.Limit && scalar.Limit.Allowed == 0 && scalar.Limit.HasDrawn && scalar.State == RowState.AtBound && LeavesBound(scalar, 0, 0, tolerance))
            {
                scalar.Limit.IsLeft = true;
                scalar.Limit.IsApart = true;
                isAny = true;
            }
        }

        return isAny;
    }

    private bool LeavesBound(in ScalarRow scalar, double low, double high, double tolerance)
    {
        switch (scalar.Kind)
        {
            case RowKind.Limit:
                return !scalar.Limit.IsApart && scalar.End.GeometricError - scalar.Limit.Allowed < -tolerance;
            case RowKind.SpeedMotor:
                double excess = DriftSpeed(scalar) - scalar.Built.VelocityTarget;
                return (scalar.ImpulseFirstHalf >= high && excess > tolerance) || (scalar.ImpulseFirstHalf <= low && excess < -tolerance);
            case RowKind.Motion:
                double ahead = scalar.Ahead;
                return (scalar.ImpulseFirstHalf >= high && ahead > tolerance) || (scalar.ImpulseFirstHalf <= low && ahead < -tolerance);
            default:
                double wanted = scalar.Spring.Law.RestImpulse - scalar.Spring.Law.ImplicitDamping * SpringSpeed(scalar);
                double slack = scalar.Spring.Law.ImplicitDamping * tolerance;
                return (scalar.ImpulseFirstHalf >= high && wanted < scalar.High - slack) || (scalar.ImpulseFirstHalf <= low && wanted > scalar.Low + slack);
        }
    }

    private bool ClampToBounds(ref ScalarRow scalar)
    {
        bool isAbove = scalar.ImpulseFirstHalf > scalar.Theta * scalar.High;
        if (!isAbove && !(scalar.ImpulseFirstHalf < scalar.Theta * scalar.Low))
        {
            return false;
        }

        HoldAtBound(ref scalar, isAbove);
        return true;
    }

    private void HoldAtBound(ref ScalarRow scalar, bool isAbove)
    {
        double impulse = scalar.BoundShare * (isAbove ? scalar.High : scalar.Low);
        scalar.Limit.HasDrawn = scalar.Kind == RowKind.Limit;
        scalar.PendingImpulse = impulse - scalar.ImpulseFirstHalf;
        scalar.ImpulseFirstHalf = impulse;
        scalar.State = RowState.AtBound;
        _batch.Work.PositionImpulses[scalar.Index] = impulse;
    }
}
