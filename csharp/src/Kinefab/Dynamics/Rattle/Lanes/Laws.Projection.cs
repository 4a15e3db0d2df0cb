using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>The laws in the projection of the momenta at the end pose: what holds there, and with which speed.</content>
internal sealed partial class Laws<V>
    where V : struct, ILane<V>
{
    /// <summary>At the end pose: gives springs the rest of their impulse and finds which rows the projection may hold.</summary>
    public void BeginProjection(double tolerance)
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            _batch.Half[law.Index] = 0;
            law.Second = 0;
            if (!law.IsWritten || law.Kind == LawKind.None)
            {
                law.Segment = Segment.Clamped;
                continue;
            }

            switch (law.Kind)
            {
                case LawKind.Spring:
                    SetSecond(ref law, law.First * (1 - law.Theta) / law.Theta);
                    law.Held = law.Segment == Segment.Sloped ? (law.Rest - law.First / law.Theta) / law.Gamma : double.NaN;
                    law.Segment = Segment.Clamped;
                    break;
                case LawKind.Motor:
                    if (law.Theta == 1)
                    {
                        law.Segment = Segment.Clamped;
                    }
                    else if (law.Segment == Segment.Clamped)
                    {
                        SetSecond(ref law, law.First);
                    }

                    break;
                default:
                    law.Segment = law.Row.GeometricError <= tolerance ? Segment.Sloped : Segment.Clamped;
                    break;
            }
        }
    }

    /// <summary>Adds the speeds that the sloped rows shall have to the right-hand side of the projection.</summary>
    public void AddTargets()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            if (law.Segment == Segment.Sloped)
            {
                _batch.Work.Solution[law.Index] += Target(law);
            }
            else
            {
                _batch.Work.Solution[law.Index] = 0;
            }
        }
    }

    /// <summary>After a solve of the projection: moves rows that left their segment; true when one had to.</summary>
    public bool UpdateProjection(int pass, double tolerance)
    {
        bool isChanged = false;
        for (int i = 0; i < _laws.Length && pass < MaxPasses && !(isChanged && pass >= FreePasses); i++)
        {
            ref Law law = ref _laws[i];
            if (!law.IsWritten || law.Kind == LawKind.None || law.Kind == LawKind.Spring)
            {
                continue;
            }

            if (law.Segment == Segment.Sloped)
            {
                law.Second = _batch.Half[law.Index];
                double low = law.Low * (1 - law.Theta);
                double high = law.High * (1 - law.Theta);
                if (law.Kind == LawKind.HardLimit)
                {
                    // What pushed the joint back out of its stop on the way is no speed to leave it with.
                    low = -law.First;
                    high = double.PositiveInfinity;
                }

                if (law.Second < low || law.Second > high)
                {
                    SetSecond(ref law, law.Second < low ? low : high);
                    law.Segment = Segment.Clamped;
                    isChanged = true;
                }
            }
            else if (law.Kind == LawKind.HardLimit && law.Row.GeometricError <= tolerance
                && Impulses<V>.Speed(_batch, law.Node, law.Row) < Target(law) - tolerance)
            {
                law.Segment = Segment.Sloped;
                isChanged = true;
            }
        }

        return isChanged;
    }

    /// <summary>Lets springs answer in the projected momenta; false when none has to.</summary>
    public bool BeginAnswer()
    {
        bool isAny = false;
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            if (law.IsWritten && law.Kind == LawKind.Spring && law.Grip > 0 && !double.IsNaN(law.Held))
            {
                law.Segment = Segment.Sloped;
                isAny = true;
            }
        }

        return isAny;
    }

    /// <summary>Takes from the right-hand side what the springs have answered so far.</summary>
    public void TakeAnswers(double[] answers)
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            bool isAnswer = law.Kind == LawKind.Spring && law.Segment == Segment.Sloped;
            _batch.Work.Solution[law.Index] -= isAnswer ? answers[law.Index] / law.Grip : 0;
        }
    }

    /// <summary>Takes the springs out again, as a projection leaves them.</summary>
    public void EndAnswer()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            law.Segment = law.Kind == LawKind.Spring ? Segment.Clamped : law.Segment;
        }
    }

    // A spring that answers holds the flight's speed. Newton's law of impact: the speed after a stop against the speed before
    // the step, above the threshold alone.
    private static double Target(in Law law)
    {
        if (law.Kind == LawKind.Spring)
        {
            return law.Held;
        }

        if (law.Kind != LawKind.HardLimit)
        {
            return law.Row.VelocityTarget;
        }

        bool bounces = law.Row.Has(RowFlags.Restitution) && -law.StartSpeed > law.Row.BounceThreshold;
        return bounces ? -law.Row.Restitution * law.StartSpeed : 0;
    }

    private void SetSecond(ref Law law, double impulse)
    {
        Impulses<V>.ApplyRow(_batch, law.Node, law.Row, impulse - law.Second);
        law.Second = impulse;
        _batch.Half[law.Index] = impulse;
    }
}
