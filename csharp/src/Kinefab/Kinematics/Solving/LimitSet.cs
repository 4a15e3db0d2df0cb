using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Which limit of a joint.</summary>
internal enum LimitSide : byte
{
    /// <summary>Lower swing limit, or the cone.</summary>
    SwingLower,
    SwingUpper,
    TwistLower,
    TwistUpper,
    Linear,
}

/// <summary>Distances of a mechanism's joints from their limits, positive inside, and which limits are held as equations.</summary>
internal sealed class LimitSet
{
    /// <summary>Sides of a joint.</summary>
    public const int Sides = 5;

    private readonly Linkage _linkage;
    private readonly int[] _joints;
    private readonly double[] _slack;

    // Of each joint the coordinate of a limited twist, or -1, and that twist with its whole turns where it was measured last: the joint's row
    // wraps at half a turn, so that a step over a narrow gap between its stops would come out inside again.
    private readonly int[] _coordinates;
    private readonly double[] _twists;
    private readonly ConstraintRow[] _rows = new ConstraintRow[JointModel.MaxRows];

    public LimitSet(Linkage linkage)
    {
        _linkage = linkage;
        var joints = new List<int>();
        for (int j = 0; j < linkage.Joints.Length; j++)
        {
            if (linkage.Joints[j].Layout().Limited != 0)
            {
                joints.Add(j);
            }
        }

        _joints = joints.ToArray();
        Distances = new double[_joints.Length * Sides];
        _slack = new double[Distances.Length];
        IsActive = new bool[Distances.Length];
        _twists = new double[_joints.Length];
        _coordinates = Array.ConvertAll(_joints, joint => Array.FindIndex(
            linkage.Coordinates, c => c.Joint == joint && c.Coordinate is Coordinate.Angle or Coordinate.AngularX && linkage.Joints[joint].Layout().TwistLimits > 0));
    }

    /// <summary>Number of limits, Sides for each limited joint.</summary>
    public int Count => Distances.Length;

    /// <summary>For each limit its distance at the last Measure, lengths of the mechanism or radians; infinite where there is none.</summary>
    public double[] Distances { get; }

    /// <summary>For each limit whether it is held as an equation.</summary>
    public bool[] IsActive { get; }

    /// <summary>The joint of a limit.</summary>
    public int JointOf(int limit) => _joints[limit / Sides];

    /// <summary>Which limit of its joint.</summary>
    public static LimitSide SideOf(int limit) => (LimitSide)(limit % Sides);

    /// <summary>Frees all limits; those broken at the start may stay as broken as they are.</summary>
    public void Begin(MechanismState state)
    {
        Array.Clear(IsActive, 0, IsActive.Length);
        Array.Clear(_slack, 0, _slack.Length);
        Measure(state);
        for (int i = 0; i < Count; i++)
        {
            _slack[i] = Math.Min(0, Distances[i]);
        }

        Measure(state);
    }

    /// <summary>Finds all distances.</summary>
    public void Measure(MechanismState state)
    {
        for (int i = 0; i < _joints.Length; i++)
        {
            if (_coordinates[i] >= 0)
            {
                _twists[i] = state.Values[_coordinates[i]] * (_linkage.Coordinates[_coordinates[i]].IsAlongRows ? 1 : -1);
            }

            int count = Prepare(_joints[i], state.Poses);
            int swings = AngularLimits(count) - _linkage.Joints[_joints[i]].Layout().TwistLimits;
            for (int s = 0; s < Sides; s++)
            {
                Distances[i * Sides + s] = double.PositiveInfinity;
            }

            int angular = 0;
            for (int r = 0; r < count; r++)
            {
                if (_rows[r].Has(RowFlags.Limit))
                {
                    LimitSide side = Side(_rows[r], swings, ref angular);
                    int limit = i * Sides + (int)side;
                    double distance = _rows[r].Has(RowFlags.Angular) ? _rows[r].GeometricError + Turns(i, side, _rows[r]) : _rows[r].GeometricError / _linkage.Length;
                    Distances[limit] = distance - _slack[limit];
                }
            }
        }
    }

    /// <summary>The free limit that is broken most by more than the tolerance, or -1.</summary>
    public int Worst(double tolerance)
    {
        int worst = -1;
        double least = -tolerance;
        for (int i = 0; i < Count; i++)
        {
            if (!IsActive[i] && Distances[i] < least)
            {
                least = Distances[i];
                worst = i;
            }
        }

        return worst;
    }

    /// <summary>The row of a limit and its distance; false when the joint has none there now.</summary>
    public bool Row(int limit, Pose[] poses, out ConstraintRow row)
    {
        int joint = JointOf(limit);
        int count = Prepare(joint, poses);
        int swings = AngularLimits(count) - _linkage.Joints[joint].Layout().TwistLimits;
        int angular = 0;
        for (int r = 0; r < count; r++)
        {
            if (_rows[r].Has(RowFlags.Limit) && Side(_rows[r], swings, ref angular) == SideOf(limit))
            {
                row = _rows[r];
                row.GeometricError += Turns(limit / Sides, SideOf(limit), row);
                row.GeometricError -= row.Has(RowFlags.Angular) ? _slack[limit] : _slack[limit] * _linkage.Length;
                return true;
            }
        }

        row = default;
        return false;
    }

    // What whole turns add to the distance of a twist from one of its ends, radians: 0 while the row counts as the coordinate does.
    private double Turns(int i, LimitSide side, in ConstraintRow row)
    {
        if (_coordinates[i] < 0 || side is not (LimitSide.TwistLower or LimitSide.TwistUpper))
        {
            return 0;
        }

        AngularLimit range = _linkage.Joints[_joints[i]] is RevoluteJoint hinge ? hinge.Limit : ((D6Joint)_linkage.Joints[_joints[i]]).TwistLimit;
        double angle = side == LimitSide.TwistLower ? range.Lower + row.GeometricError : range.Upper - row.GeometricError;
        double turns = SwingTwist.Nearest(angle, _twists[i]) - angle;
        return side == LimitSide.TwistLower ? turns : -turns;
    }

    private int Prepare(int joint, Pose[] poses)
    {
        JointModel rows = _linkage.Joints[joint];
        return rows.Prepare(Linkage.PoseOf(rows.Body0, poses), Linkage.PoseOf(rows.Body1, poses), _rows);
    }

    private int AngularLimits(int count)
    {
        int angular = 0;
        for (int r = 0; r < count; r++)
        {
            angular += _rows[r].Has(RowFlags.Limit | RowFlags.Angular) ? 1 : 0;
        }

        return angular;
    }

    // A joint's limit rows come in this order: cone or swing (lower, upper), twist (lower, upper), distance.
    private static LimitSide Side(in ConstraintRow row, int swings, ref int angular)
    {
        if (!row.Has(RowFlags.Angular))
        {
            return LimitSide.Linear;
        }

        int place = angular++;
        return (LimitSide)(place < swings ? place : (int)LimitSide.TwistLower + place - swings);
    }
}
