using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>The laws in the flight: their residuals at its end, and which rows leave their segment.</content>
internal sealed partial class Laws<V>
    where V : struct, ILane<V>
{
    /// <summary>Residuals of the laws at the end of the flight as errors, m or rad.</summary>
    public void Evaluate(double h)
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            double error = 0;
            law.First = _batch.Work.First[law.Index];
            if (law.Segment == Segment.Sloped)
            {
                error = law.Kind switch
                {
                    LawKind.HardLimit => law.End.GeometricError,
                    LawKind.Motor => h * (FlightSpeed(law) - law.Row.VelocityTarget),
                    _ => h * (FlightSpeed(law) + (law.First / law.Theta - law.Rest) / law.Gamma),
                };
            }

            _batch.Work.Error[law.Index] = error;
        }
    }

    /// <summary>Holds rows at their bounds whose impulses are beyond them; true when one was.</summary>
    public bool ClampOutside()
    {
        bool isChanged = false;
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            law.Jump = 0;
            if (law.Segment == Segment.Sloped)
            {
                law.First = _batch.Work.First[law.Index];
                isChanged |= ClampOutside(ref law);
            }
        }

        return isChanged;
    }

    /// <summary>Whether a hard limit was passed that had no row at the start of the flight: one of a distance or cone, in the middle.</summary>
    public bool HasPassedUnseen(double tolerance)
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            if (!law.IsWritten && law.End.Has(RowFlags.Limit) && !law.End.Has(RowFlags.Spring) && law.End.GeometricError < -tolerance)
            {
                return true;
            }
        }

        return false;
    }

    /// <summary>Gives the momenta what the last <see cref="Update"/> changed of the impulses.</summary>
    public void ApplyJumps()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            if (_laws[i].Jump != 0)
            {
                Impulses<V>.ApplyRow(_batch, _laws[i].Node, _laws[i].Row, _laws[i].Jump);
                _laws[i].Jump = 0;
            }
        }
    }

    /// <summary>Moves rows that have left their segment; true when one had to.</summary>
    public bool Update(int pass, double tolerance)
    {
        bool isChanged = false;
        for (int i = 0; i < _laws.Length && pass < MaxPasses && !(isChanged && pass >= FreePasses); i++)
        {
            ref Law law = ref _laws[i];
            law.Jump = 0;
            if (law.Kind == LawKind.None)
            {
                continue;
            }

            if (law.Segment == Segment.Sloped)
            {
                isChanged |= ClampOutside(ref law);
            }
            else if (Returns(law, law.Theta * law.Low, law.Theta * law.High, tolerance))
            {
                law.Segment = Segment.Sloped;
                isChanged = true;
            }
        }

        return isChanged;
    }

    private bool Returns(in Law law, double low, double high, double tolerance)
    {
        switch (law.Kind)
        {
            case LawKind.HardLimit:
                return law.End.GeometricError < -tolerance;
            case LawKind.Motor:
                double excess = FlightSpeed(law) - law.Row.VelocityTarget;
                return (law.First >= high && excess > tolerance) || (law.First <= low && excess < -tolerance);
            default:
                double wanted = law.Theta * (law.Rest - law.Gamma * FlightSpeed(law));
                double slack = law.Theta * law.Gamma * tolerance;
                return (law.First >= high && wanted < high - slack) || (law.First <= low && wanted > low + slack);
        }
    }

    private bool ClampOutside(ref Law law)
    {
        double impulse = Math.Min(law.Theta * law.High, Math.Max(law.Theta * law.Low, law.First));
        if (impulse == law.First)
        {
            return false;
        }

        law.Jump = impulse - law.First;
        law.First = impulse;
        law.Segment = Segment.Clamped;
        _batch.Work.First[law.Index] = impulse;
        return true;
    }
}
