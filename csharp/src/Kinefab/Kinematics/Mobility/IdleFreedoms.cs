using System;
using System.Collections.Generic;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Idle freedoms: motions of one body of a loop, or of several as one, while all others stand still, as a rod's spin between its two balls or a
/// ram's about its line. They count in the mobility and move nothing else.
/// <para>
/// In the graph of bodies (nodes, <see cref="JointGraph"/>) and joints (edges) such a group is held by the edges round it, and may move by the
/// twists that all of these leave it in common. Candidates are single nodes (AddSingle), and what lies between two edges that together cut a
/// block (AddBetween; of a class of such edges Sharing takes the pairs that can have a twist in common); what hangs on them without a loop is one
/// of the others. Of the twists in common counts what couplings leave, goes on as a finite motion (ThatGoOn), and is no mixture of idle freedoms
/// found before (IsNew). A block's only freedom is what it does, and not idle.
/// </para>
/// <para>Twists have six entries, linear then angular, at the mechanism's origin and in its lengths; all tolerances below are without unit.</para>
/// </summary>
internal sealed class IdleFreedoms
{
    private const int TwistSize = 6;

    // 1 less the squared cosine between two twists up to which they are one that both joints leave, of rows that are known to rounding; those that
    // are known less well allow the square of their noise, see Tolerance.
    private const double MostSkew = 1e-12;

    // Largest difference of two unit twists, along any direction, that are one at MostSkew; larger by the root of what Tolerance allows beyond.
    private const double MostApart = 4e-6;

    // A direction, about one long and as good as any other, along which twists are sorted to find those that are near each other.
    private static readonly double[] SortAxis = { 0.37, 0.43, 0.29, 0.53, 0.41, 0.39 };

    // Share of a motion up to which a block has no part in it: of motions known exactly, and of those that were followed by steps since
    // something obstructs velocities, which are known to a step's curvature.
    private const double LeastPart = 1e-6;
    private const double LeastPartOfFollowed = 1e-2;

    // What may be wrong in a twist that is taken from a motion that was followed.
    private const double NoiseOfFollowed = 1e-3;

    // A motion is another one than those already found where more is left of it beside them than may be wrong in it, so many times.
    private const double LeastNew = 10;

    private readonly Mechanism _mechanism;
    private readonly IndependentLinkages _parts;
    private readonly LoopMobility[] _loops;
    private readonly MechanismState _closed;
    private readonly JointGraph _graph;
    private readonly CutPairs _cuts;
    private readonly List<(double Noise, (int Node, double[] Twist)[] Parts)> _known = new();
    private readonly List<int>[] _knownOf;
    private readonly Dictionary<int, int> _left = new();
    private readonly List<IdleFreedom> _found = new();

    private IdleFreedoms(Mechanism mechanism, IndependentLinkages parts, LoopMobility[] loops, MechanismState closed)
    {
        _mechanism = mechanism;
        _parts = parts;
        _loops = loops;
        _closed = closed;
        _graph = new JointGraph(mechanism, parts, closed);
        _cuts = new CutPairs(_graph.Members.Count, _graph.Pairs);
        _knownOf = new List<int>[_graph.Members.Count];
    }

    /// <summary>All of a mechanism.</summary>
    /// <param name="mechanism">Which.</param>
    /// <param name="parts">Its blocks.</param>
    /// <param name="loops">What each of these can do.</param>
    /// <param name="closed">The pose that they were counted at.</param>
    /// <param name="cancellation">Ends the counting early, with an OperationCanceledException.</param>
    public static List<IdleFreedom> Of(Mechanism mechanism, IndependentLinkages parts, LoopMobility[] loops, MechanismState closed, CancellationToken cancellation)
    {
        if (mechanism.Tree.Closures.Length == 0)
        {
            return new List<IdleFreedom>();
        }

        var idle = new IdleFreedoms(mechanism, parts, loops, closed);
        idle.CountFreedomsOfBlocks();
        for (int node = 1; node < idle._graph.Members.Count; node++)
        {
            idle.AddSingle(node, cancellation);
        }

        foreach (List<int> edges in idle._cuts.Classes)
        {
            foreach ((int first, int last) in idle.Left(edges[0]) > 0 ? idle.Sharing(edges) : new List<(int, int)>())
            {
                idle.AddBetween(first, last, cancellation);
            }
        }

        return idle._found;
    }

    // One node by itself; a chain's end is in no loop. What floats hangs on none of its neighbours.
    private void AddSingle(int node, CancellationToken cancellation)
    {
        List<int> edges = _cuts.EdgesOf(node);
        int up = edges.FindIndex(edge => _cuts.BlockOf[edge] >= 0 && (Floats(node) || edge == _cuts.ParentEdges[node]));
        if (up >= 0 && Left(edges[up]) > 0)
        {
            Add(new List<int> { node }, edges[up], WhatAllLeave(_graph.Twists(edges[up]), edges, Tolerance(edges[up])), cancellation);
        }
    }

    // Whether nothing holds a node to the ground: which of its neighbours is the root tells nothing then.
    private bool Floats(int node) => _cuts.RootOf[node] != 0;

    // What lies between two edges that cut a block, away from its root; of what floats what lies on the other side too.
    private void AddBetween(int first, int last, CancellationToken cancellation)
    {
        int begin = _cuts.Lower(first);
        (int end, int after) = _cuts.IsOfTree(last) ? (_cuts.Upper(last), _cuts.Lower(last)) : (_cuts.Lower(last), _cuts.Upper(last));
        if (begin == end || _cuts.Upper(first) == after || Left(first) == 0)
        {
            return; // one node, or all that hangs on one
        }

        (List<int> inside, List<double[]> twists) = Side(begin, first, last);
        Add(inside, first, twists, cancellation);
        if (Floats(begin))
        {
            (List<int> outside, List<double[]> others) = Side(_cuts.Upper(first), first, last);
            Add(outside, first, others, cancellation);
        }
    }

    // The nodes that two edges leave beside one, and the twists by which they move as one while all others stand still.
    private (List<int> Members, List<double[]> Twists) Side(int begin, int first, int last)
    {
        double shared = Tolerance(first);
        List<double[]> twists = TwistSpan.Common(_graph.Twists(first), _graph.Twists(last), shared);
        var members = new List<int> { begin };
        var seen = new HashSet<int> { begin };
        for (int i = 0; i < members.Count && twists.Count > 0; i++)
        {
            foreach (int edge in _cuts.EdgesOf(members[i]))
            {
                if (_cuts.BlockOf[edge] < 0 || _cuts.BlockOf[edge] != _cuts.BlockOf[first])
                {
                    twists = TwistSpan.Common(twists, _graph.Twists(edge), shared);
                }
                else if (edge != first && edge != last && seen.Add(_cuts.Other(edge, members[i])))
                {
                    members.Add(_cuts.Other(edge, members[i]));
                }
            }
        }

        return (members, twists);
    }

    private void Add(List<int> nodes, int edge, List<double[]> twists, CancellationToken cancellation)
    {
        cancellation.ThrowIfCancellationRequested();
        twists = _graph.LeftByCouplings(nodes, twists);
        if (twists.Count == 0 || Left(edge) == 0)
        {
            return;
        }

        int found = 0;
        List<double[]> going = ThatGoOn(nodes, twists, cancellation);
        double noise = going.Count < twists.Count ? NoiseOfFollowed : Math.Sqrt(Tolerance(edge));
        foreach (double[] twist in going)
        {
            found += IsNew(nodes, twist, noise) ? 1 : 0; // a ram's spin is that of its tube and of its piston, if these turn
        }

        if (found > 0)
        {
            _found.Add(new IdleFreedom(GameObjects(nodes), found));
            _left[_cuts.BlockOf[edge]] -= found;
        }
    }

    private List<double[]> WhatAllLeave(List<double[]> twists, List<int> edges, double shared)
    {
        for (int i = 0; i < edges.Count && twists.Count > 0; i++)
        {
            twists = TwistSpan.Common(twists, _graph.Twists(edges[i]), shared);
        }

        return twists;
    }

    // Freedoms of an edge's block of joints that are not yet known to be idle; none where it has but one.
    private int Left(int edge) => _left[_cuts.BlockOf[edge]];

    // What each block of joints can do in itself. Couplings close no loop: what they tie may hold several blocks, and what hangs on them.
    private void CountFreedomsOfBlocks()
    {
        var edgesOf = new SortedDictionary<int, List<int>>();
        for (int edge = 0; edge < _cuts.BlockOf.Length; edge++)
        {
            if (_cuts.BlockOf[edge] >= 0)
            {
                if (!edgesOf.TryGetValue(_cuts.BlockOf[edge], out List<int>? edges))
                {
                    edgesOf.Add(_cuts.BlockOf[edge], edges = new List<int>());
                }

                edges.Add(edge);
            }
        }

        foreach ((int block, List<int> edges) in edgesOf)
        {
            var nodes = new SortedSet<int>();
            bool isTied = true;
            foreach (int edge in edges)
            {
                nodes.Add(_graph.Pairs[edge].A);
                nodes.Add(_graph.Pairs[edge].B);
                isTied &= _graph.Blocks[edge] >= 0;
            }

            if (Floats(nodes.Min))
            {
                KnowAllAsOne(nodes);
            }

            int count = isTied ? FreedomsOf(nodes, _loops[_graph.Blocks[edges[0]]]) : int.MaxValue; // of a block that nothing ties, any number
            _left.Add(block, count < 2 ? 0 : count);
        }
    }

    // A motion of all that floats is no motion of some beside the others: what is known besides it is told apart by how it moves against them.
    private void KnowAllAsOne(SortedSet<int> nodes)
    {
        for (int i = 0; i < TwistSize; i++)
        {
            var parts = new List<(int Node, double[] Twist)>();
            foreach (int node in nodes)
            {
                var twist = new double[TwistSize];
                twist[i] = 1 / Math.Sqrt(nodes.Count);
                parts.Add((node, twist));
                (_knownOf[node] ??= new List<int>()).Add(_known.Count);
            }

            _known.Add((0, parts.ToArray()));
        }
    }

    private int FreedomsOf(SortedSet<int> nodes, LoopMobility loop)
    {
        int bodies = 0;
        foreach (int node in nodes)
        {
            bodies += _graph.Members[node].FindAll(body => loop.Part.IndexOf(body) >= 0).Count;
        }

        if (loop.Finite < 2 || bodies >= loop.Part.Bodies.Length)
        {
            return loop.Finite;
        }

        IReadOnlyList<double[]> motions = loop.Motions;
        var moved = new double[TwistSize * nodes.Count, motions.Count];
        for (int m = 0; m < motions.Count; m++)
        {
            double[] first = TwistOf(loop, BodyOf(nodes.Min), motions[m]);
            int row = 0;
            foreach (int node in nodes)
            {
                double[] twist = TwistOf(loop, BodyOf(node), motions[m]);
                for (int i = 0; i < TwistSize; i++)
                {
                    moved[row++, m] = twist[i] - first[i];
                }
            }
        }

        // Beside a steep rack a motion that is known exactly may be a small share of all that move.
        return new SingularValues(moved).Rank(loop.Finite < loop.FirstOrder ? LeastPartOfFollowed : Math.Max(LeastPart, loop.Here.Noise));

        int BodyOf(int node) => _graph.Members[node].Count == 0 ? -1 : loop.Part.IndexOf(_graph.Members[node][0]);
    }

    // At the mechanism's origin, in its lengths; zero of what is not among the loop's bodies, and stands still.
    private static double[] TwistOf(LoopMobility loop, int body, double[] motion)
    {
        Vector3d linear = Vector3d.Zero;
        Vector3d angular = Vector3d.Zero;
        if (body >= 0)
        {
            loop.Here.Twist(body, motion, out linear, out angular);
        }

        return new[] { linear.X, linear.Y, linear.Z, angular.X, angular.Y, angular.Z };
    }

    private double Tolerance(int edge)
    {
        double noise = _graph.Blocks[edge] < 0 ? 0 : _loops[_graph.Blocks[edge]].Here.Noise;
        return Math.Max(MostSkew, noise * noise);
    }

    // Pairs of a class that may share a twist, the nearest first. Hinges, of which a loop may have hundreds, share theirs only where it is
    // the same, so they are sorted by it; the few joints with more freedoms are paired with all.
    private List<(int First, int Last)> Sharing(List<int> edges)
    {
        var pairs = new List<(int Distance, int First)>();
        var plain = new List<(double Key, int Place)>();
        for (int i = 0; i < edges.Count; i++)
        {
            if (_graph.Twists(edges[i]).Count == 1)
            {
                plain.Add((Math.Abs(DenseVector.Dot(_graph.Twists(edges[i])[0], SortAxis)), i));
                continue;
            }

            for (int j = 0; j < edges.Count; j++)
            {
                if (_graph.Twists(edges[j]).Count == 1 || j > i)
                {
                    pairs.Add((Math.Abs(i - j), Math.Min(i, j)));
                }
            }
        }

        plain.Sort();
        double near = MostApart * Math.Sqrt(Tolerance(edges[0]) / MostSkew);
        for (int k = 0; k < plain.Count; k++)
        {
            for (int l = k + 1; l < plain.Count && plain[l].Key - plain[k].Key <= near; l++)
            {
                pairs.Add((Math.Abs(plain[k].Place - plain[l].Place), Math.Min(plain[k].Place, plain[l].Place)));
            }
        }

        pairs.Sort();
        return pairs.ConvertAll(pair => (edges[pair.First], edges[pair.First + pair.Distance]));
    }

    // Whether more is left of a motion beside those known than may be wrong in it; then it is known. What is wrong in the known ones is as
    // much larger in it as little was left of them: the spins of two nuts on a screw of small lead differ by little, and are two.
    private bool IsNew(List<int> nodes, double[] twist, double noise)
    {
        var motion = new Dictionary<int, double[]>();
        var beside = new SortedSet<int>();
        foreach (int node in nodes)
        {
            motion[node] = Array.ConvertAll(twist, entry => entry / Math.Sqrt(nodes.Count));
            beside.UnionWith(_knownOf[node] ??= new List<int>());
        }

        foreach (int known in beside)
        {
            noise += Math.Abs(RemoveAlong(motion, _known[known].Parts)) * _known[known].Noise;
        }

        double rest = 0;
        foreach (double[] part in motion.Values)
        {
            rest += DenseVector.Dot(part, part);
        }

        rest = Math.Sqrt(rest);
        if (rest <= LeastNew * noise)
        {
            return false;
        }

        var left = new List<(int Node, double[] Twist)>();
        foreach ((int node, double[] part) in motion)
        {
            DenseVector.Divide(part, rest);
            left.Add((node, part));
            (_knownOf[node] ??= new List<int>()).Add(_known.Count);
        }

        _known.Add((noise / rest, left.ToArray()));
        return true;
    }

    // How much of a motion is along another one, of unit length, which is taken out of it.
    private static double RemoveAlong(Dictionary<int, double[]> motion, (int Node, double[] Twist)[] other)
    {
        double along = 0;
        foreach ((int node, double[] part) in other)
        {
            along += motion.TryGetValue(node, out double[]? own) ? DenseVector.Dot(own, part) : 0;
        }

        foreach ((int node, double[] part) in other)
        {
            if (!motion.TryGetValue(node, out double[]? own))
            {
                motion.Add(node, own = new double[TwistSize]);
            }

            DenseVector.Add(own, -along, part);
        }

        return along;
    }

    // What of the twists of some nodes is a finite motion of theirs, as one, while all others stand still: joints may leave a twist to first
    // order alone, as a slot across does.
    private List<double[]> ThatGoOn(List<int> nodes, List<double[]> twists, CancellationToken cancellation)
    {
        var moving = new HashSet<int>();
        foreach (int node in nodes)
        {
            moving.UnionWith(_graph.Members[node]);
        }

        var one = new LoopMobility(_parts.AsOne(moving, _closed.Poses), _closed, cancellation);
        if (one.Finite == 0 || one.Finite >= twists.Count)
        {
            return one.Finite == 0 ? new List<double[]>() : twists;
        }

        IReadOnlyList<double[]> motions = one.Motions;
        int body = one.Part.IndexOf(_graph.Members[nodes[0]][0]);
        var along = new double[motions.Count, twists.Count];
        for (int m = 0; m < motions.Count; m++)
        {
            double[] motion = TwistOf(one, body, motions[m]);
            for (int i = 0; i < twists.Count; i++)
            {
                along[m, i] = DenseVector.Dot(motion, twists[i]);
            }
        }

        return TwistSpan.Mixtures(twists, new SingularValues(along), 0, motions.Count);
    }

    private List<int> GameObjects(List<int> nodes)
    {
        var objects = new List<int>();
        foreach (int node in nodes)
        {
            foreach (int body in _graph.Members[node])
            {
                objects.Add(_mechanism.GameObjects[body]);
            }
        }

        objects.Sort();
        return objects;
    }
}
