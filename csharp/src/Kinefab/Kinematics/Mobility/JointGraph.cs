using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Which bodies stand beside which, and the twists that their joints leave two neighbours at one pose. Bodies that the joints between two
/// of them hold against each other are one node; the ground is node 0.
/// </summary>
internal sealed class JointGraph
{
    // Rate of a coupling, beside the largest of its joints', that a twist does not change.
    private const double Still = 1e-6;

    private readonly Mechanism _mechanism;
    private readonly MechanismState _state;
    private readonly DisjointSets _sets;
    private readonly Dictionary<(int A, int B), List<double[]>> _rows = new();
    private readonly Dictionary<int, int> _nodes = new();
    private readonly List<(int A, int B, double[] Wrench)>[] _couplings;
    private readonly List<int>[] _couplingsOf;
    private readonly List<double[]>[] _rowsOf;
    private readonly List<double[]>?[] _twists;

    /// <summary>Of a mechanism.</summary>
    /// <param name="mechanism">Which.</param>
    /// <param name="parts">Its blocks of freedoms.</param>
    /// <param name="state">Closed as well as it can be.</param>
    public JointGraph(Mechanism mechanism, IndependentLinkages parts, MechanismState state)
    {
        _mechanism = mechanism;
        _state = state;
        _sets = new DisjointSets(mechanism.BodyCount + 1);
        for (int body = 0; body < mechanism.BodyCount; body++)
        {
            if (mechanism.Tree.Moving(body) < 0)
            {
                _sets.Join(0, body + 1);
            }
        }

        List<((int A, int B) Ends, List<double[]> Rows)> pairs;
        bool isJoined;
        do
        {
            isJoined = false;
            pairs = RowsOfPairs();
            foreach (((int a, int b), List<double[]> rows) in pairs)
            {
                if (rows.Count >= 6 && TwistSpan.LeftBy(rows).Count == 0)
                {
                    _sets.Join(a, b);
                    isJoined = true;
                }
            }
        }
        while (isJoined);

        Members.Add(new List<int>());
        _nodes.Add(0, 0);
        for (int body = 0; body < mechanism.BodyCount; body++)
        {
            int set = _sets.Find(body + 1);
            if (!_nodes.TryGetValue(set, out int node))
            {
                _nodes.Add(set, node = Members.Count);
                Members.Add(new List<int>());
            }

            Members[node].Add(body);
        }

        _couplingsOf = new List<int>[Members.Count];
        for (int node = 0; node < Members.Count; node++)
        {
            _couplingsOf[node] = new List<int>();
        }

        _couplings = Array.ConvertAll(mechanism.Couplings, coupling => Terms(coupling).ConvertAll(term => (_nodes[term.A], _nodes[term.B], term.Wrench)));
        for (int i = 0; i < _couplings.Length; i++)
        {
            foreach ((int a, int b, _) in _couplings[i])
            {
                _couplingsOf[a].Add(i);
                _couplingsOf[b].Add(i);
            }
        }

        Pairs = new (int, int)[pairs.Count];
        _twists = new List<double[]>?[pairs.Count];
        _rowsOf = new List<double[]>[pairs.Count];
        Blocks = new int[pairs.Count];
        var place = new Dictionary<(int, int), int>();
        for (int i = 0; i < pairs.Count; i++)
        {
            place.Add(pairs[i].Ends, i);
            Pairs[i] = (_nodes[pairs[i].Ends.A], _nodes[pairs[i].Ends.B]);
            _rowsOf[i] = pairs[i].Rows;
            Blocks[i] = -1;
        }

        for (int joint = 0; joint < mechanism.Joints.Length; joint++)
        {
            if (place.TryGetValue(Ends(joint), out int pair))
            {
                Blocks[pair] = Math.Max(Blocks[pair], Block(joint, parts));
            }
        }
    }

    /// <summary>For each node its bodies.</summary>
    public List<List<int>> Members { get; } = new();

    /// <summary>The nodes that joints connect, each two once.</summary>
    public (int A, int B)[] Pairs { get; }

    /// <summary>Orthonormal twists, linear in the mechanism's lengths and at its origin, then angular, of one node of a pair against the other.</summary>
    /// <param name="pair">Its index; found when first asked for, as most blocks have no freedom to ask about.</param>
    public List<double[]> Twists(int pair) => _twists[pair] ??= TwistSpan.LeftBy(_rowsOf[pair]);

    /// <summary>For each pair the block of its freedoms, or -1.</summary>
    public int[] Blocks { get; }

    /// <summary>What couplings leave of twists of some nodes, as one, while all others stand still.</summary>
    /// <param name="nodes">Which.</param>
    /// <param name="twists">Orthonormal.</param>
    public List<double[]> LeftByCouplings(List<int> nodes, List<double[]> twists)
    {
        var moving = new HashSet<int>(nodes);
        var numbers = new SortedSet<int>();
        foreach (int node in nodes)
        {
            numbers.UnionWith(_couplingsOf[node]);
        }

        foreach (int number in numbers)
        {
            double largest = 0;
            var rates = new double[1, twists.Count];
            foreach ((int a, int b, double[] wrench) in _couplings[number])
            {
                int sign = (moving.Contains(b) ? 1 : 0) - (moving.Contains(a) ? 1 : 0);
                largest = sign == 0 ? largest : Math.Max(largest, DenseVector.Length(wrench));
                for (int i = 0; i < twists.Count; i++)
                {
                    rates[0, i] += sign * DenseVector.Dot(wrench, twists[i]);
                }
            }

            var values = new SingularValues(rates);
            if (twists.Count > 0 && values.Values[0] > Still * largest)
            {
                twists = TwistSpan.Mixtures(twists, values, 1);
            }
        }

        return twists;
    }

    private int Block(int joint, IndependentLinkages parts)
    {
        int child = _mechanism.Tree.ChildOf[joint];
        if (child >= 0)
        {
            return parts.BlockOf(child);
        }

        int[] path = _mechanism.Rows.Joints[joint].Bodies;
        return path.Length == 0 ? -1 : parts.BlockOf(path[0]);
    }

    private (int A, int B) Ends(int joint)
    {
        int a = _sets.Find(_mechanism.Joints[joint].Body0 + 1);
        int b = _sets.Find(_mechanism.Joints[joint].Body1 + 1);
        return a < b ? (a, b) : (b, a);
    }

    // Of all pairs whose joints hold something.
    private List<((int A, int B) Ends, List<double[]> Rows)> RowsOfPairs()
    {
        _rows.Clear();
        Span<ConstraintRow> rows = new ConstraintRow[JointModel.MaxRows];
        for (int j = 0; j < _mechanism.Joints.Length; j++)
        {
            JointModel joint = _mechanism.Joints[j];
            (int A, int B) ends = Ends(j);
            if (ends.A == ends.B)
            {
                continue;
            }

            int count = joint.PrepareLocked(Linkage.PoseOf(joint.Body0, _state.Poses), Linkage.PoseOf(joint.Body1, _state.Poses), rows, out _);
            for (int i = 0; i < count; i++)
            {
                AddRow(ends, Wrench(rows[i], joint, 1));
            }
        }

        foreach (PositionCoupling coupling in _mechanism.Couplings)
        {
            AddWithinPair(Terms(coupling));
        }

        var pairs = new List<((int A, int B) Ends, List<double[]> Rows)>();
        foreach (KeyValuePair<(int A, int B), List<double[]>> pair in _rows)
        {
            pairs.Add((pair.Key, pair.Value));
        }

        return pairs;
    }

    // A coupling between joints of one pair holds these two bodies.
    private void AddWithinPair(List<(int A, int B, double[] Wrench)> terms)
    {
        if (terms.Count == 0 || !terms.TrueForAll(term => term.A == terms[0].A && term.B == terms[0].B))
        {
            return;
        }

        var sum = new double[6];
        foreach ((_, _, double[] wrench) in terms)
        {
            for (int i = 0; i < 6; i++)
            {
                sum[i] += wrench[i];
            }
        }

        AddRow((terms[0].A, terms[0].B), sum);
    }

    // By sets of bodies, the lower one first. What lies inside of one set stands still.
    private List<(int A, int B, double[] Wrench)> Terms(PositionCoupling coupling)
    {
        var terms = new List<(int A, int B, double[] Wrench)>();
        Add(coupling.Driven, 1);
        for (int i = 0; i < coupling.Terms.Length; i++)
        {
            Add(coupling.Terms[i], -coupling.Ratios[i]);
        }

        return terms;

        void Add(int coordinate, double factor)
        {
            MechanismCoordinate source = _mechanism.Coordinates[coordinate];
            (int A, int B) ends = Ends(source.Joint);
            if (ends.A == ends.B)
            {
                return;
            }

            JointModel joint = source.JointRows;
            source.Evaluate(Linkage.PoseOf(joint.Body0, _state.Poses), Linkage.PoseOf(joint.Body1, _state.Poses), _state.Values[coordinate], out ConstraintRow row);
            terms.Add((ends.A, ends.B, Wrench(row, joint, _sets.Find(joint.Body0 + 1) == ends.A ? factor : -factor)));
        }
    }

    private double[] Wrench(in ConstraintRow row, JointModel joint, double scale)
    {
        PositionEquations.Wrench(_mechanism.Linkage, row, joint, _state.Poses, scale, out Vector3d force, out Vector3d moment);
        return new[] { force.X, force.Y, force.Z, moment.X, moment.Y, moment.Z };
    }

    private void AddRow((int A, int B) ends, double[] row)
    {
        double length = DenseVector.Length(row);
        if (length == 0)
        {
            return;
        }

        DenseVector.Divide(row, length);
        if (!_rows.TryGetValue(ends, out List<double[]>? rows))
        {
            _rows.Add(ends, rows = new List<double[]>());
        }

        rows.Add(row);
    }
}
