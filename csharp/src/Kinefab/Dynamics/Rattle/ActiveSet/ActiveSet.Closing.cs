using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>Hard limits while a pose is closed: which of them take part, and how far they may stand passed.</content>
internal sealed partial class ActiveSet<V>
    where V : struct, ILane<V>
{
    /// <summary>Holds the hard limits that are passed where the rows were last built, and nothing else; writes their J and C.</summary>
    /// <param name="keepsAllowed">Whether a limit may stand passed as far as it was left so.</param>
    public void ActivateViolated(bool keepsAllowed)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.Kind = scalar.IsActive && scalar.Built.IsHardLimit ? RowKind.Limit : RowKind.None;
            double error = ClosingError(scalar, keepsAllowed);
            bool isPassed = scalar.Kind == RowKind.Limit && error < 0;
            scalar.State = isPassed ? RowState.Free : RowState.AtBound;
            _batch.Work.Error[scalar.Index] = isPassed ? error : 0;
        }

        WriteRows(false);
    }

    /// <summary>Lets hard limits stand passed as far as they are where the rows were last built; false where none is.</summary>
    public bool AllowPassed()
    {
        bool isAny = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.Limit.Allowed = scalar.IsActive && scalar.Built.IsHardLimit ? Math.Min(0, scalar.Built.GeometricError) : 0;
            isAny |= scalar.Limit.Allowed < 0;
        }

        return isAny;
    }

    /// <summary>
    /// After a solve for a move that closes the pose, which stands in the bodies' velocities: of the hard limits one that would draw is let go, and one that
    /// the move would pass takes part. True when one changed, so that the move is to be found anew. J and C of the rows are those of the last build.
    /// </summary>
    /// <param name="pass">How often the move was found before.</param>
    /// <param name="impulses">Of all rows.</param>
    /// <param name="keepsAllowed">See <see cref="ActivateViolated"/>.</param>
    public bool UpdateClosing(int pass, double[] impulses, bool keepsAllowed)
    {
        bool isChanged = false;
        for (int i = 0; i < _rows.Length && pass < MaxPasses && !(isChanged && pass >= FreePasses); i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (scalar.Kind != RowKind.Limit)
            {
                continue;
            }

            double error = ClosingError(scalar, keepsAllowed);
            bool isFree = scalar.State == RowState.Free;
            bool holds = isFree ? impulses[scalar.Index] >= 0 : error + Impulses<V>.Speed(_batch, scalar.Block, scalar.Built, false) < 0;
            if (holds != isFree)
            {
                scalar.State = holds ? RowState.Free : RowState.AtBound;
                _batch.Work.Error[scalar.Index] = holds ? error : 0;
                isChanged = true;
            }
        }

        WriteRows(false);
        return isChanged;
    }

    /// <summary>Whether a limit stands passed by more than it was left so: its joint's fields were changed.</summary>
    public bool IsNewlyPassed()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (scalar.IsActive && scalar.Built.IsHardLimit && scalar.Built.GeometricError < scalar.Limit.Allowed - ScalarRow.MostClosedByDrift)
            {
                return true;
            }
        }

        return false;
    }

    private static double ClosingError(in ScalarRow scalar, bool keepsAllowed) => scalar.Built.GeometricError - (keepsAllowed ? scalar.Limit.Allowed : 0);
}
