using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Turns the joints' rows into rows over the tree's freedoms. All are dimensionless: lengths over the mechanism's length,
/// angles in radians, so that C is an error in lengths or radians and J its rate.
/// </summary>
internal sealed partial class PositionEquations
{
    private const double LeastEntry = 1e-12;

    private readonly Linkage _linkage;
    private readonly TreeMotion _motion;
    private readonly NormalEquations _normal;
    private readonly ConstraintRow[] _rows = new ConstraintRow[JointModel.MaxRows];
    private readonly double[] _row;

    // Of the coordinates of the coupling at hand.
    private readonly ConstraintRow[] _coupled;

    // For each coordinate the value to which it is being driven; NaN: it is not.
    private readonly double[] _held;

    public PositionEquations(Linkage linkage, TreeMotion motion, NormalEquations normal)
    {
        _linkage = linkage;
        _motion = motion;
        _normal = normal;
        _row = new double[Math.Max(1, normal.Step.Length)];
        _held = new double[linkage.Coordinates.Length];
        Array.Fill(_held, double.NaN);
        int most = 0;
        foreach (PositionCoupling coupling in linkage.Couplings)
        {
            most = Math.Max(most, coupling.Terms.Length + 1);
        }

        _coupled = new ConstraintRow[most];
    }

    /// <summary>Sum of the squares of all errors since Clear.</summary>
    public double Squares { get; private set; }

    /// <summary>Largest error since Clear.</summary>
    public double Worst { get; private set; }

    /// <summary>Largest error of the joints and couplings since Clear, lengths of the mechanism.</summary>
    public double WorstLinear { get; private set; }

    /// <summary>Largest error of the joints and couplings since Clear, radians.</summary>
    public double WorstAngular { get; private set; }

    /// <summary>Takes every row added from now on; null: none.</summary>
    public PackedRows? Sink { get; set; }

    /// <summary>Forgets all rows.</summary>
    public void Clear()
    {
        _normal.Clear();
        Squares = 0;
        Worst = 0;
        WorstLinear = 0;
        WorstAngular = 0;
    }

    /// <summary>The locked rows of the loop-closing joints and the couplings.</summary>
    public void AddClosures(Pose[] poses, double[] values)
    {
        foreach (int j in _linkage.Tree.Closures)
        {
            JointModel joint = _linkage.Joints[j];
            int count = joint.PrepareLocked(Linkage.PoseOf(joint.Body0, poses), Linkage.PoseOf(joint.Body1, poses), _rows, out _);
            for (int i = 0; i < count; i++)
            {
                AddJointRow(j, _rows[i], poses);
            }
        }

        for (int i = 0; i < _linkage.Couplings.Length; i++)
        {
            AddCoupling(i, poses, values);
        }
    }

    /// <summary>A coordinate held at a value. C = q - target.</summary>
    public void AddCoordinate(int coordinate, double target, Pose[] poses, double[] values)
    {
        MechanismCoordinate source = _linkage.Coordinates[coordinate];
        RowPath path = _linkage.Rows.Joints[source.Joint];
        if (IsHeldAmongOthers(coordinate) && AngleError(coordinate, target, 1, poses, values, out ConstraintRow angle, out _) is double error)
        {
            Pack(path, angle, source.JointRows, poses, 1);
            Add(path, error);
            return;
        }

        double q = Evaluate(coordinate, poses, values, out ConstraintRow row);
        double unit = UnitOf(coordinate);
        Pack(path, row, source.JointRows, poses, 1 / unit);
        Add(path, (q - target) / unit);
    }

    /// <summary>One row of a joint, as it stands.</summary>
    public void AddLimit(int joint, in ConstraintRow row, Pose[] poses)
    {
        RowPath path = _linkage.Rows.Joints[joint];
        double unit = row.Has(RowFlags.Angular) ? 1 : _linkage.Length;
        Pack(path, row, _linkage.Joints[joint], poses, 1 / unit);
        Add(path, row.GeometricError / unit);
    }

    /// <summary>One freedom of a tree joint's child as an unknown of its own. C as given.</summary>
    public void AddFreedom(int joint, int place, double c)
    {
        RowPath path = _linkage.Rows.Joints[joint];
        Array.Clear(_row, 0, path.Width);
        _row[place] = 1;
        Add(path, c);
    }

    /// <summary>The rate that the last step gives a row of a joint.</summary>
    public double Rate(int joint, in ConstraintRow row, Pose[] poses, double[] step)
    {
        RowPath path = _linkage.Rows.Joints[joint];
        Pack(path, row, _linkage.Joints[joint], poses, row.Has(RowFlags.Angular) ? 1 : 1 / _linkage.Length);
        double rate = 0;
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            int first = _normal.Firsts[path.Bodies[k]];
            for (int i = path.Starts[k]; i < path.Starts[k + 1]; i++)
            {
                rate += _row[i] * step[first + i - path.Starts[k]];
            }
        }

        return rate;
    }

    /// <summary>A point pulled to a place: C = weight (p - target), one row an axis.</summary>
    /// <param name="path">From the body to the ground.</param>
    /// <param name="point">World.</param>
    /// <param name="target">World.</param>
    /// <param name="weight">Of the three rows.</param>
    public void AddPoint(RowPath path, Vector3d point, Vector3d target, double weight)
    {
        for (int axis = 0; axis < 3; axis++)
        {
            Vector3d force = (axis == 0 ? Vector3d.UnitX : axis == 1 ? Vector3d.UnitY : Vector3d.UnitZ) * weight;
            Vector3d moment = Vector3d.Cross((point - _linkage.Origin) * (1 / _linkage.Length), force);
            Pack(path, force, moment);
            Add(path, weight * (point - target)[axis] / _linkage.Length);
        }
    }

    /// <summary>
    /// The curvature of a pulled point's path, weight^2 (p - target).d2p/dy_i dy_j: d2p is w_i x dp/dy_j where freedom i
    /// carries freedom j. Paths start at the body, so a later freedom carries an earlier one.
    /// </summary>
    public void AddPointCurvature(RowPath path, Vector3d point, Vector3d target, double weight, double[] matrix)
    {
        Vector3d lever = (point - _linkage.Origin) * (1 / _linkage.Length);
        Vector3d error = (point - target) * (weight * weight / _linkage.Length);
        int width = path.Width;
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            for (int i = path.Starts[k]; i < path.Starts[k + 1]; i++)
            {
                Vector3d turn = _motion.Angular[_normal.Firsts[path.Bodies[k]] + i - path.Starts[k]];
                for (int l = 0; l <= k; l++)
                {
                    for (int j = path.Starts[l]; j < path.Starts[l + 1]; j++)
                    {
                        int freedom = _normal.Firsts[path.Bodies[l]] + j - path.Starts[l];
                        Vector3d rate = _motion.Linear[freedom] + Vector3d.Cross(_motion.Angular[freedom], lever);
                        double entry = Vector3d.Dot(error, Vector3d.Cross(turn, rate));
                        matrix[i * width + j] = entry;
                        matrix[j * width + i] = entry;
                    }
                }
            }
        }

        _normal.AddMatrix(path, matrix.AsSpan(0, width * width));
    }

    /// <summary>A coordinate's value, unwrapped against the last one, which it replaces.</summary>
    public double Evaluate(int coordinate, Pose[] poses, double[] values, out ConstraintRow row)
    {
        MechanismCoordinate source = _linkage.Coordinates[coordinate];
        JointModel joint = source.JointRows;
        double last = values[coordinate];
        values[coordinate] = source.Evaluate(Linkage.PoseOf(joint.Body0, poses), Linkage.PoseOf(joint.Body1, poses), last, out row);
        if (_linkage.IsCoupledAmongOthers[coordinate] && SquareOf(coordinate, poses) < NoAngle * NoAngle)
        {
            values[coordinate] = row.GeometricError = last;
        }

        return values[coordinate];
    }

    /// <summary>
    /// A row as a wrench about the mechanism's origin, for twists in its lengths. Body 1's side is the exact derivative: PhysX shortens
    /// body 0's lever by the error.
    /// </summary>
    public static void Wrench(Linkage linkage, in ConstraintRow row, JointModel joint, Pose[] poses, double scale, out Vector3d force, out Vector3d moment)
    {
        force = row.Linear1 * (scale * linkage.Length);
        moment = row.Angular1 * scale;
        if (!row.Has(RowFlags.Angular))
        {
            moment += Vector3d.Cross((Linkage.PoseOf(joint.Body1, poses).Position - linkage.Origin) * scale, row.Linear1);
        }
    }

    private void AddJointRow(int joint, in ConstraintRow row, Pose[] poses)
    {
        RowPath path = _linkage.Rows.Joints[joint];
        if (row.Has(RowFlags.Angular))
        {
            // PhysX's locked angles are half angles, the row's length tells by how much.
            double scale = 1 / row.Angular1.Length;
            double c = row.GeometricError * scale;
            WorstAngular = Math.Max(WorstAngular, Math.Abs(c));
            Pack(path, row, _linkage.Joints[joint], poses, scale);
            Add(path, c);
        }
        else
        {
            double c = row.GeometricError / _linkage.Length;
            WorstLinear = Math.Max(WorstLinear, Math.Abs(c));
            Pack(path, row, _linkage.Joints[joint], poses, 1 / _linkage.Length);
            Add(path, c);
        }
    }

    // C = (q - sum of r_i q_i - offset) / u; dC = row / u - sum of r_i row_i / u, all over the steepest of 1 and |r_i| u_i / u whose
    // coordinate can change, so that a steep ratio weighs no more than a joint, and no less where the other side stands still.
    private void AddCoupling(int index, Pose[] poses, double[] values)
    {
        PositionCoupling coupling = _linkage.Couplings[index];
        RowPath path = _linkage.Rows.Couplings[index];
        double unit = UnitOf(coupling.Driven);
        double steepest = Moves(coupling.Driven) ? 1 : 0;
        for (int i = 0; i < coupling.Terms.Length; i++)
        {
            double steep = Moves(coupling.Terms[i]) ? Math.Abs(coupling.Ratios[i]) * UnitOf(coupling.Terms[i]) / unit : 0;
            steepest = Math.Max(steepest, steep);
        }

        double scale = 1 / (unit * (steepest > 0 ? steepest : 1));
        Array.Clear(_row, 0, path.Width);
        int among = AngleAmongOthers(coupling, poses);
        double c = CouplingError(coupling, poses, values);
        double weight = 1;
        if (among >= 0)
        {
            double factor = Factor(coupling, among);
            int coordinate = Coordinate(coupling, among);
            if (AngleError(coordinate, values[coordinate] - c / factor, factor, poses, values, out ConstraintRow angle, out double share) is double error)
            {
                (c, weight) = (error, share);
                Scatter(path, coordinate, angle, poses, scale);
            }
            else
            {
                among = -1;
            }
        }

        for (int i = 0; i <= coupling.Terms.Length; i++)
        {
            if (i != among && !IsHeldAmongOthers(Coordinate(coupling, i)))
            {
                Scatter(path, Coordinate(coupling, i), _coupled[i], poses, Factor(coupling, i) * weight * scale);
            }
        }

        c *= scale;
        if (_linkage.Coordinates[coupling.Driven].IsAngle)
        {
            WorstAngular = Math.Max(WorstAngular, Math.Abs(c));
        }
        else
        {
            WorstLinear = Math.Max(WorstLinear, Math.Abs(c));
        }

        Add(path, c);
    }

    // Whether any freedom does: its joint may be between two bodies that stand still.
    private bool Moves(int coordinate) => _linkage.Rows.Joints[_linkage.Coordinates[coordinate].Joint].Bodies.Length > 0;

    private double UnitOf(int coordinate) => _linkage.Coordinates[coordinate].IsAngle ? 1 : _linkage.Length;

    private void Scatter(RowPath union, int coordinate, in ConstraintRow row, Pose[] poses, double scale)
    {
        MechanismCoordinate source = _linkage.Coordinates[coordinate];
        RowPath path = _linkage.Rows.Joints[source.Joint];
        Wrench(_linkage, row, source.JointRows, poses, scale, out Vector3d force, out Vector3d moment);
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            int at = union.Starts[Array.IndexOf(union.Bodies, path.Bodies[k])];
            int first = _normal.Firsts[path.Bodies[k]];
            for (int i = 0; i < path.Starts[k + 1] - path.Starts[k]; i++)
            {
                _row[at + i] += path.Signs[k] * Dot(force, moment, first + i);
            }
        }
    }

    private void Pack(RowPath path, in ConstraintRow row, JointModel joint, Pose[] poses, double scale)
    {
        Wrench(_linkage, row, joint, poses, scale, out Vector3d force, out Vector3d moment);
        Pack(path, force, moment);
    }

    private void Pack(RowPath path, Vector3d force, Vector3d moment)
    {
        for (int k = 0; k < path.Bodies.Length; k++)
        {
            int first = _normal.Firsts[path.Bodies[k]] - path.Starts[k];
            for (int i = path.Starts[k]; i < path.Starts[k + 1]; i++)
            {
                _row[i] = path.Signs[k] * Dot(force, moment, first + i);
            }
        }
    }

    private double Dot(Vector3d force, Vector3d moment, int freedom) =>
        Vector3d.Dot(force, _motion.Linear[freedom]) + Vector3d.Dot(moment, _motion.Angular[freedom]);

    // Out of a planar loop's plane nothing moves: most of its rows are rounding and would only cost time.
    private static bool IsZero(ReadOnlySpan<double> row)
    {
        foreach (double entry in row)
        {
            if (Math.Abs(entry) > LeastEntry)
            {
                return false;
            }
        }

        return true;
    }

    private void Add(RowPath path, double c)
    {
        Squares += c * c;
        Worst = Math.Max(Worst, Math.Abs(c));
        ReadOnlySpan<double> row = _row.AsSpan(0, path.Width);
        if (!IsZero(row))
        {
            _normal.Add(path, row, c);
        }

        Sink?.Add(path, row, c);
    }
}
