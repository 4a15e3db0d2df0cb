using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Least distance of a body's point from a place under the joints and limits: Newton's method on the light pull and the heavy
/// joint rows together, then back onto the joints alone. Limits met on the way are held while the pull presses on them.
/// </summary>
internal sealed class PointDrag
{
    // The pull is so light that the joints give way by little, and so heavy that it rules what they leave free.
    private const double Weight = 0.03;
    // A far target pulls no more than a near one in the same direction: the resting places are the same, and the
    // curvature stays small against J^T J. Lengths of the mechanism.
    private const double LongestPull = 0.5;
    private const double LeastDamping = 1e-9;
    private const double LeastFailedDamping = 1e-6;
    private const double LargestDamping = 1e3;
    private const double LargestStep = 0.2;
    private const double LeastStep = 1e-12;
    private const double LimitTolerance = 1e-10;
    private const double ReachedDistance = 1e-10;
    private const double LeastGain = 1e-7;
    private const int MaxIterations = 60;

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly int _body;
    private readonly RowPath _path;
    private readonly NormalEquations _normal;
    private readonly TreeMotion _motion;
    private readonly PositionEquations _equations;
    private readonly MechanismState _good;
    private readonly double[] _curvature;

    public PointDrag(Mechanism mechanism, NewtonSolver newton, int body)
    {
        _mechanism = mechanism;
        _newton = newton;
        _body = body;
        _path = RowPath.Between(mechanism.Tree, body, KinematicTree.Ground);
        var paths = new List<RowPath>(mechanism.Rows.All) { _path };
        _normal = new NormalEquations(mechanism.Tree, paths, newton.Cancellation);
        _motion = new TreeMotion(mechanism.Linkage, _normal.Firsts, _normal.Step.Length);
        _equations = new PositionEquations(mechanism.Linkage, _motion, _normal);
        _good = mechanism.NewState();
        _curvature = new double[_path.Width * _path.Width];
    }

    /// <summary>Drags until the target is reached or nothing is gained.</summary>
    /// <param name="state">Moved.</param>
    /// <param name="point">In the body's frame.</param>
    /// <param name="target">World.</param>
    public DriveResult Run(MechanismState state, Vector3d point, Vector3d target)
    {
        LimitSet limits = _newton.Limits;
        _newton.Iterations = 0;
        _newton.ClearDriven();
        limits.Begin(state);
        if (!_newton.Close(state))
        {
            return Result(DriveStatus.NotClosed, 0, -1);
        }

        // A state that closing pushed through a limit starts from there.
        limits.Begin(state);
        _good.CopyFrom(state);
        double start = Distance(state, point, target);
        double distance = start;
        double damping = LeastDamping;
        int limit = -1;
        bool withCurvature = true;
        for (int n = 0; n < MaxIterations && distance > ReachedDistance && damping < LargestDamping; n++)
        {
            _newton.Cancellation.ThrowIfCancellationRequested();
            bool released = Pull(state, point, target, damping, withCurvature, out double size);
            limits.Measure(state);
            bool closed = _newton.Close(state);
            limits.Measure(state);
            int broken = limits.Worst(LimitTolerance);
            if (closed && broken >= 0)
            {
                limits.IsActive[broken] = true;
                limit = broken;
                state.CopyFrom(_good);
                damping = released ? damping * 10 : damping;
                continue;
            }

            double now = Distance(state, point, target);
            if (!closed || !(now < distance))
            {
                // The curvature may have made the system indefinite: try without it before the step is made shorter.
                state.CopyFrom(_good);
                damping = withCurvature ? damping : Math.Max(damping, LeastFailedDamping) * 6;
                withCurvature = false;
                if (size < LeastStep)
                {
                    break;
                }

                continue;
            }

            double gain = distance - now;
            distance = now;
            _good.CopyFrom(state);
            withCurvature = true;
            damping = Math.Max(LeastDamping, damping * 0.4);
            if (gain < LeastGain * now && !released)
            {
                break;
            }
        }

        state.CopyFrom(_good);
        bool reached = distance <= ReachedDistance;
        DriveStatus status = reached ? DriveStatus.Reached : AnyActive(limits) ? DriveStatus.StoppedByLimit : DriveStatus.OutOfReach;
        return Result(status, reached ? 1 : Math.Max(0, 1 - distance / start), status == DriveStatus.OutOfReach ? -1 : limit);
    }

    private double Distance(MechanismState state, Vector3d point, Vector3d target) =>
        (state.Poses[_body].Point(point) - target).Length / _mechanism.Length;

    // One damped step; limits that it would leave towards the inside are released. True when any was.
    private bool Pull(MechanismState state, Vector3d point, Vector3d target, double damping, bool withCurvature, out double size)
    {
        LimitSet limits = _newton.Limits;
        Pose[] poses = state.Poses;
        _motion.Start(poses);
        _equations.Clear();
        _equations.AddClosures(poses, state.Values);
        for (int i = 0; i < limits.Count; i++)
        {
            if (limits.IsActive[i] && limits.Row(i, poses, out ConstraintRow row))
            {
                _equations.AddLimit(limits.JointOf(i), row, poses);
            }
        }

        Vector3d place = poses[_body].Point(point);
        Vector3d pull = target - place;
        double farther = pull.Length / (LongestPull * _mechanism.Length);
        Vector3d near = place + pull * (1 / Math.Max(1, farther));
        _equations.AddPoint(_path, place, near, Weight);
        if (withCurvature)
        {
            _equations.AddPointCurvature(_path, place, near, Weight, _curvature);
        }

        _normal.Solve(damping);
        _newton.Iterations++;
        double[] step = _normal.Step;
        bool released = false;
        for (int i = 0; i < limits.Count; i++)
        {
            if (!limits.IsActive[i])
            {
                continue;
            }

            // The least-squares residual of a held limit is the pull on it: positive is away from the limit.
            bool isThere = limits.Row(i, poses, out ConstraintRow row);
            double unit = row.Has(RowFlags.Angular) ? 1 : _mechanism.Length;
            if (!isThere || row.GeometricError / unit + _equations.Rate(limits.JointOf(i), row, poses, step) > 1e-12)
            {
                limits.IsActive[i] = false;
                released = true;
            }
        }

        size = 0;
        foreach (double entry in step)
        {
            size = Math.Max(size, Math.Abs(entry));
        }

        if (size > LargestStep)
        {
            for (int i = 0; i < step.Length; i++)
            {
                step[i] *= LargestStep / size;
            }
        }

        _motion.Move(poses, step);
        return released;
    }

    private static bool AnyActive(LimitSet limits) => Array.IndexOf(limits.IsActive, true) >= 0;

    private DriveResult Result(DriveStatus status, double fraction, int limit) =>
        new(status, fraction, _newton.Iterations, _newton.ErrorMetres, _newton.ErrorDegrees, 0, limit < 0 ? null : LimitNames.Of(_good, _newton.Limits, limit));
}
