using System;
using System.Collections.Generic;
using System.Threading;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Finds loops whose axes are a little off: locked by an angle that is small, but too large to be rounding, which an exact
/// solution holds to the letter where Unity's soft joints let the mechanism move. Such a loop has a velocity that all
/// anchors allow and that turns the axes apart only slowly; that stays so when it is followed for a finite way, all round.
/// Of a loop near a singular pose the same is true there, but not further on: if it moves to the letter it moves so, and if it
/// does not it is a frame and stands. Of one that moves, or is singular, the axes' speed is 0; of a stiff frame it is of the
/// order of the motion, or, where the frame is wide and bends, of the joints' motion. Islands are looked at in whole, what is
/// suspect in one loop by loop.
/// </summary>
internal sealed partial class LoopConsistencyProbe
{
    // Deterministic mixtures of all allowed velocities that are tried.
    private const int Mixtures = 2;

    // How far a velocity is followed, radians of the fastest body.
    private const double Way = 0.15;

    // Speed of the axes against the fastest body's: below the first what is off may be files' rounding, and angles held a little softer suffice;
    // above the most, or as much of the fastest joint's, it is a frame.
    private const double LeastNamedSpeed = 1e-4;
    private const double MostSpeed = 0.04;

    // Share of the axes' speed that further projections leave of one that is slow by itself. Of a freedom with a rest of a
    // stiffer motion they leave less: the rest goes, and nothing but its smallness made it look slow.
    private const double LeastKept = 0.5;

    // Speed of a joint, of what it was, that is none.
    private const double LeastRate = 0.01;

    // Error at the end of the way against that of a constant speed.
    private const double MostGrowth = 3;

    private readonly LoopMotion _motion;

    private LoopConsistencyProbe(Island island, MultibodySystem mechanism, CancellationToken cancellation) => _motion = new LoopMotion(island, mechanism, cancellation);

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

    // Held: whether rows, taken to the letter, hold what their softness lets move; frame: that, and no axes are off. With more than one loop all that
    // axes hold counts as off: which it is is told loop by loop.
    private LoopConsistency Fit(bool hasOneLoop, out bool isHeld, out bool isFrame)
    {
        LoopConsistency fit = LoopConsistency.Exact;
        isHeld = false;
        isFrame = false;
        bool hasCouplings = Array.Exists(_motion.Shape.Blocks, block => block.Coupling != null);
        for (int mixture = 1; mixture <= Mixtures && fit != LoopConsistency.Inconsistent; mixture++)
        {
            _motion.Restart(mixture);
            if (IsSlow(_motion.Allowed(), out double first) && IsSlow(_motion.Allowed(), out double speed) && speed >= LeastKept * first
                && speed <= MostSpeed * LoopMotion.Fastest(_motion.Rates()) && _motion.Follow(Way) && _motion.AngularError <= MostGrowth * Way * speed && IsSlow(_motion.Allowed(), out double last))
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

    // Which joints that their softness lets move the rows hold, taken to the letter. In a loop that is only near a singular
    // pose there is a slow velocity too, far along its way, but its joints move without it.
    private bool[] Held(int mixture, bool holdsCouplings)
    {
        _motion.RestartAllowed(mixture);
        double[] before = _motion.Rates();
        _motion.TakeToTheLetter(holdsCouplings);
        double[] after = _motion.Rates();
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
        _motion.RestartAllowed(mixture);
        var all = _motion.Save();
        _motion.TakeToTheLetter(true);
        double[] after = _motion.Rates();
        _motion.TakeFrom(all);
        double[] before = _motion.Rates();
        double fastest = LoopMotion.Fastest(before), freest = LoopMotion.Fastest(after);
        var held = new bool[before.Length];
        for (int n = 0; n < before.Length; n++)
        {
            held[n] = before[n] > LeastRate * fastest && after[n] * fastest <= LeastRate * before[n] * Math.Max(freest, fastest);
        }

        double pace = Pace(before, held);
        speed = pace > LoopMotion.LeastSpeed ? _motion.AxesSpeed() / pace : 0;
        return held;
    }

    private static bool IsSlow(double speed, out double same)
    {
        same = speed;
        return speed >= LoopMotion.LeastSpeed && speed <= MostSpeed;
    }
}
