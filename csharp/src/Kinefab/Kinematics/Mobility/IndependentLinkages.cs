using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Takes a linkage apart into its blocks, each as large as what it moves: thousands of mechanisms cost what they cost one by one.</summary>
internal sealed class IndependentLinkages
{
    private readonly Linkage _whole;
    private readonly int[] _blockOf;
    private readonly List<int>[] _movers;
    private readonly List<int>[] _joints;
    private readonly List<int>[] _couplings;
    private readonly List<int>[] _jointsOf;
    private readonly List<int>[] _couplingsOf;

    /// <summary>Of a linkage.</summary>
    /// <param name="whole">Which.</param>
    /// <param name="blocks">Its blocks.</param>
    /// <param name="firsts">For each body the column of its first freedom.</param>
    public IndependentLinkages(Linkage whole, FreedomBlocks blocks, int[] firsts)
    {
        _whole = whole;
        _blockOf = new int[whole.BodyCount];
        _movers = Lists(blocks.Columns.Count);
        _joints = Lists(blocks.Columns.Count);
        _couplings = Lists(blocks.Columns.Count);
        _jointsOf = Lists(whole.BodyCount);
        _couplingsOf = Lists(whole.Joints.Length);
        Array.Fill(_blockOf, -1);
        foreach (int body in whole.Tree.Order)
        {
            _blockOf[body] = whole.Tree.Freedoms[body] > 0 ? blocks.BlockOf[firsts[body]] : -1;
            if (_blockOf[body] >= 0)
            {
                _movers[_blockOf[body]].Add(body);
                Add(_joints, _blockOf[body], whole.Tree.TreeJoints[body]);
            }
        }

        foreach (int joint in whole.Tree.Closures)
        {
            // One that holds nothing ties nothing: its two bodies may stand in different blocks.
            if (MotionSubspace.Rows(whole.Joints[joint]) > 0)
            {
                Add(_joints, BlockOf(whole.Rows.Joints[joint]), joint);
            }
        }

        for (int i = 0; i < whole.Couplings.Length; i++)
        {
            int block = BlockOf(whole.Rows.Couplings[i]);
            Add(_couplings, block, i);
            foreach (int joint in CoupledJoints(whole.Couplings[i]))
            {
                Add(_joints, block, joint);
                _couplingsOf[joint].Add(i);
            }
        }

        for (int joint = 0; joint < whole.Joints.Length; joint++)
        {
            Add(_jointsOf, whole.Joints[joint].Body0, joint);
            Add(_jointsOf, whole.Joints[joint].Body1, joint);
        }
    }

    public int Count => _movers.Length;

    /// <summary>For each block the bodies that have freedoms in it, parents first.</summary>
    public IReadOnlyList<int> Movers(int block) => _movers[block];

    /// <summary>The block of a body's freedoms, or -1.</summary>
    public int BlockOf(int body) => _blockOf[body];

    /// <summary>A block as a linkage of its own, as the bodies stand.</summary>
    public IndependentLinkage Make(int block, Pose[] poses)
    {
        KinematicTree tree = _whole.Tree;
        var moving = new HashSet<int>(_movers[block]);
        int top = int.MaxValue;
        foreach (int body in _movers[block])
        {
            top = Math.Min(top, tree.Depths[body]);
        }

        foreach (int body in _movers[block])
        {
            Carry(tree.Parents[body]);
        }

        var joints = new SortedSet<int>(_joints[block]);
        foreach (int joint in _joints[block])
        {
            Carry(tree.Moving(_whole.Joints[joint].Body0));
            Carry(tree.Moving(_whole.Joints[joint].Body1));
        }

        foreach (int body in moving)
        {
            joints.Add(tree.TreeJoints[body]); // what moves with others hangs on them
        }

        var bodies = new SortedSet<int>(moving);
        foreach (int joint in joints)
        {
            bodies.Add(_whole.Joints[joint].Body0);
            bodies.Add(_whole.Joints[joint].Body1);
        }

        bodies.Remove(JointModel.World);
        return Make(moving, ToArray(bodies), ToArray(joints), _couplings[block], joint => Joint(block, joint, poses), new List<(int, D6Joint)>());

        // What stands between two bodies of the block, the lower one's parent or a closing joint's end, moves with the upper one.
        void Carry(int body)
        {
            var between = new List<int>();
            while (body >= 0 && tree.Depths[body] >= top && !moving.Contains(body))
            {
                between.Add(body);
                body = tree.Parents[body];
            }

            if (body >= 0 && moving.Contains(body))
            {
                moving.UnionWith(between);
            }
        }
    }

    /// <summary>Some bodies, which hang together, as one body with all that joins it to others, which stand still.</summary>
    /// <param name="moving">The bodies.</param>
    /// <param name="poses">Where they are against each other.</param>
    public IndependentLinkage AsOne(HashSet<int> moving, Pose[] poses)
    {
        var joints = new SortedSet<int>();
        foreach (int body in moving)
        {
            joints.UnionWith(_jointsOf[body]);
        }

        var couplings = new SortedSet<int>();
        foreach (int joint in joints)
        {
            couplings.UnionWith(_couplingsOf[joint]);
        }

        foreach (int i in couplings)
        {
            joints.UnionWith(CoupledJoints(_whole.Couplings[i]));
        }

        var bodies = new SortedSet<int>(moving);
        foreach (int joint in joints)
        {
            bodies.Add(_whole.Joints[joint].Body0);
            bodies.Add(_whole.Joints[joint].Body1);
        }

        bodies.Remove(JointModel.World);
        var inner = new List<int>();
        foreach (int joint in joints)
        {
            if (moving.Contains(_whole.Joints[joint].Body0) && moving.Contains(_whole.Joints[joint].Body1))
            {
                inner.Add(joint);
            }
        }

        // The inner joints stay beside what holds them, since couplings may count from their coordinates.
        return Make(moving, ToArray(bodies), ToArray(joints), couplings, joint => _whole.Joints[joint], inner.ConvertAll(joint => (joint, Held(_whole.Joints[joint], poses))));
    }

    private IEnumerable<int> CoupledJoints(PositionCoupling coupling)
    {
        yield return _whole.Coordinates[coupling.Driven].Joint;
        foreach (int term in coupling.Terms)
        {
            yield return _whole.Coordinates[term].Joint;
        }
    }

    // As a block has it.
    private JointModel Joint(int block, int joint, Pose[] poses)
    {
        int child = _whole.Tree.ChildOf[joint];
        bool isHeld = child >= 0 && _whole.Tree.Freedoms[child] > 0 && _blockOf[child] != block;
        return isHeld ? Held(_whole.Joints[joint], poses) : _whole.Joints[joint];
    }

    // jointOf: what stands for one of the whole's joints, between which bodies it is being no matter. beside: what else there is between
    // the bodies of some of them.
    private IndependentLinkage Make(
        HashSet<int> moving, int[] bodies, int[] joints, IEnumerable<int> coupled, Func<int, JointModel> jointOf, List<(int Joint, D6Joint Holds)> beside)
    {
        var isFixed = new bool[bodies.Length];
        for (int i = 0; i < bodies.Length; i++)
        {
            isFixed[i] = !moving.Contains(bodies[i]);
        }

        var own = new JointModel[joints.Length + beside.Count];
        var isClosure = new bool[own.Length];
        for (int j = 0; j < joints.Length; j++)
        {
            JointModel joint = _whole.Joints[joints[j]];
            isClosure[j] = _whole.Tree.ChildOf[joints[j]] < 0;
            own[j] = jointOf(joints[j]).Between(IndexOf(joint.Body0), IndexOf(joint.Body1));
        }

        for (int i = 0; i < beside.Count; i++)
        {
            JointModel joint = _whole.Joints[beside[i].Joint];
            own[joints.Length + i] = beside[i].Holds.Between(IndexOf(joint.Body0), IndexOf(joint.Body1));
            isClosure[Array.BinarySearch(joints, beside[i].Joint)] = true;
        }

        var coordinates = new List<int>();
        var ownCoordinates = new List<MechanismCoordinate>();
        var couplings = new List<PositionCoupling>();
        foreach (int i in coupled)
        {
            PositionCoupling coupling = _whole.Couplings[i];
            couplings.Add(coupling.Between(Coordinate(coupling.Driven), Array.ConvertAll(coupling.Terms, Coordinate)));
        }

        var linkage = new Linkage(isFixed, own, isClosure, ownCoordinates.ToArray(), couplings.ToArray(), _whole.Origin, _whole.Length);
        return new IndependentLinkage(linkage, bodies, joints, coordinates.ToArray());

        int IndexOf(int body) => body < 0 ? JointModel.World : Array.BinarySearch(bodies, body);

        int Coordinate(int whole)
        {
            int known = coordinates.IndexOf(whole);
            if (known >= 0)
            {
                return known;
            }

            int joint = Array.BinarySearch(joints, _whole.Coordinates[whole].Joint);
            coordinates.Add(whole);
            ownCoordinates.Add(_whole.Coordinates[whole].On(joint, own[joint]));
            return coordinates.Count - 1;
        }
    }

    // A freedom of another block, or of none, stands still where it lies between two bodies of this one.
    private static D6Joint Held(JointModel joint, Pose[] poses)
    {
        Pose at = Linkage.PoseOf(joint.Body1, poses) * joint.Frame1;
        return new D6Joint { Frame0 = Linkage.PoseOf(joint.Body0, poses).Inverse() * at, Frame1 = joint.Frame1 };
    }

    private int BlockOf(RowPath path) => path.Bodies.Length == 0 ? -1 : _blockOf[path.Bodies[0]];

    private static void Add(List<int>[] lists, int block, int item)
    {
        if (block >= 0 && item >= 0)
        {
            lists[block].Add(item);
        }
    }

    private static List<int>[] Lists(int count)
    {
        var lists = new List<int>[count];
        for (int i = 0; i < count; i++)
        {
            lists[i] = new List<int>();
        }

        return lists;
    }

    private static int[] ToArray(SortedSet<int> set)
    {
        var array = new int[set.Count];
        set.CopyTo(array);
        return array;
    }
}
