using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// One part of a step of one island, tried by a method. RATTLE finds the moment at which a limit is reached on the way, ends a piece of
/// the part there with a blow, and goes on with the rest, so that it stays of second order and passes no limit unseen.
/// </summary>
internal sealed class Substep
{
    // Blows (impacts at a limit) in a part. After so many, as where a body rattles in a gap, the rest of the part is taken in one piece, with its
    // limits held from its start on.
    private const int MaxBlows = 12;

    // Lengths that are tried in search of the one that ends at a limit.
    private const int MaxTrials = 16;

    // Share of a part: a limit that is struck again sooner than that is rested on from then on. The bounce that is lost is no higher than
    // g (LeastFlight h)^2 / 8.
    private const double LeastFlight = 0.1;

    // Trials. Where none of so many ends before the limit, every drift passes it, however short, and it is held from the piece's start on. That is
    // said of no limit without a row there, as in the middle of its range, and not of a slide's other end.
    private const int MostLate = 3;

    // Where a drift leaps over a limit from one length to the next, the piece up to the leap is worth its cost from this share of the drift on.
    private const double LeastSure = 0.05;

    // A drift has reached a limit whose C it ends with, in tolerances, is between -MostPassed and MostShort.
    private const double MostPassed = ActiveSet<ScalarLane>.MostPassed;
    private const double MostShort = 5;

    // The impulses of a piece shorter than this share of the part are no guess for the rest of it.
    private const double LeastTelling = 0.25;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly ConjugateGradient _conjugateGradient;
    private readonly ProjectedStep _projected;
    private readonly Snapshot _pieceStart;
    private readonly double[] _guess;
    private readonly bool[] _converged = new bool[1];
    private double _length;
    private double _part;
    private double _guessLength;

    // Whether a drift from the piece's start arrived without the guess and not with it.
    private bool _isGuessMisleading;

    public Substep(LaneBatch<ScalarLane> batch, ConjugateGradient conjugateGradient)
    {
        _batch = batch;
        _conjugateGradient = conjugateGradient;
        _projected = new ProjectedStep(batch, _conjugateGradient);
        _pieceStart = new Snapshot(batch);
        _guess = new double[batch.VelocityImpulses.Length];
    }

    /// <summary>Whether rows keep to their bounds in every iteration, see <see cref="RattleStep{V}.KickAndDrift"/>.</summary>
    public bool IsEager { get; set; }

    /// <summary>Whether a limit that every drift passes, however short, is held from its start on, whatever moves it: where shorter parts do not help.</summary>
    public bool HoldsPassedLimits { get; set; }

    /// <summary>The impulses that were loaded are those of parts of this length.</summary>
    public void Begin(double h) => _length = h;

    /// <summary>Impulses are proportional to the part's length; the guess is scaled to it.</summary>
    public void SetLength(double h)
    {
        if (_length > 0 && _length != h)
        {
            double factor = h / _length;
            for (int i = 0; i < _batch.VelocityImpulses.Length; i++)
            {
                _batch.VelocityImpulses[i] *= factor;
            }

            _batch.Scalars?.ScaleHistory(factor);
        }

        _length = h;
    }

    /// <summary>Pieces and parts that were tried since it was set to 0.</summary>
    public int Tries { get; set; }

    /// <summary>RATTLE from the start pose, blow by blow; what a failure leaves is for the caller to restore.</summary>
    public bool TryRattle(double h, double tolerance)
    {
        Tries++;
        ActiveSet<ScalarLane>? scalars = _batch.ActiveSet;
        if (scalars == null)
        {
            BeginPiece();
            return TryDriftFromPieceStart(h, tolerance) && Complete(h, h, tolerance);
        }

        SetLength(h);
        _part = h;
        scalars.BeginPart();
        double left = h;
        for (int blows = 0; ; blows++)
        {
            scalars.LocatesEvents = blows < MaxBlows;
            scalars.BeginPiece(left);
            BeginPiece();
            Array.Copy(_batch.VelocityImpulses, _guess, _guess.Length);
            _guessLength = _length;
            if (!TryPiece(left, tolerance, out double piece) && !TryPieceEagerly(left, tolerance, out piece))
            {
                return false;
            }

            if (piece == left)
            {
                return Complete(left, h, tolerance);
            }

            if (!Complete(piece, h, tolerance))
            {
                return false;
            }

            Tries++;
            left -= piece;
            if (!(left > 0))
            {
                return true;
            }

            SetLength(left);
        }
    }

    private void BeginPiece()
    {
        _pieceStart.Save(_batch);
        _isGuessMisleading = false;
    }

    // A guess can be worse than none: a damper's impulse, or those from before a blow, belong to another motion. And a loop that can be closed is
    // closed here: a gap that its angles were left with would be closed by a later part, at the speed of the gap over that part's length.
    private bool TryDriftFromPieceStart(double h, double tolerance)
    {
        if (!_isGuessMisleading && TryDrift(h, tolerance) && !IsLeftOpen(tolerance))
        {
            return true;
        }

        ReturnToPieceStartWithoutGuess();
        if (TryDrift(h, tolerance) && !IsLeftOpen(tolerance))
        {
            _isGuessMisleading = true;
            return true;
        }

        if (!IsExact)
        {
            return false;
        }

        // Conjugate gradients on the matrix without its compliance: where rows that repeat each other contradict, far from a closed pose, their
        // impulses grow without bound, so that it comes last.
        ReturnToPieceStartWithoutGuess();
        return TryDrift(h, tolerance, _conjugateGradient);
    }

    private void ReturnToPieceStartWithoutGuess()
    {
        _pieceStart.Restore(_batch);
        _batch.ClearHistory();
    }

    private bool IsLeftOpen(double tolerance) => IsExact && _batch.Work.MaxError[0] > ChordIteration<ScalarLane>.MostLeftOpen * tolerance;

    // A loop that was rounded, held to the letter, is braked or stirred up.
    private bool IsExact => _batch.Shape.Loops == LoopConsistency.Exact;

    private bool TryDrift(double h, double tolerance, ConjugateGradient? conjugateGradient = null)
    {
        _batch.Work.Active[0] = 1;
        RattleStep<ScalarLane>.KickAndDrift(_batch, h, tolerance, _converged, IsEager, conjugateGradient);
        return _converged[0] && !HasGoneTooFar(h, tolerance);
    }

    // What the pose at the end of a drift does not tell: how far a body turned, or that a limit was passed on the way.
    private bool HasGoneTooFar(double h, double tolerance) =>
        FreeMotion<ScalarLane>.HasTurnedFar(_batch, 0) || (_batch.ActiveSet != null && _batch.ActiveSet.HasMissedEvent(h, tolerance));

    /// <summary>A <see cref="ProjectedStep"/> from the start pose; energy that closing the end pose gave is taken from the speeds.</summary>
    /// <param name="h">Length, s.</param>
    /// <param name="tolerance">Largest C, m or rad.</param>
    /// <param name="since">What energy may not have grown since; null: the part's start.</param>
    public bool TryProjected(double h, double tolerance, EnergyAudit? since)
    {
        if (_batch.Shape.Loops == LoopConsistency.Rounded)
        {
            return false;
        }

        if (_batch.ActiveSet != null)
        {
            _batch.ActiveSet.LocatesEvents = false;
        }

        bool isKnown = LaneEnergy<ScalarLane>.IsKnown(_batch, 0);
        EnergyAudit before = since ?? (isKnown ? new EnergyAudit(_batch, h, tolerance) : default);
        if (!_projected.TrySolve(h, tolerance) || FreeMotion<ScalarLane>.HasTurnedFar(_batch, 0) || (_batch.ActiveSet != null && _batch.ActiveSet.HasTurnedFar(h)))
        {
            return false;
        }

        Finish();
        if (isKnown)
        {
            new EnergyAudit(_batch, h, tolerance).Dampen(_batch, before);
        }

        Array.Clear(_batch.VelocityImpulses, 0, _batch.VelocityImpulses.Length);
        return IsFinite();
    }

    // The drift of the rest of a part, or as much of it as leads to the first limit on its way.
    private bool TryPiece(double left, double tolerance, out double piece)
    {
        ActiveSet<ScalarLane> scalars = _batch.ActiveSet!;
        piece = left;
        if (!TryDriftFromPieceStart(left, tolerance))
        {
            return false;
        }

        double passed = scalars.NearestApart();
        if (passed >= -MostPassed * tolerance)
        {
            return true;
        }

        // None where a pose so far off has no number for it.
        int first = scalars.FirstReached(left);
        bool isPassedAtOnce = false;
        if (first >= 0 && TryReach(left, passed, scalars.Row(first), tolerance, out piece, out isPassedAtOnce))
        {
            return true;
        }

        if (isPassedAtOnce && scalars.HoldBack(first, HoldsPassedLimits, piece < LeastFlight * _part, tolerance))
        {
            ReturnToPieceStart(left);
            return TryPiece(left, tolerance, out piece);
        }

        return false;
    }

    // The same from the piece's start, and from then on, with rows kept to their bounds in every iteration.
    private bool TryPieceEagerly(double left, double tolerance, out double piece)
    {
        piece = left;
        if (IsEager)
        {
            return false;
        }

        Tries++;
        IsEager = true;
        ReturnToPieceStart(left);
        return TryPiece(left, tolerance, out piece);
    }

    // The drift as long as leads to the first limit on its way: the least C of those that are apart, by Chandrupatla's rule, which takes the inverse
    // parabola through the last three lengths where it may be trusted and halves the bracket elsewhere. Source: Chandrupatla 1997.
    private bool TryReach(double longest, double passed, in ScalarRow first, double tolerance, out double piece, out bool isPassedAtOnce)
    {
        isPassedAtOnce = false;
        double aim = (MostShort - MostPassed) / 2 * tolerance;

        // C of a limit that the joint stands at and leaves is 0 at the start as well: over the length it falls about evenly, from the speed.
        bool isLeft = first.IsActive && first.StartError <= MostShort * tolerance && first.StartSpeed > 0;
        double before = !first.IsActive ? -passed : isLeft ? first.StartSpeed : Math.Max(first.StartError, Math.Max(first.StartSpeed * longest, tolerance));
        var bracket = new RootBracket(0, before, longest, (passed - aim) / (isLeft ? longest : 1), first.ReachedAt(longest));
        for (int trial = 0; trial < MaxTrials; trial++)
        {
            piece = bracket.Next();
            ReturnToPieceStart(piece);
            if (!TryDriftFromPieceStart(piece, tolerance))
            {
                return false;
            }

            double nearest = _batch.ActiveSet!.NearestApart();
            if (nearest >= -MostPassed * tolerance && nearest <= MostShort * tolerance)
            {
                // A limit that nothing was seen to leave is one that turns with the body: the drift is too long for its J.
                return bracket.Early > 0 || !_batch.ActiveSet.HasLeft();
            }

            bracket.Add(piece, (nearest - aim) / (isLeft ? piece : 1));
            if (bracket.Early == 0 && trial >= MostLate && first.IsActive && !first.IsOnOtherSide)
            {
                isPassedAtOnce = true;
                return false;
            }
        }

        // The drift leaps over the limit from one length to the next, as where a spring that is too stiff for it gives way: as far as it is sure it
        // is a piece without a blow.
        piece = bracket.Early;
        if (!(piece > LeastSure * longest))
        {
            return false;
        }

        ReturnToPieceStart(piece);
        return TryDriftFromPieceStart(piece, tolerance) && !(_batch.ActiveSet!.NearestApart() < 0);
    }

    private void ReturnToPieceStart(double piece)
    {
        _pieceStart.Restore(_batch);
        Begin(_guessLength);
        SetLength(piece);
    }

    // Ends a piece of a part whose drift has arrived.
    private bool Complete(double h, double part, double tolerance)
    {
        if (_batch.Shape.IsRedundant && IsExact)
        {
            SelfStress.TakeOut(_batch, h, tolerance, _conjugateGradient);
        }

        _batch.ActiveSet?.AddWork();
        CompliantAngles<ScalarLane>.AddDrift(_batch);
        RattleStep<ScalarLane>.Build(_batch);
        _batch.Work.Active[0] = 1;
        VelocityProjection<ScalarLane>.Run(_batch, h, tolerance, _conjugateGradient);
        Finish();
        if (_batch.ActiveSet == null)
        {
            GeometricStiffness<ScalarLane>.Estimate(_batch, _batch.VelocityImpulses, h / 2);
            return IsFinite();
        }

        if (h >= LeastTelling * part)
        {
            GeometricStiffness<ScalarLane>.Estimate(_batch, _batch.VelocityImpulses, h / 2);
            Array.Copy(_batch.VelocityImpulses, _guess, _guess.Length);
            _guessLength = h;
        }

        if (VelocityProjection<ScalarLane>.Strike(_batch, h, LeastFlight * part, tolerance, _conjugateGradient))
        {
            Accumulate(_batch.VelocityImpulses);
        }

        // A blow is no guess for what comes.
        Array.Copy(_guess, _batch.VelocityImpulses, _guess.Length);
        Begin(_guessLength);

        return IsFinite();
    }

    private void Finish()
    {
        RattleStep<ScalarLane>.Accept(_batch);
        AssembledRows<ScalarLane>.FinishAngles(_batch);
        Accumulate(_batch.Work.PositionImpulses);
        Accumulate(_batch.VelocityImpulses);
    }

    private void Accumulate(double[] impulses)
    {
        EnergyAudit.AddDriven(_batch, _length, impulses);
        for (int i = 0; i < impulses.Length; i++)
        {
            _batch.Work.TotalImpulses[i] += impulses[i];
        }
    }

    private bool IsFinite()
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            for (int i = 0; i < BodyLanes.EndX; i++)
            {
                if (!(Math.Abs(_batch.Bodies[o + i]) < 1e100))
                {
                    return false;
                }
            }
        }

        return FreeMotion<ScalarLane>.HasFollowed(_batch);
    }
}
