using System;
using System.Runtime.InteropServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Moves the bodies along the freedoms of the tree's joints, each carried by its parent, and keeps those joints closed to
/// rounding. Holds the twists of the freedoms at the pose it was last called for.
/// </summary>
internal sealed class TreeMotion
{
    // A joint whose free motions are no group (one locked swing, one locked twist) is left by a finite step and brought
    // back by Newton's method; all others are off by rounding alone.
    private const int MaxCorrections = 6;
    private const double Closed = 1e-15;

    private readonly Linkage _linkage;
    private readonly KinematicTree _tree;
    private readonly int[] _firsts;
    private readonly int[] _locked;
    private readonly Vector3d[] _axes;
    private readonly Vector3d[] _anchors;
    private readonly int[] _translations;
    private readonly Pose[] _before;
    private readonly Pose[] _found;
    private readonly bool[] _moved;
    private readonly ConstraintRow[] _rows = new ConstraintRow[JointModel.MaxRows];

    public TreeMotion(Linkage linkage, int[] firsts, int freedoms)
    {
        _linkage = linkage;
        _tree = linkage.Tree;
        _firsts = firsts;
        int n = linkage.BodyCount;
        _locked = new int[n];
        foreach (int body in _tree.Order)
        {
            _locked[body] = MotionSubspace.LockedAxes(JointOf(body));
        }

        _axes = new Vector3d[freedoms];
        Linear = new Vector3d[freedoms];
        Angular = new Vector3d[freedoms];
        _anchors = new Vector3d[n];
        _translations = new int[n];
        _before = new Pose[n];
        _found = new Pose[n];
        _moved = new bool[n];
        WorstError = double.PositiveInfinity;
    }

    /// <summary>For each freedom the velocity at the mechanism's origin, in its lengths.</summary>
    public Vector3d[] Linear { get; }

    /// <summary>For each freedom the angular velocity.</summary>
    public Vector3d[] Angular { get; }

    /// <summary>Worst error of the tree's joints that corrections could not take away: linear in the mechanism's lengths, or radians.</summary>
    public double WorstError { get; private set; }

    /// <summary>Closes the tree's joints and finds the freedoms' twists.</summary>
    public void Start(Pose[] poses)
    {
        // Where the mechanism stands already and is closed, every bit would be the same again.
        if (!(WorstError <= Closed) || !MemoryMarshal.AsBytes(poses.AsSpan()).SequenceEqual(MemoryMarshal.AsBytes(_found.AsSpan())))
        {
            Move(poses, ReadOnlySpan<double>.Empty);
        }
    }

    /// <summary>
    /// Moves the bodies by a step along the freedoms whose twists were last found (lengths of the mechanism and radians;
    /// empty: none), then closes the tree's joints and finds the twists anew.
    /// </summary>
    public void Move(Pose[] poses, ReadOnlySpan<double> step)
    {
        Array.Copy(poses, _before, poses.Length);
        WorstError = 0;
        foreach (int body in _tree.Order)
        {
            bool moved = step.Length > 0 && Step(ref poses[body], body, step);
            int parent = _tree.Parents[body];
            if (parent >= 0 && _moved[parent])
            {
                poses[body] = poses[parent] * (_before[parent].Inverse() * poses[body]);
                moved = true;
            }

            if (moved)
            {
                poses[body] = new Pose(poses[body].Position, poses[body].Rotation.Normalized());
            }

            JointModel? joint = JointOf(body);
            JointFrames frames = default;
            if (joint is not null)
            {
                moved |= Correct(joint, body, poses, out frames);
            }

            _moved[body] = moved;
            FindTwists(joint, body, poses[body], frames);
        }

        Array.Copy(poses, _found, poses.Length);
    }

    private JointModel? JointOf(int body) => _tree.TreeJoints[body] < 0 ? null : _linkage.Joints[_tree.TreeJoints[body]];

    // The parent stands still here: rotation about the anchor first, then translation along the axes, which turn with the
    // child where they are its own.
    private bool Step(ref Pose pose, int body, ReadOnlySpan<double> step)
    {
        int first = _firsts[body];
        int count = _tree.Freedoms[body];
        int translations = _translations[body];
        Vector3d slide = Vector3d.Zero;
        Vector3d turn = Vector3d.Zero;
        for (int i = 0; i < count; i++)
        {
            if (i < translations)
            {
                slide += _axes[first + i] * (step[first + i] * _linkage.Length);
            }
            else
            {
                turn += _axes[first + i] * step[first + i];
            }
        }

        double angle = turn.Length;
        if (angle == 0 && slide == Vector3d.Zero)
        {
            return false;
        }

        Quaterniond rotation = Quaterniond.AxisAngle(turn.Normalized(), angle);
        Vector3d anchor = _anchors[body];
        slide = _tree.ChildIsBody0[body] ? rotation * slide : slide;
        pose = new Pose(anchor + rotation * (pose.Position - anchor) + slide, rotation * pose.Rotation);
        return true;
    }

    // Newton's step of one joint's locked rows, moving the child alone: the linear rows' axes are orthonormal and the
    // angular ones orthogonal, so each row is answered by itself.
    private bool Correct(JointModel joint, int body, Pose[] poses, out JointFrames frames)
    {
        bool moved = false;
        double previous = double.PositiveInfinity;
        for (int n = 0; ; n++)
        {
            int count = joint.PrepareLocked(Linkage.PoseOf(joint.Body0, poses), Linkage.PoseOf(joint.Body1, poses), _rows, out frames);
            Vector3d slide = Vector3d.Zero;
            Vector3d turn = Vector3d.Zero;
            double worst = 0;
            for (int i = 0; i < count; i++)
            {
                ref ConstraintRow row = ref _rows[i];
                if (row.Has(RowFlags.Angular))
                {
                    Vector3d answer = row.Angular1 * (row.GeometricError / row.Angular1.LengthSquared);
                    turn += answer;
                    worst = Math.Max(worst, answer.Length);
                }
                else
                {
                    slide += row.Linear1 * row.GeometricError;
                    worst = Math.Max(worst, Math.Abs(row.GeometricError) / _linkage.Length);
                }
            }

            if (worst <= Closed || n == MaxCorrections || worst > 0.5 * previous)
            {
                WorstError = Math.Max(WorstError, worst);
                return moved;
            }

            previous = worst;
            moved = true;
            double sign = _tree.ChildIsBody0[body] ? -1 : 1;
            Vector3d anchor = frames.P1;
            Quaterniond rotation = Quaterniond.AxisAngle(turn.Normalized(), sign * turn.Length);
            Pose pose = poses[body];
            poses[body] = new Pose(anchor + rotation * (pose.Position - anchor) + slide * sign, (rotation * pose.Rotation).Normalized());
        }
    }

    private void FindTwists(JointModel? joint, int body, in Pose pose, in JointFrames frames)
    {
        int count = _tree.Freedoms[body];
        if (count == 0)
        {
            return;
        }

        int first = _firsts[body];
        Vector3d anchor = joint is null ? pose.Position : frames.P1;
        int translations = joint is null ? MotionSubspace.Free(_axes, first) : MotionSubspace.Directions(_locked[body], frames, _axes, first);
        _anchors[body] = anchor;
        _translations[body] = translations;
        Vector3d lever = (anchor - _linkage.Origin) * (1 / _linkage.Length);
        for (int i = 0; i < count; i++)
        {
            Vector3d axis = _axes[first + i];
            Linear[first + i] = i < translations ? axis : Vector3d.Cross(lever, axis);
            Angular[first + i] = i < translations ? Vector3d.Zero : axis;
        }
    }
}
