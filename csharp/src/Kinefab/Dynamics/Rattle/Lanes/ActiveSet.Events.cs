using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>Hard limits that the joint comes to on its way: how far they are, and the blow when they are reached.</content>
internal sealed partial class ActiveSet<V>
    where V : struct, ILane<V>
{
    /// <summary>The least C at the end of the drift of the limits that were not reached at its start, m or rad; infinite without one.</summary>
    public double NearestApart()
    {
        double least = double.PositiveInfinity;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            bool isOne = scalar.IsApart && scalar.HasEnd && IsHardLimit(scalar.End);
            least = isOne ? Math.Min(least, scalar.End.GeometricError) : least;
        }

        return least;
    }

    /// <summary>The same at its start, of those that have a row there.</summary>
    public double NearestApartAtStart()
    {
        double least = double.PositiveInfinity;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            least = scalar.IsApart && scalar.IsActive ? Math.Min(least, scalar.StartError) : least;
        }

        return least;
    }

    /// <summary>
    /// At the end pose, with momenta that satisfy all other rows: holds the limits that are reached there, each with its speed before the blow.
    /// Springs and motors of finite force give nothing in no time. False when the drift came to no limit.
    /// </summary>
    /// <param name="reach">C up to which a limit counts as reached, m or rad.</param>
    public bool BeginImpact(double reach)
    {
        bool isAny = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            isAny |= scalar.IsApart && scalar.IsActive && IsHardLimit(scalar.Built) && scalar.Built.GeometricError <= reach;
        }

        for (int i = 0; i < _rows.Length && isAny; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            _batch.VelocityImpulses[scalar.Index] = 0;
            scalar.ImpulseSecondHalf = 0;
            bool isLimit = scalar.IsActive && IsHardLimit(scalar.Built);
            if (isLimit)
            {
                scalar.Kind = RowKind.Limit;
                scalar.IsApart = false;
                scalar.ImpulseFirstHalf = 0;
                scalar.StartSpeed = StartSpeed(scalar);
                scalar.State = scalar.Built.GeometricError - scalar.Allowed <= reach ? RowState.Free : RowState.AtBound;
            }
            else if (scalar.Kind != RowKind.SpeedMotor || !double.IsInfinity(scalar.Low) || !double.IsInfinity(scalar.High))
            {
                scalar.State = RowState.AtBound;
            }
        }

        return isAny;
    }

    private static bool IsHardLimit(in ConstraintRow row) => row.Has(RowFlags.Limit) && !row.Has(RowFlags.Spring);
}
