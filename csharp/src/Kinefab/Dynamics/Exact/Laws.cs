using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// The rows with a law of one island. They share the island's matrix: a row on a sloped segment has the segment's
/// compliance on the diagonal, a clamped one is an identity row and its impulse acts from outside. The segments are
/// found by a semi-smooth Newton iteration: solve, move the rows that left their segment, solve again. Should that
/// circle, only the first row that is out of place moves (Murty's least-index rule), which ends.
/// </summary>
internal sealed partial class Laws<V>
    where V : struct, ILane<V>
{
    /// <summary>Passes that move all rows out of place, and passes in all.</summary>
    private const int FreePasses = 8;
    private const int MaxPasses = 64;

    // Keeps the pivot of a limit or speed that other rows hold too above 0, without a trace in the speed.
    private const double HeldShare = 1e-11;

    // A compliance beyond this share of the row's response stands for a spring that hardly acts.
    private const double LeastResponse = 1e-200;

    private readonly Batch<V> _batch;
    private readonly Law[] _laws;
    private readonly int[] _first;

    // Whether the matrix is that of the rows as they stand now, held as their Hold says.
    private bool _isFactored;

    public Laws(Batch<V> batch)
    {
        _batch = batch;
        _laws = new Law[batch.Shape.Laws];
        _first = new int[batch.Shape.Nodes.Length];
        int next = 0;
        for (int n = 0; n < _first.Length; n++)
        {
            Node node = batch.Shape.Nodes[n];
            _first[n] = next;
            for (int i = 0; i < node.Laws; i++)
            {
                int nodeRow = node.RigidRows + i;
                _laws[next++] = new Law { Node = n, NodeRow = nodeRow, Index = batch.Shape.Pattern.Rows[n] + nodeRow };
            }
        }
    }

    /// <summary>Before a node's rows are written: it has none yet.</summary>
    public void Clear(int node)
    {
        int end = _first[node] + _batch.Shape.Nodes[node].Laws;
        for (int i = _first[node]; i < end; i++)
        {
            _laws[i].IsWritten = false;
        }
    }

    /// <summary>A node's row as Prepare wrote it.</summary>
    public void Set(int node, int slot, in ConstraintRow row)
    {
        ref Law law = ref _laws[_first[node] + slot];
        law.IsWritten = true;
        _isFactored &= law.Hold == Hold.None || row.HasJacobianOf(law.Row);
        law.Row = row;
    }

    /// <summary>The bodies have moved or the matrix was changed: it is to be assembled anew.</summary>
    public void Invalidate() => _isFactored = false;

    /// <summary>
    /// Whether the matrix is still the flight's: the projection before it held the same rows, and no spring is to act.
    /// </summary>
    public bool IsFactoredForFlight()
    {
        bool isFactored = _isFactored;
        for (int i = 0; i < _laws.Length && isFactored; i++)
        {
            isFactored = _laws[i].Hold != Hold.Compliant && HoldOf(_laws[i], true) == _laws[i].Hold;
        }

        return isFactored;
    }

    /// <summary>A node's row at the end of the flight.</summary>
    public void SetEnd(int node, int slot, in ConstraintRow row) => _laws[_first[node] + slot].End = row;

    /// <summary>Forgets impulses and segments.</summary>
    public void ClearHistory()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            _laws[i].First = 0;
            _laws[i].Second = 0;
            _laws[i].Segment = Segment.Clamped;
        }
    }

    /// <summary>Takes the laws' constants for a step from the rows at the start pose, guesses segments, writes J.</summary>
    /// <param name="h">Step, s.</param>
    /// <param name="isImplicit">Whether the whole impulse acts before the flight (implicit Euler).</param>
    public void Begin(double h, bool isImplicit)
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            law.C0 = law.Row.GeometricError;
            law.End = law.IsWritten ? law.Row : default;
            law.Second = 0;
            law.Jump = 0;
            law.Theta = isImplicit ? 1 : 0.5;
            law.Kind = KindOf(law);
            if (law.Kind == LawKind.None)
            {
                law.Segment = Segment.Clamped;
                law.First = 0;
                _batch.Half[law.Index] = 0;
                continue;
            }

            law.StartSpeed = StartSpeed(law);
            double response = Response(law);
            SetBounds(ref law, h);
            if (law.Kind == LawKind.Spring)
            {
                SetSpring(ref law, h, response, isImplicit);
                _batch.Half[law.Index] = Math.Min(law.Theta * law.High, Math.Max(law.Theta * law.Low, law.First));
            }
            else
            {
                _batch.Half[law.Index] = Math.Min(law.Theta * law.High, Math.Max(law.Theta * law.Low, _batch.Half[law.Index]));
            }

            law.First = _batch.Half[law.Index];
            if (law.Kind == LawKind.HardLimit)
            {
                law.Segment = law.First > 0 || law.C0 < 0 ? Segment.Sloped : Segment.Clamped;
            }
            else if (law.First > law.Theta * law.Low && law.First < law.Theta * law.High)
            {
                law.Segment = Segment.Sloped;
            }

            if (response < LeastResponse)
            {
                law.Kind = LawKind.None;
                law.Segment = Segment.Clamped;
                law.First = 0;
                _batch.Half[law.Index] = 0;
            }
        }

        WriteRows(true);
    }

    /// <summary>The sloped rows start without impulse; the clamped ones keep theirs.</summary>
    public void StartFromZero()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            law.First = law.Segment == Segment.Sloped ? 0 : law.First;
            _batch.Work.First[law.Index] = law.First;
        }
    }

    /// <summary>Takes all rows out of the matrix until the next <see cref="Begin"/> guesses anew.</summary>
    public void Clamp()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            _laws[i].Segment = Segment.Clamped;
        }
    }

    /// <summary>Holds the hard limits that are passed where the rows were last built, and nothing else; writes their J and C.</summary>
    public void HoldPassedStops()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            law.Kind = law.IsWritten && law.Row.Has(RowFlags.Limit) && !law.Row.Has(RowFlags.Spring) ? LawKind.HardLimit : LawKind.None;
            bool isPassed = law.Kind == LawKind.HardLimit && law.Row.GeometricError < 0;
            law.Segment = isPassed ? Segment.Sloped : Segment.Clamped;
            _batch.Work.Error[law.Index] = isPassed ? law.Row.GeometricError : 0;
        }

        WriteRows(false);
    }

    /// <summary>Clears a right-hand side where the impulse is not the matrix's to find.</summary>
    public void ClearClamped(double[] vector)
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            if (_laws[i].Segment == Segment.Clamped)
            {
                vector[_laws[i].Index] = 0;
            }
        }
    }

    /// <summary>Impulses of a step of another length as a guess.</summary>
    public void ScaleHistory(double factor)
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            _laws[i].First *= factor;
        }
    }

    /// <summary>Keeps, or brings back, impulses, segments and the account of work.</summary>
    public void Save(LawHistory[] to)
    {
        for (int i = 0; i < to.Length; i++)
        {
            to[i] = new LawHistory(_laws[i]);
        }
    }

    public void Restore(LawHistory[] from)
    {
        for (int i = 0; i < from.Length; i++)
        {
            _laws[i].First = from[i].First;
            _laws[i].Segment = from[i].Segment;
            _laws[i].Work = from[i].Work;
        }

        Invalidate();
    }

    /// <summary>Adds what a node's limits gave its first body in the whole step.</summary>
    public void AddLimits(int node, ref Vector3d linear, ref Vector3d angular)
    {
        int end = _first[node] + _batch.Shape.Nodes[node].Laws;
        for (int i = _first[node]; i < end; i++)
        {
            ref Law law = ref _laws[i];
            if (law.IsWritten && law.Row.Has(RowFlags.Limit))
            {
                linear += law.Row.Linear0 * _batch.Work.Total[law.Index];
                angular += law.Row.Angular0 * _batch.Work.Total[law.Index];
            }
        }
    }

    /// <summary>Opens the account of <see cref="SpringWork"/>.</summary>
    public void ClearWork()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            _laws[i].Work = 0;
        }
    }

    /// <summary>Puts the flight's work into the account, with the rows still those of its start and end.</summary>
    public void AddWork()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            law.Work += law.Kind == LawKind.Spring && !HasPotential(law) ? law.First / law.Theta * FlightSpeed(law) : 0;
        }
    }

    /// <summary>Work of the springs that have no potential since the account was opened, J.</summary>
    public double SpringWork()
    {
        double sum = 0;
        for (int i = 0; i < _laws.Length; i++)
        {
            sum += _laws[i].Work;
        }

        return sum;
    }

    /// <summary>
    /// Energy in the springs that have a potential where the rows were last built, J: of one at its limit, what that force
    /// gives on the way back.
    /// </summary>
    /// <param name="dt">Step, s.</param>
    public double Stored(double dt)
    {
        double sum = 0;
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            double c = law.Row.GeometricError;
            if (law.IsWritten && law.Row.Has(RowFlags.Spring) && law.Row.Stiffness > 0 && !(law.Row.Has(RowFlags.Limit) && c >= 0) && HasPotential(law))
            {
                double response = law.Row.Has(RowFlags.AccelerationSpring) ? Response(law) : 1;
                double k = response > LeastResponse ? law.Row.Stiffness / response : 0;
                bool isForce = _batch.Shape.Nodes[law.Node].Joint!.DriveLimitsAreForces || !law.Row.Has(RowFlags.HasDriveLimit);
                double most = (c < 0 ? law.Row.Maximum : -law.Row.Minimum) / (isForce ? 1 : dt);
                double yield = Math.Min(Math.Abs(c), most / Math.Max(k, LeastResponse));
                sum += k * yield * (Math.Abs(c) - yield / 2);
            }
        }

        return sum;
    }

    /// <summary>By how much the worst hard limit is passed where the rows were last built, m or rad.</summary>
    public double DeepestStop()
    {
        double most = 0;
        for (int i = 0; i < _laws.Length; i++)
        {
            bool isStop = _laws[i].IsWritten && _laws[i].Row.Has(RowFlags.Limit) && !_laws[i].Row.Has(RowFlags.Spring);
            most = isStop ? Math.Max(most, -_laws[i].Row.GeometricError) : most;
        }

        return most;
    }

    /// <summary>The most that motors can have given since the start of the step, J.</summary>
    public double Driven()
    {
        double sum = 0;
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            sum += law.IsWritten && !law.Row.Has(RowFlags.Spring) ? Math.Abs(law.Row.VelocityTarget * _batch.Work.Total[law.Index]) : 0;
        }

        return sum;
    }

    /// <summary>J of the sloped rows into the batch, 0 for the clamped ones.</summary>
    /// <param name="isAll">Write J of all rows, so that impulses can be applied by them.</param>
    public void WriteRows(bool isAll)
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            bool isThere = law.IsWritten && law.Kind != LawKind.None && (isAll || law.Segment == Segment.Sloped);
            PreparedRows<V>.Write(_batch, law.Node, law.NodeRow, law.Row, isThere ? 1 : 0);
        }
    }

    /// <summary>The laws' part of the diagonal of the assembled matrix.</summary>
    /// <param name="isFlight">Springs act in the flight, not in the projection.</param>
    public void Condition(bool isFlight)
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            Node node = _batch.Shape.Nodes[law.Node];
            int cell = _batch.Shape.Pattern.Diagonal(law.Node) + law.NodeRow * (node.Rows + 1);
            law.Hold = HoldOf(law, isFlight);
            switch (law.Hold)
            {
                case Hold.None:
                    _batch.Matrix[cell] = 1;
                    break;
                case Hold.Rigid:
                    _batch.Matrix[cell] *= 1 + HeldShare;
                    break;
                default:
                    _batch.Matrix[cell] += 1 / (law.Theta * law.Gamma);
                    break;
            }
        }

        _isFactored = true;
    }

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

    private static LawKind KindOf(in Law law)
    {
        if (!law.IsWritten)
        {
            return LawKind.None;
        }

        if (law.Row.Has(RowFlags.Spring))
        {
            bool isIdle = law.Row.Stiffness == 0 && law.Row.Damping == 0;
            return isIdle || (law.Row.Has(RowFlags.Limit) && law.C0 >= 0) ? LawKind.None : LawKind.Spring;
        }

        return law.Row.Has(RowFlags.Limit) ? LawKind.HardLimit : LawKind.Motor;
    }

    private static Hold HoldOf(in Law law, bool isFlight) =>
        law.Segment == Segment.Clamped || !law.IsWritten ? Hold.None
        : law.Kind == LawKind.Spring && isFlight ? Hold.Compliant
        : Hold.Rigid;

    // Whether the force is one in C alone and C changes as the row moves: not where a damper drives, nor of twist and swing
    // drives, whose C is a sine of the angle by which the row turns, so that a force at its limit works by more than C says.
    private bool HasPotential(in Law law) =>
        law.Row.Hint == SolveHint.SlerpSpring ? ((D6Joint)_batch.Shape.Nodes[law.Node].Joint!).DriveAngularVelocity == Vector3d.Zero
        : law.Row.VelocityTarget == 0 && (!law.Row.Has(RowFlags.Angular | RowFlags.Drive) || _batch.Shape.Nodes[law.Node].Joint is RevoluteJoint);

    private void SetBounds(ref Law law, double h)
    {
        bool isForce = law.Row.Has(RowFlags.HasDriveLimit) && _batch.Shape.Nodes[law.Node].Joint!.DriveLimitsAreForces;
        law.Low = law.Row.Minimum * (isForce ? h : 1);
        law.High = law.Row.Maximum * (isForce ? h : 1);
    }

    private static void SetSpring(ref Law law, double h, double response, bool isImplicit)
    {
        double perMass = law.Row.Has(RowFlags.AccelerationSpring) && response > 0 ? 1 / response : 1;
        double k = law.Row.Stiffness * perMass;
        double d = law.Row.Damping * perMass;

        // Half the step's stiffness and damping against the inertia that they move, at most: where the step is too long to
        // follow the spring, its share goes from the midpoint's towards implicit Euler's, so that it decays and does not ring.
        double z = h * (d + h * k) * response;
        law.Theta = isImplicit ? 1 : z < 1 ? 0.5 : 1 - 0.5 / z;
        law.Gamma = h * (d + law.Theta * h * k);
        law.Rest = h * (d * law.Row.VelocityTarget - k * law.C0);
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

    private double StartSpeed(in Law law) => Impulses<V>.Speed(_batch, law.Node, law.Row);

    // J turns with the bodies: the mean of the start's and the end's gives the mean speed to second order.
    private double FlightSpeed(in Law law) =>
        (Impulses<V>.FlightSpeed(_batch, law.Node, law.Row) + Impulses<V>.FlightSpeed(_batch, law.Node, law.End)) / 2;

    private double Response(in Law law) => Impulses<V>.ResponseOf(_batch, law.Node, law.Row);
}
