using System;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The motions that an island's joints leave, whatever its masses: each body has unit moments, and a mass that weighs the levers' mean length as
/// one radian. Velocities are projected on what the rows allow, and followed for a finite way.
/// </summary>
internal sealed class LoopMotion
{
    /// <summary>Speed of the axes against the fastest body's below which a loop closes as far as motion shows.</summary>
    public const double LeastSpeed = 5e-8;

    // Corrections towards the allowed velocities, and of a pose.
    private const int Projections = 40;
    private const int Closings = 12;

    // Share by which rows are taken to the letter, so that the slowest that is named is gone after so many projections.
    private const double LetterShare = 1e-11;
    private const int LetterProjections = 4;

    // Iterations in which angles yield as well before anchors are closed alone, and in all.
    private const int Yieldings = 3;
    private const int MostClosings = 20;

    // Gap of the anchors that counts as closed, against the levers' length.
    private const double MostGap = 1e-6;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly double _length;
    private readonly CancellationToken _cancellation;

    /// <param name="island">Whose loops; it has its pattern afterwards.</param>
    /// <param name="mechanism">Where it is; not changed.</param>
    /// <param name="cancellation">Ends whatever is done early, with an OperationCanceledException.</param>
    public LoopMotion(Island island, MultibodySystem mechanism, CancellationToken cancellation)
    {
        _cancellation = cancellation;
        island.Order(cancellation);
        _batch = new LaneBatch<ScalarLane>(island, new Workspace<ScalarLane>(island));
        LaneTransfer<ScalarLane>.GatherConstants(_batch, 0, island, mechanism);
        LaneTransfer<ScalarLane>.Gather(_batch, mechanism, 1);
        _length = Length(island);
        double[] a = _batch.Bodies;
        for (int body = 0; body < island.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            a[o + BodyLanes.InverseMass] = _length * _length;
            for (int i = 0; i < 3; i++)
            {
                a[o + BodyLanes.InverseInertia + i] = a[o + BodyLanes.InverseInertia + i] > 0 ? 1 : 0;
            }

            a[o + BodyLanes.LeastInverseInertia] = a[o + BodyLanes.LeastInverseInertia] > 0 ? 1 : 0;
        }

        for (int body = island.MovingBodies; body < island.Bodies.Length; body++)
        {
            Array.Clear(a, LaneBatch<ScalarLane>.Body(body, BodyLanes.V), 6);
            Array.Clear(a, LaneBatch<ScalarLane>.Body(body, BodyLanes.W), 3);
        }

        _batch.Work.Active[0] = 1;
    }

    /// <summary>The island.</summary>
    public Island Shape => _batch.Shape;

    /// <summary>Numbers of rows.</summary>
    public int RowCount => _batch.Work.Error.Length;

    /// <summary>Speed of the fastest of the locked angles, rad/s.</summary>
    public double AxesSpeed()
    {
        Impulses<ScalarLane>.NegativeSpeeds(_batch, false);
        return MostAngular(_batch.Work.Solution);
    }

    /// <summary>Poses and velocities as they are.</summary>
    public double[] Save() => (double[])_batch.Bodies.Clone();

    /// <summary>Brings them back; rows and matrix stay as they are.</summary>
    /// <param name="state">See <see cref="Save"/>.</param>
    public void Restore(double[] state) => Array.Copy(state, _batch.Bodies, state.Length);

    /// <summary>What follows goes on from the pose that the bodies were moved to.</summary>
    /// <param name="given">Becomes C of all rows there.</param>
    public void Accept(double[] given)
    {
        Array.Copy(_batch.Work.Error, given, given.Length);
        RattleStep<ScalarLane>.Accept(_batch);
    }

    /// <summary>Where the mechanism stands, with the speeds of one of the mixtures.</summary>
    public void Restart(int mixture)
    {
        FreeMotion<ScalarLane>.Stay(_batch);
        Rebuild();
        Start(mixture);
    }

    /// <summary>The same with what the rows allow of them.</summary>
    public void RestartAllowed(int mixture)
    {
        Restart(mixture);
        Allowed();
        Allowed();
    }

    // Numbers of no pattern, the same on every machine.
    private void Start(int mixture)
    {
        uint state = (uint)mixture * 2654435761;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            for (int i = 0; i < 6; i++)
            {
                state = 1664525 * state + 1013904223;
                double number = state / (double)uint.MaxValue - 0.5;
                _batch.Bodies[o + BodyLanes.V + i] = i < 3 ? number * _length : number;
            }
        }
    }

    /// <summary>Takes from the velocities what the rows do not allow, scales them and returns the axes' speed in what is left.</summary>
    public double Allowed()
    {
        for (int i = 0; i < Projections; i++)
        {
            _cancellation.ThrowIfCancellationRequested();
            if (AxesSpeed() < LeastSpeed * Fastest())
            {
                return 0;
            }

            DelassusMatrix<ScalarLane>.Solve(_batch, _batch.Work.Solution);
            Impulses<ScalarLane>.Apply(_batch, _batch.Work.Solution);
        }

        double most = Fastest();
        if (!(most > 0))
        {
            return double.NaN;
        }

        Scale(1 / most);
        return AxesSpeed();
    }

    /// <summary>Leaves of the velocities what the rows allow to the letter; the matrix is another one then.</summary>
    /// <param name="holdsCouplings">Whether couplings are among the rows.</param>
    public void TakeToTheLetter(bool holdsCouplings)
    {
        DelassusMatrix<ScalarLane>.Assemble(_batch, LetterShare, LetterShare);
        _batch.ActiveSet?.AddToDiagonal(true);
        for (int n = 0; n < _batch.Shape.Blocks.Length && !holdsCouplings; n++)
        {
            _batch.Matrix[_batch.Shape.Pattern.Diagonal(n)] *= _batch.Shape.Blocks[n].Coupling != null ? DelassusMatrix<ScalarLane>.UnconstrainedShare : 1;
        }

        DelassusMatrix<ScalarLane>.Factor(_batch);
        for (int i = 0; i < LetterProjections; i++)
        {
            Impulses<ScalarLane>.NegativeSpeeds(_batch, false);
            DelassusMatrix<ScalarLane>.Solve(_batch, _batch.Work.Solution);
            Impulses<ScalarLane>.Apply(_batch, _batch.Work.Solution);
        }
    }

    /// <summary>Leaves of the velocities what the rows would not allow to the letter.</summary>
    public void TakeWhatIsHeld()
    {
        var all = Save();
        TakeToTheLetter(true);
        TakeFrom(all);
    }

    /// <summary>The velocities become what they lack of others.</summary>
    /// <param name="all">See <see cref="Save"/>.</param>
    public void TakeFrom(double[] all)
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.V);
            for (int i = o; i < o + 6; i++)
            {
                _batch.Bodies[i] = all[i] - _batch.Bodies[i];
            }
        }
    }

    /// <summary>Moves the bodies by their velocities, scaled to a way, and closes the joints. False: they came less than half of it.</summary>
    /// <param name="way">Of the fastest body, rad.</param>
    public bool Follow(double way)
    {
        Scale(way);
        for (int i = 0; ; i++)
        {
            FreeMotion<ScalarLane>.Drift(_batch, 1);
            BilateralRows<ScalarLane>.Evaluate(_batch);
            Rebuild();
            if (i == Closings)
            {
                return Fastest() >= way / 2;
            }

            for (int row = 0; row < _batch.Work.Solution.Length; row++)
            {
                _batch.Work.Solution[row] = -_batch.Work.Error[row];
            }

            DelassusMatrix<ScalarLane>.Solve(_batch, _batch.Work.Solution);
            Impulses<ScalarLane>.Apply(_batch, _batch.Work.Solution);
        }
    }

    /// <summary>
    /// Moves the bodies by their velocities, which become those that lead to where the anchors are closed. Of the angles only what the stride adds to
    /// what they had given yields: all of it would lead back to the start, the farther the shorter the strides are. False: they do not close.
    /// </summary>
    /// <param name="given">C of the locked angles before it.</param>
    public bool CloseAnchors(double[] given)
    {
        for (int i = 0; ; i++)
        {
            FreeMotion<ScalarLane>.Drift(_batch, 1);
            BilateralRows<ScalarLane>.Evaluate(_batch);
            BilateralRows<ScalarLane>.MeasureErrors(_batch);
            Rebuild();
            bool isClosed = _batch.Work.MaxGap[0] <= MostGap * _length;
            if ((isClosed && i >= Yieldings) || i == MostClosings)
            {
                return isClosed;
            }

            for (int row = 0; row < given.Length; row++)
            {
                double error = _batch.Work.Error[row];
                _batch.Work.Solution[row] = !_batch.Shape.IsAngular[row] ? -error : i < Yieldings ? given[row] - error : 0;
            }

            DelassusMatrix<ScalarLane>.Solve(_batch, _batch.Work.Solution);
            Impulses<ScalarLane>.Apply(_batch, _batch.Work.Solution);
        }
    }

    /// <summary>Speed of each joint: of its bodies' turn and of its anchors, against the levers' length, rad/s.</summary>
    public double[] Rates()
    {
        var rates = new double[_batch.Shape.Blocks.Length];
        for (int n = 0; n < rates.Length; n++)
        {
            RowBlock block = _batch.Shape.Blocks[n];
            if (block.Joint != null)
            {
                Vector3d turn = Impulses<ScalarLane>.AngularVelocity(_batch, block.Bodies[1]) - Impulses<ScalarLane>.AngularVelocity(_batch, block.Bodies[0]);
                rates[n] = Math.Max(turn.Length, (AnchorSpeed(n, 1) - AnchorSpeed(n, 0)).Length / _length);
            }
        }

        return rates;
    }

    private Vector3d AnchorSpeed(int n, int side)
    {
        int body = _batch.Shape.Blocks[n].Bodies[side];
        Vector3d speed = LaneTransfer<ScalarLane>.ReadVector(_batch.Bodies, LaneBatch<ScalarLane>.Body(body, BodyLanes.V));
        Vector3d lever = LaneTransfer<ScalarLane>.ReadVector(_batch.Joints, LaneBatch<ScalarLane>.Joint(n, LaneBatch<ScalarLane>.WorldFrame(side)));
        return speed + Vector3d.Cross(Impulses<ScalarLane>.AngularVelocity(_batch, body), lever);
    }

    /// <summary>The largest of <see cref="Rates"/>.</summary>
    public static double Fastest(double[] rates)
    {
        double most = 0;
        foreach (double rate in rates)
        {
            most = Math.Max(most, rate);
        }

        return most;
    }

    /// <summary>Largest C of a locked angle where the bodies are, rad.</summary>
    public double AngularError => MostAngular(_batch.Work.Error);

    private void Rebuild()
    {
        _cancellation.ThrowIfCancellationRequested();
        RattleStep<ScalarLane>.Rebuild(_batch);
        if (_batch.ActiveSet != null)
        {
            RattleStep<ScalarLane>.Factor(_batch, true);
        }
    }

    private double MostAngular(double[] rows)
    {
        double most = 0;
        for (int i = 0; i < rows.Length; i++)
        {
            most = _batch.Shape.IsAngular[i] ? Math.Max(most, Math.Abs(rows[i])) : most;
        }

        return most;
    }

    private double Fastest()
    {
        double most = 0;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.V);
            for (int i = 0; i < 6; i++)
            {
                most = Math.Max(most, Math.Abs(_batch.Bodies[o + i]) / (i < 3 ? _length : 1));
            }
        }

        return most;
    }

    /// <summary>All velocities times a factor.</summary>
    public void Scale(double factor)
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.V);
            for (int i = 0; i < 6; i++)
            {
                _batch.Bodies[o + i] *= factor;
            }
        }
    }

    private static double Length(Island island)
    {
        double sum = 0;
        int count = 0;
        foreach (RowBlock block in island.Blocks)
        {
            for (int side = 0; side < 2 && block.Joint != null; side++)
            {
                if (block.Bodies[side] < island.MovingBodies)
                {
                    sum += (side == 0 ? block.Joint.Frame0 : block.Joint.Frame1).Position.Length;
                    count++;
                }
            }
        }

        return sum > 0 ? sum / count : 1;
    }
}
