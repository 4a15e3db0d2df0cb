using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>The scalar rows in the projection of the momenta at the end pose: what holds there, and with which speed.</content>
internal sealed partial class ActiveSet<V>
    where V : struct, ILane<V>
{
    /// <summary>At the end pose: gives springs the rest of their impulse and finds which rows the projection may hold.</summary>
    public void BeginVelocities(double tolerance)
    {
        _isBlow = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            _batch.VelocityImpulses[scalar.Index] = 0;
            scalar.ImpulseSecondHalf = 0;
            scalar.Drive.IsStalled = scalar.Drive.IsHeld ? scalar.IsActive && !IsMoved(scalar, tolerance)
                : scalar.AsksForSpeed && scalar.State == RowState.AtBound && scalar.IsEndless;
            if (!scalar.IsActive || scalar.Kind == RowKind.None)
            {
                scalar.State = RowState.AtBound;
                continue;
            }

            switch (scalar.Kind)
            {
                case RowKind.Spring:
                    SetSecondHalf(ref scalar);
                    scalar.Spring.CorrectionSpeed = scalar.State == RowState.Free ? (scalar.Spring.Law.RestImpulse - scalar.ImpulseFirstHalf / scalar.Theta) / scalar.Spring.Law.ImplicitDamping : double.NaN;
                    scalar.State = RowState.AtBound;
                    break;
                case RowKind.SpeedMotor:
                case RowKind.Motion:
                    if (scalar.Theta == 1)
                    {
                        scalar.State = RowState.AtBound;
                    }
                    else if (scalar.State == RowState.AtBound)
                    {
                        SetImpulseSecondHalf(ref scalar, scalar.ImpulseFirstHalf);
                    }

                    break;
                default:
                    scalar.State = !scalar.Limit.IsApart && scalar.IsReached(tolerance) ? RowState.Free : RowState.AtBound;
                    break;
            }
        }
    }

    /// <summary>Adds the speeds that the free rows shall have to the right-hand side of the projection.</summary>
    public void AddTargets()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (scalar.State == RowState.Free)
            {
                _batch.Work.Solution[scalar.Index] += TargetSpeed(scalar);
            }
            else
            {
                _batch.Work.Solution[scalar.Index] = 0;
            }
        }
    }

    /// <summary>After a solve of the projection: moves rows that left their state; true when one had to.</summary>
    public bool UpdateVelocities(int pass, double tolerance)
    {
        bool isChanged = false;
        for (int i = 0; i < _rows.Length && pass < MaxPasses && !(isChanged && pass >= FreePasses); i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (!scalar.IsActive || scalar.Kind == RowKind.None || scalar.Kind == RowKind.Spring)
            {
                continue;
            }

            if (scalar.State == RowState.Free)
            {
                scalar.ImpulseSecondHalf = _batch.VelocityImpulses[scalar.Index];
                double low = scalar.Low * (1 - scalar.Theta);
                double high = scalar.High * (1 - scalar.Theta);
                if (scalar.Kind == RowKind.Limit)
                {
                    // What pushed the joint back out of its stop on the way is no speed to leave it with.
                    low = -scalar.ImpulseFirstHalf;
                    high = double.PositiveInfinity;
                }
                else if (_isBlow)
                {
                    // What it takes.
                    low = double.NegativeInfinity;
                    high = double.PositiveInfinity;
                }

                if (scalar.ImpulseSecondHalf < low || scalar.ImpulseSecondHalf > high)
                {
                    SetImpulseSecondHalf(ref scalar, scalar.ImpulseSecondHalf < low ? low : high);
                    scalar.State = RowState.AtBound;
                    isChanged = true;
                }
            }
            else if (scalar.Kind == RowKind.Limit && !scalar.Limit.IsApart && scalar.IsReached(tolerance)
                && Impulses<V>.Speed(_batch, scalar.Block, scalar.Built) < TargetSpeed(scalar) - tolerance)
            {
                scalar.State = RowState.Free;
                isChanged = true;
            }
        }

        return isChanged;
    }

    /// <summary>Lets springs answer in the projected momenta; false when none has to.</summary>
    public bool BeginCorrection()
    {
        bool isAny = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (scalar.IsActive && scalar.Kind == RowKind.Spring && scalar.Spring.Law.CorrectionGain > 0 && !double.IsNaN(scalar.Spring.CorrectionSpeed))
            {
                scalar.State = RowState.Free;
                isAny = true;
            }
        }

        return isAny;
    }

    /// <summary>Takes from the right-hand side what the springs have answered so far.</summary>
    public void SubtractCorrections(double[] answers)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            bool isAnswer = scalar.Kind == RowKind.Spring && scalar.State == RowState.Free;
            _batch.Work.Solution[scalar.Index] -= isAnswer ? answers[scalar.Index] / scalar.Spring.Law.CorrectionGain : 0;
        }
    }

    /// <summary>Takes out the springs whose answer their force limit does not allow; false when there are none.</summary>
    public bool TakeOutOverloaded(double[] answers)
    {
        bool isAny = false;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            double impulse = scalar.ImpulseFirstHalf + answers[scalar.Index];
            if (scalar.Kind == RowKind.Spring && scalar.State == RowState.Free && !(impulse >= scalar.Low && impulse <= scalar.High))
            {
                scalar.State = RowState.AtBound;
                isAny = true;
            }
        }

        return isAny;
    }

    /// <summary>Takes the springs out again, as a projection leaves them.</summary>
    public void EndCorrection()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.State = scalar.Kind == RowKind.Spring ? RowState.AtBound : scalar.State;
        }
    }

    // Whether what holds a drive moves it as it asks.
    private bool IsMoved(in ScalarRow scalar, double tolerance)
    {
        const double share = 1e-3;
        double asked = scalar.Built.VelocityTarget;
        return Math.Abs(asked - StartSpeed(scalar)) <= share * Math.Abs(asked) + tolerance;
    }

    // A spring that answers holds the drift's speed. A drive that stalls is held at another speed than its own: in a blow it holds that. Newton's law
    // of impact: the speed after a stop against the speed before the step, above the threshold alone.
    private static double TargetSpeed(in ScalarRow scalar)
    {
        if (scalar.Kind == RowKind.Spring)
        {
            return scalar.Spring.CorrectionSpeed;
        }

        if (scalar.Kind != RowKind.Limit)
        {
            return scalar.Drive.IsStalled ? scalar.StartSpeed : scalar.Built.VelocityTarget;
        }

        return scalar.Built.Bounces(-scalar.StartSpeed) ? -scalar.Built.Restitution * scalar.StartSpeed : 0;
    }

    // The rest of a spring's impulse. An acceleration's is by what the row answers now, a damper's by the speed that is asked for now: by those of the
    // start alone, as they change with the pose, it would be of first order.
    private void SetSecondHalf(ref ScalarRow scalar)
    {
        double rest = scalar.ImpulseFirstHalf * (1 - scalar.FirstShare) / scalar.FirstShare;
        double impulse = rest;
        if (scalar.State == RowState.Free)
        {
            double share = 1 - scalar.Theta;
            impulse += share * scalar.Spring.Length * scalar.Spring.Law.Damping * (scalar.Built.VelocityTarget - scalar.Spring.StartTarget);
            impulse *= scalar.Built.Has(RowFlags.AccelerationSpring) ? scalar.Spring.StartResponse / Math.Max(Response(scalar), ScalarRow.LeastResponse) : 1;
            impulse = Math.Max(share * scalar.Low, Math.Min(share * scalar.High, impulse));
            scalar.Spring.Work += (impulse - rest) * scalar.Spring.DriftSpeed;
        }

        SetImpulseSecondHalf(ref scalar, impulse);
    }

    private void SetImpulseSecondHalf(ref ScalarRow scalar, double impulse)
    {
        Impulses<V>.ApplyRow(_batch, scalar.Block, scalar.Built, impulse - scalar.ImpulseSecondHalf);
        scalar.ImpulseSecondHalf = impulse;
        _batch.VelocityImpulses[scalar.Index] = impulse;
    }
}
