using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// The couplings' rows in the sweeps: rigid rows over the bodies of their joints, solved after all joints. PhysX 4.1 has none;
/// they follow its formula for a rigid row.
/// </summary>
internal sealed class CouplingRows
{
    private readonly MultibodySystem _mechanism;
    private readonly Predicate<int> _isElsewhere;
    private readonly Row[] _rows;

    // For each row as many as its joints may have bodies.
    private readonly Part[] _parts;

    private struct Row
    {
        public double Constant;
        public double UnbiasedConstant;
        public double InverseResponse;
        public int First;
        public int Parts;
    }

    private struct Part
    {
        public int Body;
        public double InverseMass;
        public Vector3d Linear;

        /// <summary>Of the plain angular velocity.</summary>
        public Vector3d Angular;

        /// <summary>I^(-1/2) Angular.</summary>
        public Vector3d SqrtAngular;
    }

    public CouplingRows(MultibodySystem mechanism, Predicate<int> isElsewhere)
    {
        _mechanism = mechanism;
        _isElsewhere = isElsewhere;
        _rows = new Row[mechanism.Couplings.Length];
        int parts = 0;
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].First = parts;
            parts += 2 * mechanism.Couplings[i].Coordinates.Length;
        }

        _parts = new Part[parts];
    }

    public void Prepare(SqrtInertia[] sqrtInertia, double dt)
    {
        Bodies bodies = _mechanism.Bodies;
        for (int i = 0; i < _rows.Length; i++)
        {
            CoordinateCoupling coupling = _mechanism.Couplings[i];
            ref Row row = ref _rows[i];
            row = new Row { First = row.First };
            if (_isElsewhere(i) || !coupling.IsWhole)
            {
                continue;
            }

            double sum = 0;
            for (int c = 0; c < coupling.Coordinates.Length; c++)
            {
                JointModel joint = coupling.Coordinates[c].Joint;
                sum += coupling.Evaluate(c, bodies.PoseOf(joint.Body0), bodies.PoseOf(joint.Body1));
                Add(i, joint.Body0, coupling.Rows[c].Linear0 * coupling.Factors[c], coupling.Rows[c].Angular0 * coupling.Factors[c]);
                Add(i, joint.Body1, coupling.Rows[c].Linear1 * -coupling.Factors[c], coupling.Rows[c].Angular1 * -coupling.Factors[c]);
            }

            SetConstants(i, sqrtInertia, sum - coupling.Offset, dt);
        }
    }

    public void Sweep(BodyDelta[] deltas)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref Row row = ref _rows[i];
            double velocity = 0;
            for (int p = row.First; p < row.First + row.Parts; p++)
            {
                ref Part part = ref _parts[p];
                velocity += Vector3d.Dot(part.Linear, deltas[part.Body].Linear.Vector) + Vector3d.Dot(part.SqrtAngular, deltas[part.Body].Angular.Vector);
            }

            double delta = row.Constant - velocity * row.InverseResponse;
            for (int p = row.First; p < row.First + row.Parts; p++)
            {
                ref Part part = ref _parts[p];
                deltas[part.Body].Linear += new Double4(part.Linear * (delta * part.InverseMass), 0);
                deltas[part.Body].Angular += new Double4(part.SqrtAngular * delta, 0);
            }
        }
    }

    public void RemoveBias()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].Constant = _rows[i].UnbiasedConstant;
        }
    }

    /// <summary>Notes the coordinates reached, against which the next step unwraps its angles.</summary>
    /// <param name="dt">Step, s.</param>
    public void Finish(double dt)
    {
        Bodies bodies = _mechanism.Bodies;
        foreach (CoordinateCoupling coupling in _mechanism.Couplings)
        {
            for (int c = 0; c < coupling.Last.Length; c++)
            {
                coupling.Last[c] = Reached(coupling.Coordinates[c], bodies, coupling.Last[c], dt);
            }
        }
    }

    // Of angles the nearest to where the speeds of this step have led: the bodies may have turned by more than half a turn.
    private static double Reached(in CoordinateAxisMap coordinate, Bodies bodies, double last, double dt)
    {
        JointModel joint = coordinate.Joint;
        Pose pose0 = bodies.PoseOf(joint.Body0);
        Pose pose1 = bodies.PoseOf(joint.Body1);
        double reached = coordinate.Evaluate(pose0, pose1, last, out ConstraintRow row);
        if (!coordinate.IsAngle)
        {
            return reached;
        }

        double speed = row.Velocity(Vector3d.Zero, bodies.AngularVelocityOf(joint.Body0), Vector3d.Zero, bodies.AngularVelocityOf(joint.Body1));
        return SwingTwist.Nearest(reached, last + dt * speed);
    }

    // A body on both sides counts once, with its parts added up.
    private void Add(int row, int body, Vector3d linear, Vector3d angular)
    {
        if (body < 0)
        {
            return;
        }

        int start = _rows[row].First;
        int end = start + _rows[row].Parts;
        int p = start;
        while (p < end && _parts[p].Body != body)
        {
            p++;
        }

        if (p == end)
        {
            _parts[p] = new Part { Body = body };
            _rows[row].Parts++;
        }

        _parts[p].Linear += linear;
        _parts[p].Angular += angular;
    }

    private void SetConstants(int i, SqrtInertia[] sqrtInertia, double error, double dt)
    {
        Bodies bodies = _mechanism.Bodies;
        ref Row row = ref _rows[i];
        double response = 0;
        double velocity = 0;
        for (int p = row.First; p < row.First + row.Parts; p++)
        {
            ref Part part = ref _parts[p];
            part.InverseMass = bodies.InverseMasses[part.Body];
            part.SqrtAngular = sqrtInertia[part.Body].Times(part.Angular).Vector;
            response += part.InverseMass * part.Linear.LengthSquared + part.SqrtAngular.LengthSquared;
            velocity += Vector3d.Dot(part.Linear, bodies.LinearVelocities[part.Body])
                + Vector3d.Dot(part.Angular, bodies.AngularVelocities[part.Body]);
        }

        row.InverseResponse = response > 0 ? 1 / response : 0;
        row.UnbiasedConstant = -velocity * row.InverseResponse;
        row.Constant = row.UnbiasedConstant - error / dt * row.InverseResponse;
    }
}
