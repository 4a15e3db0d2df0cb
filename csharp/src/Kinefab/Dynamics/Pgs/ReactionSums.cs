using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Force and torque of a step's rows that count, moved to the anchor. Few ask for them, so they are summed up when they are read, and
/// in the step itself only for joints that can break. Source: DySolverConstraints.cpp, writeBack1D.
/// </summary>
internal sealed class ReactionSums
{
    private readonly MultibodySystem _mechanism;
    private readonly JointBlock[] _blocks;
    private readonly SweepRows _rows;

    // At which the rows were made.
    private readonly Pose[] _poses;
    private readonly Action<JointReaction[]> _write;
    private int _count;
    private double _dt;

    public ReactionSums(MultibodySystem mechanism, JointBlock[] blocks, SweepRows rows, Pose[] poses)
    {
        _mechanism = mechanism;
        _blocks = blocks;
        _rows = rows;
        _poses = poses;
        _write = Write;
    }

    /// <summary>
    /// Breaks the joints that passed their limits: they acted in full in this step and are gone in the next. True when one did.
    /// </summary>
    public bool Break(int blocks, double dt)
    {
        _count = blocks;
        _dt = dt;
        _mechanism.UnreadReactions = _write;
        bool broken = false;
        for (int b = 0; b < blocks; b++)
        {
            JointModel joint = _mechanism.Joints[_blocks[b].Joint];
            if (joint.CanBreak)
            {
                JointReaction impulse = Impulse(_blocks[b], joint);
                joint.IsBroken = Exceeds(impulse.Force, joint.BreakForce * dt) || Exceeds(impulse.Torque, joint.BreakTorque * dt);
                broken |= joint.IsBroken;
            }
        }

        return broken;
    }

    private static bool Exceeds(Vector3d impulse, double limit) => impulse.LengthSquared > limit * limit;

    private void Write(JointReaction[] reactions)
    {
        double inverseDt = 1 / _dt;
        for (int b = 0; b < _count; b++)
        {
            int joint = _blocks[b].Joint;
            JointReaction impulse = Impulse(_blocks[b], _mechanism.Joints[joint]);
            reactions[joint] = new JointReaction { Force = impulse.Force * inverseDt, Torque = impulse.Torque * inverseDt };
        }
    }

    // N s and N m s.
    private JointReaction Impulse(in JointBlock block, JointModel joint)
    {
        // On the stack: several threads may read reactions.
        Span<Vector3d> angulars = stackalloc Vector3d[block.End - block.Start];
        _rows.Angular0.AsSpan(block.Start, angulars.Length).CopyTo(angulars);
        Preprocessing.Repeat(_rows, block, angulars.Slice(block.Equalities - block.Start));
        Vector3d force = Vector3d.Zero;
        Vector3d torque = Vector3d.Zero;
        for (int i = 0; i < angulars.Length; i++)
        {
            int row = block.Start + i;
            if (_rows.Counts[row])
            {
                force += _rows.Vectors[row].Linear.Vector * _rows.Impulses[row];
                torque += angulars[i] * _rows.Impulses[row];
            }
        }

        Vector3d lever = _poses[block.Body1].Point(joint.Frame1.Position) - _poses[block.Body0].Position;
        return new JointReaction { Force = force, Torque = torque - Vector3d.Cross(lever, force) };
    }
}
