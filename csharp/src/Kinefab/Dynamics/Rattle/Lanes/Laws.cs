using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

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
            isFactored = _laws[i].Hold != Hold.Compliant && _laws[i].FindHold() == _laws[i].Hold;
        }

        return isFactored;
    }

    /// <summary>Before a node's rows at the end of the flight are written.</summary>
    public void ClearEnds(int node)
    {
        int end = _first[node] + _batch.Shape.Nodes[node].Laws;
        for (int i = _first[node]; i < end; i++)
        {
            _laws[i].HasEnd = false;
        }
    }

    /// <summary>A node's row at the end of the flight.</summary>
    public void SetEnd(int node, int slot, in ConstraintRow row)
    {
        ref Law law = ref _laws[_first[node] + slot];
        law.HasEnd = true;
        law.End = row;
    }

    /// <summary>A node's rows at the end of the flight as those of the pose that is built.</summary>
    public void TakeEnds(int node)
    {
        int end = _first[node] + _batch.Shape.Nodes[node].Laws;
        for (int i = _first[node]; i < end; i++)
        {
            ref Law law = ref _laws[i];
            law.IsWritten = law.HasEnd;
            if (law.HasEnd)
            {
                law.Row = law.End;
            }
        }
    }

    /// <summary>Whether a node that has one law has a motor, whose row about an axis that stays is the same wherever it is built.</summary>
    public bool HasMotorAlone(int node) => _laws[_first[node]].IsWritten && !_laws[_first[node]].Row.Has(RowFlags.Spring);

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
            law.Kind = law.FindKind();
            if (law.Kind == LawKind.None)
            {
                law.Segment = Segment.Clamped;
                law.First = 0;
                _batch.Half[law.Index] = 0;
                continue;
            }

            law.StartSpeed = StartSpeed(law);
            double response = Response(law);
            law.SetBounds(h, _batch.Shape.Nodes[law.Node].Joint!.DriveLimitsAreForces);
            if (law.Kind == LawKind.Spring)
            {
                law.SetSpring(h, response, isImplicit);
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

    /// <summary>What the next step takes from those before it.</summary>
    public void Exchange(StateTape tape)
    {
        tape.Array(_laws);
        tape.Value(ref _isFactored);
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
    /// <param name="isFlight">Springs act in the flight; after it they answer alone.</param>
    public void Condition(bool isFlight)
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            Node node = _batch.Shape.Nodes[law.Node];
            int cell = _batch.Shape.Pattern.Diagonal(law.Node) + law.NodeRow * (node.Rows + 1);
            law.Hold = law.FindHold();
            switch (law.Hold)
            {
                case Hold.None:
                    _batch.Matrix[cell] = 1;
                    break;
                case Hold.Rigid:
                    _batch.Matrix[cell] *= 1 + HeldShare;
                    break;
                default:
                    _batch.Matrix[cell] += 1 / (isFlight ? law.Theta * law.Gamma : law.Grip);
                    break;
            }
        }

        _isFactored = true;
    }

    private double StartSpeed(in Law law) => Impulses<V>.Speed(_batch, law.Node, law.Row);

    private double FlightSpeed(in Law law) => Impulses<V>.FlightSpeed(_batch, law.Node, law.Row, law.End);

    private double Response(in Law law) => Impulses<V>.ResponseOf(_batch, law.Node, law.Row);
}
