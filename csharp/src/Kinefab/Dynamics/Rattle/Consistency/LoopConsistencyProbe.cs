using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Finds loops whose axes are a little off: locked by an angle that is small, but too large to be rounding, which an exact
/// solution holds to the letter where Unity's soft joints let the mechanism move. Such a loop has a velocity that all
/// anchors allow and that turns the axes apart only slowly; that stays so when it is followed for a finite way, all round.
/// Of a loop near a singular pose the same is true there, but not further on: if it moves to the letter it moves so, and if it
/// does not it is a frame and stands. Of one that moves, or is singular, the axes' speed is 0; of a stiff frame it is of the
/// order of the motion, or, where the frame is wide and bends, of the joints' motion. Islands are looked at in whole, what is
/// suspect in one loop by loop.
/// Masses play no part: each body has unit moments, and a mass that weighs the levers' mean length as one radian.
/// </summary>
internal sealed partial class LoopConsistencyProbe
{
    // Deterministic mixtures of all allowed velocities that are tried.
    private const int Mixtures = 2;

    // Corrections towards the allowed velocities, and of a pose.
    private const int Projections = 40;
    private const int Closings = 12;

    // How far a velocity is followed, radians of the fastest body.
    private const double Way = 0.15;

    // Speed of the axes against the fastest body's: below the least a loop closes as far as motion shows; below the next what
    // is off may be files' rounding, and angles held a little softer suffice; above the most, or as much of the fastest joint's, it is a frame.
    private const double LeastSpeed = 5e-8;
    private const double LeastNamedSpeed = 1e-4;
    private const double MostSpeed = 0.04;

    // Share of the axes' speed that further projections leave of one that is slow by itself. Of a freedom with a rest of a
    // stiffer motion they leave less: the rest goes, and nothing but its smallness made it look slow.
    private const double LeastKept = 0.5;

    // Share by which rows are taken to the letter, so that the slowest that is named is gone after so many projections, and
    // the speed of a joint, of what it was, that is none.
    private const double LetterShare = 1e-11;
    private const int LetterProjections = 4;
    private const double LeastRate = 0.01;

    // Error at the end of the way against that of a constant speed.
    private const double MostGrowth = 3;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly double _length;
    private readonly CancellationToken _cancellation;

    private LoopConsistencyProbe(Island island, MultibodySystem mechanism, CancellationToken cancellation)
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

    /// <summary>Each island with such a loop.</summary>
    /// <param name="mechanism">Not changed.</param>
    /// <param name="cancellation">Ends the search early, with an OperationCanceledException.</param>
    public static List<InconsistentLoop> Find(MultibodySystem mechanism, CancellationToken cancellation = default) =>
        Find(mechanism, IslandFinder.Find(mechanism), cancellation);

    /// <summary>Each island with such a loop.</summary>
    /// <param name="mechanism">Not changed.</param>
    /// <param name="islands">Its islands; those with loops of joints have their patterns afterwards.</param>
    /// <param name="cancellation">Ends the search early, with an OperationCanceledException.</param>
    public static List<InconsistentLoop> Find(MultibodySystem mechanism, List<Island> islands, CancellationToken cancellation)
    {
        var found = new List<InconsistentLoop>();
        foreach (Island island in islands)
        {
            cancellation.ThrowIfCancellationRequested();
            LoopConsistency fit = Fit(island, mechanism, cancellation, out _);
            if (fit != LoopConsistency.Exact)
            {
                var joints = new List<int>();
                foreach (RowBlock block in island.Blocks)
                {
                    if (block.Joint != null)
                    {
                        joints.Add(block.Index);
                    }
                }

                found.Add(new InconsistentLoop(joints.ToArray(), fit));
            }
        }

        return found;
    }

    private static LoopConsistency Fit(Island island, MultibodySystem mechanism, CancellationToken cancellation, out bool hasFrame)
    {
        hasFrame = false;
        island.Loops = LoopConsistency.Inconsistent;
        if (!island.HasJointLoops || !Array.Exists(island.Blocks, block => block.Angular != AngularForm.None))
        {
            return LoopConsistency.Exact;
        }

        bool hasOneLoop = JointLoops.Of(island).Count == 1;
        LoopConsistency fit = new LoopConsistencyProbe(island, mechanism, cancellation).Fit(hasOneLoop, out bool isHeld, out hasFrame);
        if (hasOneLoop || !isHeld)
        {
            return fit;
        }

        // Each by itself: a frame would hide what is off in another loop, and what moves elsewhere would look as if the held joints were at their end.
        // What no frame explains stays as it was found in all of them.
        LoopConsistency worst = LoopConsistency.Exact;
        foreach (Island loop in IslandFinder.FindLoops(island, mechanism))
        {
            LoopConsistency own = Fit(loop, mechanism, cancellation, out bool isFrame);
            own = own == LoopConsistency.Inconsistent || isFrame ? own : new LoopConsistencyProbe(loop, mechanism, cancellation).FitOfWhatIsHeld(own, out isFrame);
            worst = own > worst ? own : worst;
            hasFrame |= isFrame;
            if (worst == LoopConsistency.Inconsistent)
            {
                break;
            }
        }

        return hasFrame || worst > fit ? worst : fit;
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

    // Held: whether rows, taken to the letter, hold what their softness lets move; frame: that, and no axes are off. With more than one loop all that
    // axes hold counts as off: which it is is told loop by loop.
    private LoopConsistency Fit(bool hasOneLoop, out bool isHeld, out bool isFrame)
    {
        LoopConsistency fit = LoopConsistency.Exact;
        isHeld = false;
        isFrame = false;
        bool hasCouplings = Array.Exists(_batch.Shape.Blocks, block => block.Coupling != null);
        for (int mixture = 1; mixture <= Mixtures && fit != LoopConsistency.Inconsistent; mixture++)
        {
            Restart(mixture);
            if (IsSlow(Allowed(), out double first) && IsSlow(Allowed(), out double speed) && speed >= LeastKept * first
                && speed <= MostSpeed * Fastest(Rates()) && Follow(Way) && AngularError() <= MostGrowth * Way * speed && IsSlow(Allowed(), out double last))
            {
                bool isNamed = Math.Min(first, Math.Min(speed, last)) >= LeastNamedSpeed;
                bool[] held = Held(mixture, true);
                bool isAny = Array.IndexOf(held, true) >= 0;

                // A coupling is no axis that could be off: what moves without it is not held by axes.
                bool isByAxes = isAny && (!hasCouplings || Array.IndexOf(Held(mixture, false), true) >= 0);
                bool isOff = isByAxes && (!hasOneLoop || IsSlowAllRound(mixture, held));
                isHeld |= isAny;
                isFrame |= isAny && !isOff;
                fit = isNamed && isOff ? LoopConsistency.Inconsistent : isNamed ? fit : LoopConsistency.Rounded;
            }
        }

        // Of what a frame holds a mixture may have so little that it looks rounded.
        return isFrame && fit == LoopConsistency.Rounded ? LoopConsistency.Exact : fit;
    }

    // The same of a loop of which a mixture may have had too little: of what is slow in it alone, however little that is.
    private LoopConsistency FitOfWhatIsHeld(LoopConsistency fit, out bool isFrame)
    {
        isFrame = false;
        for (int mixture = 1; mixture <= Mixtures && fit != LoopConsistency.Inconsistent; mixture++)
        {
            bool[] held = HeldAlone(mixture, out double speed);
            if (speed >= LeastNamedSpeed)
            {
                bool isOff = speed <= MostSpeed && IsSlowAllRound(mixture, held);
                isFrame |= !isOff;
                fit = isOff ? LoopConsistency.Inconsistent : fit;
            }
        }

        return fit;
    }

    private void Restart(int mixture)
    {
        FreeMotion<ScalarLane>.Stay(_batch);
        Rebuild();
        Start(mixture);
    }

    private void RestartAllowed(int mixture)
    {
        Restart(mixture);
        Allowed();
        Allowed();
    }

    // Which joints that their softness lets move the rows hold, taken to the letter. In a loop that is only near a singular
    // pose there is a slow velocity too, far along its way, but its joints move without it.
    private bool[] Held(int mixture, bool holdsCouplings)
    {
        RestartAllowed(mixture);
        double[] before = Rates();
        TakeToTheLetter(holdsCouplings);
        double[] after = Rates();
        var held = new bool[before.Length];
        for (int n = 0; n < before.Length; n++)
        {
            held[n] = before[n] > LeastRate && after[n] < LeastRate * before[n];
        }

        return held;
    }

    // Which joints are moved by what the rows hold and not by what they allow, each against the fastest joint in its own motion, and the axes' speed
    // against these joints'; 0 where there are none. Where nothing is allowed, what is left of it is rounding.
    private bool[] HeldAlone(int mixture, out double speed)
    {
        RestartAllowed(mixture);
        var all = (double[])_batch.Bodies.Clone();
        TakeToTheLetter(true);
        double[] after = Rates();
        TakeFrom(all);
        double[] before = Rates();
        double fastest = Fastest(before), freest = Fastest(after);
        var held = new bool[before.Length];
        for (int n = 0; n < before.Length; n++)
        {
            held[n] = before[n] > LeastRate * fastest && after[n] * fastest <= LeastRate * before[n] * Math.Max(freest, fastest);
        }

        double pace = Pace(before, held);
        Impulses<ScalarLane>.NegativeSpeeds(_batch, false);
        speed = pace > LeastSpeed ? MostAngular(_batch.Work.Solution) / pace : 0;
        return held;
    }

    // Leaves of the velocities what the rows allow to the letter; the matrix is another one then.
    private void TakeToTheLetter(bool holdsCouplings)
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

    // Speed of each joint: of its bodies' turn and of its anchors, against the levers' length.
    private double[] Rates()
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

    private static double Fastest(double[] rates)
    {
        double most = 0;
        foreach (double rate in rates)
        {
            most = Math.Max(most, rate);
        }

        return most;
    }

    private static bool IsSlow(double speed, out double same)
    {
        same = speed;
        return speed >= LeastSpeed && speed <= MostSpeed;
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

    // Takes from the velocities what the rows do not allow, scales them and returns the axes' speed in what is left.
    private double Allowed()
    {
        for (int i = 0; i < Projections; i++)
        {
            _cancellation.ThrowIfCancellationRequested();
            Impulses<ScalarLane>.NegativeSpeeds(_batch, false);
            if (MostAngular(_batch.Work.Solution) < LeastSpeed * Fastest())
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
        Impulses<ScalarLane>.NegativeSpeeds(_batch, false);
        return MostAngular(_batch.Work.Solution);
    }

    private bool Follow(double way)
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

    private double AngularError() => MostAngular(_batch.Work.Error);

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

    private void Scale(double factor)
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
}
