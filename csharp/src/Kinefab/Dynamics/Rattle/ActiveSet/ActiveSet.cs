using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The scalar rows of one island. They share the island's matrix: a free row has its
/// compliance on the diagonal, one at its bound is an identity row and its impulse acts from outside. The states are
/// found by a semi-smooth Newton iteration: solve, move the rows that left their state, solve again. Should that
/// circle, only the first row that is out of place moves (Murty's least-index rule), which ends.
/// </summary>
internal sealed partial class ActiveSet<V>
    where V : struct, ILane<V>
{
    /// <summary>Passes that move all rows out of place, and passes in all.</summary>
    private const int FreePasses = 8;
    private const int MaxPasses = 64;

    /// <summary>A limit this many tolerances away counts as reached.</summary>
    public const double Reach = 10;

    /// <summary>C of a limit, in tolerances below 0, down to which a drift has reached it and not passed it.</summary>
    public const double MostPassed = 1;

    private readonly LaneRecords<V> _batch;
    private readonly ScalarRows _scalars;
    private readonly ScalarRow[] _rows;
    private readonly DriveNeed<V> _needs;

    // In the drift's search for states: the sets that were seen, and whether all rows out of place move at once.
    private readonly ulong[] _seen = new ulong[MaxPasses];
    private int _seenCount;
    private bool _movesAll;

    // Longest that the drift may be, s.
    private double _left = double.PositiveInfinity;

    // Whether the projection is that of a blow.
    private bool _isBlow;

    public ActiveSet(LaneRecords<V> batch, ScalarRows scalars)
    {
        _batch = batch;
        _scalars = scalars;
        _rows = scalars.Rows;
        _needs = new DriveNeed<V>(batch, scalars);
    }

    /// <summary>Whether limits that a drift has to reach first are left to Substep, or held from the start of the step on.</summary>
    public bool LocatesEvents { get; set; }

    /// <summary>
    /// Whether the matrix is still the drift's: the projection before it held the same rows, and no spring is to act.
    /// </summary>
    public bool IsFactoredForDrift()
    {
        bool isFactored = _scalars.IsFactored;
        for (int i = 0; i < _rows.Length && isFactored; i++)
        {
            isFactored = _rows[i].ProjectedAs != ProjectedAs.Compliant && _rows[i].FindProjectedAs() == _rows[i].ProjectedAs;
        }

        return isFactored;
    }

    /// <summary>Takes the scalar rows' constants for a step from the rows at the start pose, guesses states, writes J.</summary>
    /// <param name="h">Step, s.</param>
    /// <param name="tolerance">Largest C, metres or radians.</param>
    /// <param name="isImplicit">Whether the whole impulse acts before the drift, see <see cref="ProjectedStep"/>.</param>
    public void Begin(double h, double tolerance, bool isImplicit)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.StartError = scalar.IsActive ? scalar.Built.GeometricError : double.PositiveInfinity;
            scalar.End = scalar.IsActive ? scalar.Built : default;
            scalar.ImpulseSecondHalf = 0;
            scalar.PendingImpulse = 0;
            scalar.Theta = isImplicit ? 1 : 0.5;
            scalar.Kind = scalar.FindKind(Reach * tolerance);
            scalar.StartSpeed = scalar.IsActive ? StartSpeed(scalar) : 0;
            scalar.Limit.Allowed = scalar.Kind == RowKind.Limit && scalar.StartError < -ScalarRow.MostClosedByDrift ? scalar.StartError : 0;
            bool isReached = scalar.Limit.Allowed < 0 || (!scalar.Limit.IsLeft && (scalar.Limit.IsHeldBack || (scalar.StartError <= Reach * tolerance && !IsThrownBack(scalar, tolerance))));
            scalar.Limit.IsApart = LocatesEvents && (!scalar.IsActive || (scalar.Built.Has(RowFlags.Limit) && !isReached));
            scalar.Limit.HasDrawn = false;
            scalar.Limit.LeftAlong = scalar.StartError <= Reach * tolerance ? scalar.Built.Linear0 : scalar.Limit.LeftAlong;
            scalar.Kind = scalar.Drive.IsHeld ? RowKind.None : scalar.Kind;
            if (scalar.Kind == RowKind.None || scalar.Limit.IsApart)
            {
                scalar.State = RowState.AtBound;
                scalar.ImpulseFirstHalf = 0;
                _batch.VelocityImpulses[scalar.Index] = 0;
                continue;
            }

            double response = Response(scalar);
            scalar.SetBounds(h, _batch.Models[scalar.Block]!.DriveLimitsAreForces);
            if (scalar.Kind == RowKind.Motion)
            {
                scalar.SetMotion(h);
            }

            if (scalar.AsksForSpeed && scalar.IsEndless)
            {
                scalar.BoundForce(_needs.MostImpulse(scalar, h));
            }

            if (scalar.Kind == RowKind.Spring)
            {
                scalar.SetSpring(h, response, isImplicit, IsSine(scalar));
                _batch.VelocityImpulses[scalar.Index] = GuessOf(scalar);
            }
            else
            {
                _batch.VelocityImpulses[scalar.Index] = Math.Min(scalar.Theta * scalar.High, Math.Max(scalar.Theta * scalar.Low, _batch.VelocityImpulses[scalar.Index]));
            }

            scalar.ImpulseFirstHalf = _batch.VelocityImpulses[scalar.Index];
            if (scalar.Kind == RowKind.Limit)
            {
                scalar.State = scalar.ImpulseFirstHalf > 0 || scalar.StartError < scalar.Limit.Allowed ? RowState.Free : RowState.AtBound;
            }
            else if (IsWithin(scalar, scalar.ImpulseFirstHalf))
            {
                scalar.State = RowState.Free;
            }

            if (response < ScalarRow.LeastResponse || !(scalar.High > scalar.Low))
            {
                scalar.Kind = RowKind.None;
                scalar.State = RowState.AtBound;
                scalar.ImpulseFirstHalf = 0;
                _batch.VelocityImpulses[scalar.Index] = 0;
            }
        }

        WriteRows(true);
    }

    /// <summary>The free rows start without impulse; the at-bound ones keep theirs.</summary>
    public void ClearFree()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.ImpulseFirstHalf = scalar.State == RowState.Free ? 0 : scalar.ImpulseFirstHalf;
            _batch.Work.PositionImpulses[scalar.Index] = scalar.ImpulseFirstHalf;
        }
    }

    /// <summary>Takes all rows out of the matrix until the next <see cref="Begin"/> guesses anew.</summary>
    public void Deactivate()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].State = RowState.AtBound;
        }
    }

    /// <summary>Clears a right-hand side where the impulse is not the matrix's to find.</summary>
    public void ClearAtBound(double[] vector)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            if (_rows[i].State == RowState.AtBound)
            {
                vector[_rows[i].Index] = 0;
            }
        }
    }

    /// <summary>Adds what a block's limits gave its first body in the whole step.</summary>
    public void AddLimits(int block, ref Vector3d linear, ref Vector3d angular)
    {
        int end = _scalars.First(block) + _batch.Shape.Blocks[block].ScalarCount;
        for (int i = _scalars.First(block); i < end; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (scalar.IsActive && scalar.Built.Has(RowFlags.OutputForce))
            {
                linear += scalar.Built.Linear0 * _batch.Work.TotalImpulses[scalar.Index];
                angular += scalar.Built.Angular0 * _batch.Work.TotalImpulses[scalar.Index];
            }
        }
    }

    /// <summary>Which of the rows may be to blame where no step is found from the pose that is built.</summary>
    /// <param name="reach">C up to which a limit counts as reached, m or rad.</param>
    public StepTroubles Troubles(double reach)
    {
        StepTroubles found = StepTroubles.None;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref readonly ConstraintRow row = ref _rows[i].Built;
            found |= !_rows[i].IsActive ? StepTroubles.None
                : row.IsHardLimit && row.GeometricError <= reach ? StepTroubles.Limit
                : _rows[i].IsEndlessDrive ? StepTroubles.EndlessDrive
                : StepTroubles.None;
        }

        return found;
    }

    /// <summary>The next row, from one on, of a limit that stands passed and cannot be closed; -1: there is none.</summary>
    public int NextHeldOpen(int from)
    {
        int i = from;
        while (i < _rows.Length && _rows[i].Limit.Allowed == 0)
        {
            i++;
        }

        return i < _rows.Length ? i : -1;
    }

    /// <summary>The most that an endless drive which stalls gives, as the speed that it would give its own bodies times the root of what they weigh; -1 where none does.</summary>
    public double StalledWeight()
    {
        double most = -1;
        for (int i = 0; i < _rows.Length; i++)
        {
            most = _rows[i].Drive.IsStalled ? Math.Max(most, Weight(_rows[i])) : most;
        }

        return most;
    }

    /// <summary>Whether a row is a hard limit that is pressed by as much as a drive which stalls gives: others only carry the mechanism.</summary>
    public bool IsPushed(in ScalarRow scalar, double stalledWeight)
    {
        const double leastShare = 0.01;
        return scalar.IsActive && scalar.Built.IsHardLimit && scalar.State == RowState.Free && stalledWeight > 0 && Weight(scalar) > leastShare * stalledWeight;
    }

    // A row's impulse by the speed at which its own bodies would part: of all rows in one unit, that of the root of an energy.
    private double Weight(in ScalarRow scalar) => Math.Abs(_batch.Work.TotalImpulses[scalar.Index]) * Math.Sqrt(Response(scalar));

    /// <summary>How many rows there are.</summary>
    public int Count => _rows.Length;

    /// <summary>A row.</summary>
    public ref readonly ScalarRow Row(int index) => ref _rows[index];

    /// <summary>J of the free rows into the batch, 0 for the at-bound ones.</summary>
    /// <param name="isAll">Write J of all rows, so that impulses can be applied by them.</param>
    public void WriteRows(bool isAll)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            bool isThere = scalar.IsActive && scalar.Kind != RowKind.None && (isAll || scalar.State == RowState.Free);

            // Not 0 times a row that is not there: what a failed attempt left of it may be no number.
            AssembledRows<V>.Write(_batch, scalar.Block, scalar.BlockRow, isThere ? scalar.Built : default);
        }
    }

    /// <summary>The scalar rows' part of the diagonal of the assembled matrix.</summary>
    /// <param name="isDrift">Springs act in the drift; after it they answer alone.</param>
    public void AddToDiagonal(bool isDrift)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            RowBlock block = _batch.Shape.Blocks[scalar.Block];
            int cell = _batch.Shape.Pattern.Diagonal(scalar.Block) + scalar.BlockRow * (block.Rows + 1);
            scalar.ProjectedAs = scalar.FindProjectedAs();
            switch (scalar.ProjectedAs)
            {
                case ProjectedAs.Inactive:
                    _batch.Matrix[cell] = 1;
                    break;
                case ProjectedAs.Rigid:
                    _batch.Matrix[cell] = _batch.Matrix[cell] * (1 + ScalarRow.RigidShare) + ScalarRow.RigidShare * _batch.Work.HubResponse[scalar.Index];
                    break;
                default:
                    _batch.Matrix[cell] += 1 / (isDrift ? scalar.Theta * scalar.Spring.Law.ImplicitDamping : scalar.Spring.Law.CorrectionGain);
                    break;
            }
        }

        _scalars.IsFactored = true;
    }

    // A spring's impulse before the drift as it was in the last step, where that was a bound's as it is of the bound now.
    private static double GuessOf(in ScalarRow scalar)
    {
        double guess = scalar.ImpulseFirstHalf;
        return IsWithin(scalar, guess) ? guess : scalar.BoundShare * (guess >= scalar.BoundShare * scalar.High ? scalar.High : scalar.Low);
    }

    private static bool IsWithin(in ScalarRow scalar, double impulse) =>
        impulse > scalar.Theta * scalar.Low && impulse < scalar.Theta * scalar.High && impulse != scalar.BoundShare * scalar.Low && impulse != scalar.BoundShare * scalar.High;

    // So fast that a joint that comes back to its limit within the drift is thrown back once more; a slower one may as well rest there at its end. What
    // leaves its limit by less than one that counts as reached may be away, as by rounding, rests there.
    private bool IsThrownBack(in ScalarRow scalar, double tolerance) =>
        scalar.Built.Bounces(scalar.StartSpeed) && scalar.StartSpeed * _left > Reach * tolerance;

    /// <summary>Adds the compliance of springs times a vector to J M^-1 J^T times it; rows at their bounds stay as they are.</summary>
    public void AddCompliance(double[] vector, double[] product, bool isDrift)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            int k = scalar.Index;
            product[k] = scalar.ProjectedAs switch
            {
                ProjectedAs.Inactive => vector[k],
                ProjectedAs.Rigid => product[k],
                _ => product[k] + vector[k] / (isDrift ? scalar.Theta * scalar.Spring.Law.ImplicitDamping : scalar.Spring.Law.CorrectionGain),
            };
        }
    }

    private double StartSpeed(in ScalarRow scalar) => Impulses<V>.Speed(_batch, scalar.Block, scalar.Built);

    private double DriftSpeed(in ScalarRow scalar) => Impulses<V>.DriftSpeed(_batch, scalar.Block, scalar.Built, scalar.End);

    // That at which a spring's law gives the force of the mean C of the drift's ends: of C a sine, the row's own speed would have it lag behind, which is a
    // damper of first order. Where C leaps by a whole turn the row's own speed counts.
    private double SpringSpeed(in ScalarRow scalar)
    {
        const double mostChange = 1;
        double speed = DriftSpeed(scalar);
        double change = scalar.End.GeometricError - scalar.StartError;
        return scalar.Spring.EndShare > 0 && scalar.HasEnd && Math.Abs(change) < mostChange ? speed + scalar.Spring.EndShare * (change / scalar.Spring.Length - speed) : speed;
    }

    private double Response(in ScalarRow scalar) => Impulses<V>.ResponseOf(_batch, scalar.Block, scalar.Built);
}
