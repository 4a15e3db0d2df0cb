using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// The couplings' rows in the sweeps: rigid rows over up to four bodies, solved after all joints. PhysX 4.1 has none;
/// they follow its formula for a rigid row.
/// </summary>
internal sealed class CouplingRows
{
    private const int MaxBodies = 4;

    private readonly MultibodySystem _mechanism;
    private readonly Predicate<int> _isElsewhere;
    private readonly Row[] _rows;

    // MaxBodies for each row.
    private readonly Part[] _parts;

    private struct Row
    {
        public double Constant;
        public double UnbiasedConstant;
        public double InverseResponse;
        public double Impulse;
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
        _parts = new Part[_rows.Length * MaxBodies];
    }

    public void Prepare(SqrtInertia[] sqrtInertia, double dt)
    {
        Bodies bodies = _mechanism.Bodies;
        for (int i = 0; i < _rows.Length; i++)
        {
            CoordinateCoupling coupling = _mechanism.Couplings[i];
            ref Row row = ref _rows[i];
            row = default;
            if (_isElsewhere(i) || coupling.A.Joint.IsBroken || coupling.B.Joint.IsBroken)
            {
                continue;
            }

            JointModel a = coupling.A.Joint;
            JointModel b = coupling.B.Joint;
            double error = coupling.Prepare(
                bodies.PoseOf(a.Body0), bodies.PoseOf(a.Body1), bodies.PoseOf(b.Body0), bodies.PoseOf(b.Body1), out ConstraintRow rowA, out ConstraintRow rowB);
            Add(i, a.Body0, rowA.Linear0 * -coupling.Ratio, rowA.Angular0 * -coupling.Ratio);
            Add(i, a.Body1, rowA.Linear1 * coupling.Ratio, rowA.Angular1 * coupling.Ratio);
            Add(i, b.Body0, rowB.Linear0, rowB.Angular0);
            Add(i, b.Body1, -rowB.Linear1, -rowB.Angular1);
            SetConstants(i, sqrtInertia, error, dt);
        }
    }

    public void Sweep(BodyDelta[] deltas)
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref Row row = ref _rows[i];
            double velocity = 0;
            for (int p = i * MaxBodies; p < i * MaxBodies + row.Parts; p++)
            {
                ref Part part = ref _parts[p];
                velocity += Vector3d.Dot(part.Linear, deltas[part.Body].Linear.Vector) + Vector3d.Dot(part.SqrtAngular, deltas[part.Body].Angular.Vector);
            }

            double delta = row.Constant - velocity * row.InverseResponse;
            row.Impulse += delta;
            for (int p = i * MaxBodies; p < i * MaxBodies + row.Parts; p++)
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
            coupling.LastA = Reached(coupling.A, bodies, coupling.LastA, dt);
            coupling.LastB = Reached(coupling.B, bodies, coupling.LastB, dt);
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

        int start = row * MaxBodies;
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
        for (int p = i * MaxBodies; p < i * MaxBodies + row.Parts; p++)
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
