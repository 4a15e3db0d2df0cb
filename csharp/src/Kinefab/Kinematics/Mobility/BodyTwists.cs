using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// What every body can do: the span of its twists over all motions of the mechanism. Down the tree a body's twists are its
/// parent's and what its own freedoms add, so each costs what its own joint does. Motions that are done with (free ones, and
/// those of a block that has no more bodies further down) are kept as a span of six at most. The same as
/// kinefab/analysis/findings/freedoms.py.
/// </summary>
internal sealed class BodyTwists
{
    // Velocities are of length 1 altogether, so what is small in one body is small in itself, not only beside the rest.
    private const double LeastMotion = 1e-7;

    // Sine of the angle up to which directions of different joints are one: no CAD program leaves axes further off.
    private const double SameDirection = 1e-4;
    private const int Width = 6;

    private readonly Linkage _linkage;
    private readonly NewtonSolver _newton;
    private readonly Pose[] _poses;
    private readonly IndependentLinkages _parts;
    private readonly LoopMobility[] _loops;
    private readonly int[] _places;
    private readonly int[] _ends;
    private readonly int[][] _moverPlaces;
    private readonly List<double[]>[] _settled;
    private readonly List<(int Block, double[,] Twists)>[] _open;
    private readonly double _sameDirection;
    private readonly double _least;
    private readonly VelocitySpace[] _spaces;

    private BodyTwists(
        Linkage linkage, NewtonSolver newton, Pose[] poses, IndependentLinkages parts, LoopMobility[] loops, VelocitySpace[] spaces, double sameDirection, double least)
    {
        _spaces = spaces;
        _sameDirection = sameDirection;
        _least = least;
        _linkage = linkage;
        _newton = newton;
        _poses = poses;
        _parts = parts;
        _loops = loops;
        _places = new int[linkage.BodyCount];
        _ends = new int[linkage.BodyCount];
        _settled = new List<double[]>[linkage.BodyCount];
        _open = new List<(int, double[,])>[linkage.BodyCount];
        Number(linkage.Tree);
        _moverPlaces = new int[loops.Length][];
        for (int b = 0; b < loops.Length; b++)
        {
            _moverPlaces[b] = new int[parts.Movers(b).Count];
            for (int i = 0; i < _moverPlaces[b].Length; i++)
            {
                _moverPlaces[b][i] = _places[parts.Movers(b)[i]];
            }

            Array.Sort(_moverPlaces[b]);
        }
    }

    /// <summary>Translations and rotations of each body.</summary>
    /// <param name="mechanism">Whose.</param>
    /// <param name="newton">Its freedoms' twists at the poses that are looked at.</param>
    /// <param name="poses">These poses.</param>
    /// <param name="parts">Its blocks.</param>
    /// <param name="loops">Their velocities at these poses.</param>
    /// <param name="open">What the file is open by, in the mechanism's lengths or radians.</param>
    /// <param name="cancellation">Ends it early.</param>
    public static List<BodyMobility> Of(
        Mechanism mechanism, NewtonSolver newton, Pose[] poses, IndependentLinkages parts, LoopMobility[] loops, double open, CancellationToken cancellation)
    {
        VelocitySpace[] here = Array.ConvertAll(loops, loop => loop.Here);
        var twists = new BodyTwists(mechanism.Linkage, newton, poses, parts, loops, here, SameDirection, LeastMotion);
        bool isNoisy = NoisyRows.IsNoise(Array.ConvertAll(here, space => space.Dropped).Append(open).Max());
        BodyTwists[] others = isNoisy ? Others(mechanism, newton, poses, parts, loops, open) : Array.Empty<BodyTwists>();
        var bodies = new List<BodyMobility>();
        foreach (int body in mechanism.Tree.Order)
        {
            cancellation.ThrowIfCancellationRequested();
            int rank = twists.Rank(body, out int rotations);
            bool isInDoubt = false;
            foreach (BodyTwists other in others)
            {
                int otherRank = other.Rank(body, out int otherRotations);
                isInDoubt |= otherRank != rank || otherRotations != rotations;
            }

            bodies.Add(new BodyMobility(mechanism.GameObjects[body], rank - rotations, rotations, isInDoubt));
        }

        return bodies;
    }

    // As it may be in a pose that is off by what closes links in line: there a body moves that stands still at a dead centre, and what moves
    // by no more than that may stand still.
    private static BodyTwists[] Others(Mechanism mechanism, NewtonSolver newton, Pose[] poses, IndependentLinkages parts, LoopMobility[] loops, double open)
    {
        double turned = loops.Length == 0 ? 0 : loops.Max(loop => loop.Here.Turned(Math.Max(open, loop.Here.Dropped)));
        BodyTwists Of(Converter<LoopMobility, VelocitySpace> space, double sameDirection, double least) =>
            new(mechanism.Linkage, newton, poses, parts, loops, Array.ConvertAll(loops, space), sameDirection, least);
        return new[]
        {
            Of(loop => loop.Here, Math.Max(SameDirection, turned), Math.Max(LeastMotion, turned)),
            Of(loop => loop.Beside(turned), SameDirection, LeastMotion),
        };
    }

    // A body's descendants are those with the places after its own up to its end.
    private void Number(KinematicTree tree)
    {
        var sizes = new int[_places.Length];
        for (int i = tree.Order.Length - 1; i >= 0; i--)
        {
            int body = tree.Order[i];
            sizes[body]++;
            if (tree.Parents[body] >= 0)
            {
                sizes[tree.Parents[body]] += sizes[body];
            }
        }

        int root = 0;
        var next = new int[_places.Length];
        foreach (int body in tree.Order)
        {
            int parent = tree.Parents[body];
            ref int place = ref (parent < 0 ? ref root : ref next[parent]);
            _places[body] = place;
            place += sizes[body];
            next[body] = _places[body] + 1;
            _ends[body] = _places[body] + sizes[body];
        }
    }

    // In order of the tree, each body once.
    private int Rank(int body, out int rotations)
    {
        int parent = _linkage.Tree.Parents[body];
        int own = _parts.BlockOf(body);
        Vector3d point = (MechanismScale.Place(_linkage, body, _poses) - _linkage.Origin) * (1 / _linkage.Length);
        var settled = new List<double[]>();
        var going = new List<double[]>();
        var open = new List<(int Block, double[,] Twists)>();
        bool isOpen = false;
        foreach ((int block, double[,] twists) in parent < 0 ? open : _open[parent])
        {
            isOpen |= block == own;
            bool goesOn = block == own || GoesOn(block, body);
            double[,] here = block == own ? Moved(twists, block, body) : twists;
            (goesOn ? going : settled).AddRange(Span(here, point, block));
            if (goesOn)
            {
                open.Add((block, here));
            }
        }

        if (own >= 0 && !isOpen)
        {
            double[,] here = Moved(new double[_spaces[own].Freedoms, Width], own, body);
            going.AddRange(Span(here, point, own));
            open.Add((own, here));
        }

        if (own < 0 && _linkage.Tree.Freedoms[body] > 0)
        {
            settled.AddRange(TwistSpan.Of(At(Free(body), point), LeastMotion));
        }

        List<double[]> before = parent < 0 ? new List<double[]>() : _settled[parent];
        if (settled.Count > 0)
        {
            settled.AddRange(TwistSpan.Of(At(before, point), LeastMotion));
            before = At(TwistSpan.Of(settled, _sameDirection), -point);
        }

        _settled[body] = before;
        _open[body] = open;
        if (before.Count == Width)
        {
            rotations = Width / 2;
            return Width;
        }

        going.AddRange(TwistSpan.Of(At(before, point), LeastMotion));
        List<double[]> all = TwistSpan.Of(going, _sameDirection);
        rotations = Rotations(all);
        return all.Count;
    }

    // What may be in a block's velocity without being in its motion is none: a parallelogram's link with axes off by a little does not turn.
    private List<double[]> Span(double[,] twists, Vector3d point, int block) =>
        TwistSpan.Moving(At(twists, point), Math.Max(_least, _spaces[block].Noise));

    private bool GoesOn(int block, int body)
    {
        int first = Array.BinarySearch(_moverPlaces[block], _places[body] + 1);
        first = first < 0 ? ~first : first;
        return first < _moverPlaces[block].Length && _moverPlaces[block][first] < _ends[body];
    }

    // The parent's twists in a block's motions and what the body's own freedoms add, one row a motion.
    private double[,] Moved(double[,] parent, int block, int body)
    {
        var twists = (double[,])parent.Clone();
        VelocitySpace space = _spaces[block];
        int place = _loops[block].Part.IndexOf(body);
        for (int m = 0; m < space.Freedoms; m++)
        {
            Vector3d linear = Vector3d.Zero;
            Vector3d angular = Vector3d.Zero;
            space.AddOwnTwist(place, space.Basis[m], ref linear, ref angular);
            Add(twists, m, linear, angular);
        }

        return twists;
    }

    private double[,] Free(int body)
    {
        var twists = new double[_linkage.Tree.Freedoms[body], Width];
        for (int i = 0; i < twists.GetLength(0); i++)
        {
            int column = _newton.Firsts[body] + i;
            Add(twists, i, _newton.Motion.Linear[column], _newton.Motion.Angular[column]);
        }

        return twists;
    }

    private static void Add(double[,] twists, int row, Vector3d linear, Vector3d angular)
    {
        for (int i = 0; i < 3; i++)
        {
            twists[row, i] += linear[i];
            twists[row, 3 + i] += angular[i];
        }
    }

    // Twists at the mechanism's origin as they are at another point, in the mechanism's lengths from there; and back by its opposite.
    private static List<double[]> At(List<double[]> twists, Vector3d point)
    {
        var moved = new List<double[]>(twists.Count);
        foreach (double[] twist in twists)
        {
            var turn = new Vector3d(twist[3], twist[4], twist[5]);
            Vector3d linear = new Vector3d(twist[0], twist[1], twist[2]) + Vector3d.Cross(turn, point);
            moved.Add(new[] { linear.X, linear.Y, linear.Z, turn.X, turn.Y, turn.Z });
        }

        return moved;
    }

    private static List<double[]> At(double[,] twists, Vector3d point)
    {
        var rows = new List<double[]>(twists.GetLength(0));
        for (int m = 0; m < twists.GetLength(0); m++)
        {
            var row = new double[Width];
            for (int i = 0; i < Width; i++)
            {
                row[i] = twists[m, i];
            }

            rows.Add(row);
        }

        return At(rows, point);
    }

    // Independent directions that orthonormal twists turn about.
    private int Rotations(List<double[]> twists)
    {
        var turns = new double[twists.Count, Width / 2];
        for (int m = 0; m < twists.Count; m++)
        {
            for (int i = 0; i < Width / 2; i++)
            {
                turns[m, i] = twists[m][Width / 2 + i];
            }
        }

        return new SingularValues(turns).Rank(_sameDirection);
    }
}
