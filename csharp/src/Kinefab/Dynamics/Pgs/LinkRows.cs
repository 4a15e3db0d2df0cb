using System;
using System.Collections.Generic;
using Kinefab.Dynamics.Articulations;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Rows of joints and couplings that act on links of articulations, in the sweeps: PhysX's 1-D rows with the response of the whole
/// articulation in the place of a body's inverse mass, without preprocessing. Those between one link and the world are solved inside the
/// articulation's own sweep. A joint between two links of one articulation does not know what an impulse on the one does to the other: neither its
/// rows' responses nor, until all its rows are done, the speeds that they see. Source: DyConstraintSetup.cpp, setupSolverConstraint (isExtended);
/// DyArticulationContactPrep.cpp, getImpulseResponse; DySolverConstraints.cpp, solveExt1D.
/// </summary>
internal sealed class LinkRows
{
    private const double LeastResponse = 1e-12;

    private readonly MultibodySystem _mechanism;
    private readonly ArticulatedBodies _links;
    private readonly int[] _joints;
    private readonly int[] _couplings;
    private readonly SweepRows _rows;

    // The biased or the unbiased ones of the rows.
    private double[] _constants = System.Array.Empty<double>();
    private readonly Row[] _made;

    // Those of a row stand together.
    private readonly Part[] _parts;
    private readonly WorldSide[] _worldSides;
    private readonly ConstraintRow[] _given = new ConstraintRow[JointModel.MaxRows];
    private int _count;

    // Motions of two links of one articulation, as the joint between them sees them.
    private Twist _seen0;
    private Twist _seen1;

    private struct Row
    {
        public int Joint;
        public int First;
        public int Parts;
        public bool Counts;

        // Solved inside the articulation.
        public bool IsInner;

        // Both sides are links of one articulation.
        public bool IsWithin;
    }

    private struct Part
    {
        public int Body;
        public Wrench Direction;

        /// <summary>What a unit of impulse gives the body: the direction by the joint's mass scales.</summary>
        public Wrench Push;
        public Twist Start;

        /// <summary>Of a joint's side: the body's change of velocity by a unit of impulse on it alone.</summary>
        public Twist Response;
    }

    public LinkRows(MultibodySystem mechanism, ArticulatedBodies links)
    {
        _mechanism = mechanism;
        _links = links;
        var joints = new List<int>();
        for (int i = 0; i < mechanism.Joints.Length; i++)
        {
            if (!links.HeldJoints[i] && Touches(mechanism.Joints[i]))
                joints.Add(i);
        }

        var couplings = new List<int>();
        int coupled = 0;
        for (int i = 0; i < mechanism.Couplings.Length; i++)
        {
            if (!Array.Exists(mechanism.Couplings[i].Coordinates, coordinate => Touches(coordinate.Joint)))
                continue;
            couplings.Add(i);
            coupled += 2 * mechanism.Couplings[i].Coordinates.Length;
        }

        _joints = joints.ToArray();
        _couplings = couplings.ToArray();
        int most = joints.Count + couplings.Count;
        _rows = new SweepRows(most);
        _made = new Row[most * JointModel.MaxRows];
        _parts = new Part[2 * joints.Count * JointModel.MaxRows + coupled];
        _worldSides = new WorldSide[links.Solvers.Length];
        for (int a = 0; a < _worldSides.Length; a++)
        {
            _worldSides[a] = new WorldSide(this, links.Solvers[a]);
            links.Solvers[a].WorldRows = _worldSides[a];
        }
    }

    /// <summary>Whether there are any.</summary>
    public bool IsNeeded => _joints.Length + _couplings.Length > 0;

    /// <summary>Whether a joint is one of these, or one that an articulation holds.</summary>
    public bool Takes(int joint) => _links.HeldJoints[joint] || Array.BinarySearch(_joints, joint) >= 0;

    /// <summary>Whether a coupling is one of these.</summary>
    public bool TakesCoupling(int coupling) => Array.BinarySearch(_couplings, coupling) >= 0;

    /// <summary>Rows of a step; the articulations have begun theirs.</summary>
    public void Prepare(double dt)
    {
        _count = 0;
        foreach (WorldSide side in _worldSides)
            side.Clear();
        double inverseDt = 1 / dt;
        foreach (int j in _joints)
        {
            JointModel joint = _mechanism.Joints[j];
            if (joint.IsBroken)
                continue;
            int count = joint.Prepare(_mechanism.Bodies.PoseOf(joint.Body0), _mechanism.Bodies.PoseOf(joint.Body1), _given);
            for (int hint = 0; hint <= 2; hint++)
            {
                for (int i = 0; i < count; i++)
                {
                    if (Class(_given[i].Hint) != hint)
                        continue;
                    ref Row row = ref Begin(j);
                    Add(ref row, joint.Body0, _given[i].Linear0, _given[i].Angular0, joint.InverseMassScale0, joint.InverseInertiaScale0);
                    Add(ref row, joint.Body1, _given[i].Linear1 * -1, _given[i].Angular1 * -1, joint.InverseMassScale1, joint.InverseInertiaScale1);
                    double scale = _given[i].Has(RowFlags.HasDriveLimit) && joint.DriveLimitsAreForces ? Math.Min(dt, 1) : 1;
                    End(ref row, _given[i], scale, dt, inverseDt);
                }
            }
        }

        foreach (int c in _couplings)
            PrepareCoupling(_mechanism.Couplings[c], dt, inverseDt);
        _constants = _rows.BiasedConstants;
    }

    /// <summary>From the velocity iterations on the error counts no more.</summary>
    public void RemoveBias() => _constants = _rows.UnbiasedConstants;

    /// <summary>All but those to the world once.</summary>
    public void Sweep(BodyDelta[] deltas, SqrtInertia[] sqrtInertia)
    {
        for (int i = 0; i < _count; i++)
        {
            ref Row row = ref _made[i];
            if (row.IsInner)
                continue;
            double impulse = Solve(i, row.IsWithin ? SpeedWithin(i) : Speed(row, deltas, sqrtInertia));
            for (int p = row.First; impulse != 0 && p < row.First + row.Parts; p++)
            {
                ref Part part = ref _parts[p];
                if (_links.IsLink(part.Body))
                {
                    _links.Solvers[_links.ArticulationOf[part.Body]].Responses.Apply(_links.LinkOf[part.Body], part.Push * impulse);
                    continue;
                }

                deltas[part.Body].Linear += new Double4(part.Response.Linear * impulse, 0);
                deltas[part.Body].Angular += sqrtInertia[part.Body].Times(part.Push.Torque * impulse);
            }

            if (row.IsWithin)
            {
                _seen0 += _parts[row.First].Response * impulse;
                _seen1 += _parts[row.First + 1].Response * impulse;
            }
        }
    }

    // Of the row's bodies as they are now, less that of the start.
    private double Speed(in Row row, BodyDelta[] deltas, SqrtInertia[] sqrtInertia)
    {
        double speed = 0;
        for (int p = row.First; p < row.First + row.Parts; p++)
        {
            ref Part part = ref _parts[p];
            Twist change = _links.IsLink(part.Body)
                ? _links.Motion(part.Body) - part.Start
                : new Twist(sqrtInertia[part.Body].Times(deltas[part.Body].Angular.Vector).Vector, deltas[part.Body].Linear.Vector);
            speed += Wrench.Dot(part.Direction, change);
        }

        return speed;
    }

    // The same as the joint sees it, whose first row looks at the links.
    private double SpeedWithin(int i)
    {
        ref Row row = ref _made[i];
        ref Part part0 = ref _parts[row.First];
        ref Part part1 = ref _parts[row.First + 1];
        if (i == 0 || _made[i - 1].Joint != row.Joint)
        {
            _seen0 = _links.Motion(part0.Body);
            _seen1 = _links.Motion(part1.Body);
        }

        return Wrench.Dot(part0.Direction, _seen0 - part0.Start) + Wrench.Dot(part1.Direction, _seen1 - part1.Start);
    }

    /// <summary>Breaks the joints that passed their limits; true when one did.</summary>
    public bool Break(double dt)
    {
        bool broken = false;
        for (int i = 0; i < _count;)
        {
            int j = _made[i].Joint;
            JointReaction impulse = Sum(ref i);
            if (j < 0 || !_mechanism.Joints[j].CanBreak)
                continue;
            JointModel joint = _mechanism.Joints[j];
            joint.IsBroken = impulse.Force.Length > joint.BreakForce * dt || impulse.Torque.Length > joint.BreakTorque * dt;
            broken |= joint.IsBroken;
        }

        return broken;
    }

    /// <summary>Writes the step's forces and torques on actor 0, the torque about the anchor in actor 1: of these joints and of the links' own.</summary>
    public void Write(JointReaction[] reactions, double dt)
    {
        for (int i = 0; i < _count;)
        {
            int j = _made[i].Joint;
            JointReaction impulse = Sum(ref i);
            if (j >= 0)
                reactions[j] = new JointReaction { Force = impulse.Force * (1 / dt), Torque = impulse.Torque * (1 / dt) };
        }

        for (int a = 0; a < _links.Solvers.Length; a++)
            Array.Clear(_links.Impulses(a), 0, _links.Impulses(a).Length);
        for (int i = 0; i < _count; i++)
        {
            ref Row row = ref _made[i];
            for (int p = row.First; p < row.First + row.Parts; p++)
            {
                ref Part part = ref _parts[p];
                if (_links.IsLink(part.Body))
                    _links.Impulses(_links.ArticulationOf[part.Body])[_links.LinkOf[part.Body]] += part.Push * _rows.Impulses[i];
            }
        }

        _links.Write(reactions);
    }

    private JointReaction Sum(ref int i)
    {
        int joint = _made[i].Joint;
        var sum = default(JointReaction);
        for (; i < _count && _made[i].Joint == joint; i++)
        {
            if (_made[i].Counts)
            {
                sum.Force += _rows.Vectors[i].Linear.Vector * _rows.Impulses[i];
                sum.Torque += _rows.Angular0[i] * _rows.Impulses[i];
            }
        }

        return sum;
    }

    // The order in which PhysX sorts them: drives and soft limits, equalities, inequalities.
    private static int Class(SolveHint hint) => hint == SolveHint.Equality ? 1 : hint == SolveHint.Inequality ? 2 : 0;

    private bool Touches(JointModel joint) => _links.IsLink(joint.Body0) || _links.IsLink(joint.Body1);

    private ref Row Begin(int joint)
    {
        ref Row row = ref _made[_count];
        row = new Row { Joint = joint, First = _count == 0 ? 0 : _made[_count - 1].First + _made[_count - 1].Parts };
        return ref row;
    }

    private void Add(ref Row row, int body, Vector3d linear, Vector3d angular, double massScale = 1, double inertiaScale = 1)
    {
        if (body < 0 || (!_links.IsLink(body) && !(_mechanism.Bodies.InverseMasses[body] > 0)))
            return;
        int p = row.First;
        while (p < row.First + row.Parts && _parts[p].Body != body)
            p++;
        if (p == row.First + row.Parts)
        {
            _parts[p] = new Part { Body = body };
            row.Parts++;
        }

        _parts[p].Direction += new Wrench(linear, angular);
        _parts[p].Push += new Wrench(linear * massScale, angular * inertiaScale);
    }

    // Response and speed at the start; a row that moves nothing is left out.
    private void End(ref Row row, in ConstraintRow given, double driveScale, double dt, double inverseDt)
    {
        Bodies bodies = _mechanism.Bodies;
        bool isJoint = row.Joint >= 0;
        double speed = 0;
        double compliance = 0;
        for (int p = row.First; p < row.First + row.Parts; p++)
        {
            ref Part part = ref _parts[p];
            if (_links.IsLink(part.Body))
            {
                ArticulationSolver solver = _links.Solvers[_links.ArticulationOf[part.Body]];
                solver.Responses.Apply(_links.LinkOf[part.Body], part.Push);
                if (isJoint)
                    TakeResponse(ref part, solver);
                part.Start = solver.Tree.Motions[_links.LinkOf[part.Body]];
                compliance = Math.Max(compliance, solver.JointCompliance(_links.LinkOf[part.Body]));
            }
            else
            {
                part.Start = new Twist(bodies.AngularVelocities[part.Body], bodies.LinearVelocities[part.Body]);
                Quaterniond q = bodies.Poses[part.Body].Rotation;
                part.Response = new Twist(
                    q * Vector3d.Scale(bodies.InverseInertias[part.Body], q.InverseRotate(part.Push.Torque)), part.Push.Force * bodies.InverseMasses[part.Body]);
            }

            speed += Wrench.Dot(part.Direction, part.Start);
        }

        double response = isJoint ? 0 : CoupledResponse(row);
        for (int p = row.First; isJoint && p < row.First + row.Parts; p++)
            response += Wrench.Dot(_parts[p].Direction, _parts[p].Response);
        if (!(response > LeastResponse))
            return;
        response += compliance;
        int i = _count++;
        row.Counts = given.Has(RowFlags.OutputForce);
        row.IsInner = row.Parts == 1 && _links.IsLink(_parts[row.First].Body);
        row.IsWithin = isJoint && row.Parts == 2 && _links.IsLink(_parts[row.First].Body) && _links.IsLink(_parts[row.First + 1].Body)
            && _links.ArticulationOf[_parts[row.First].Body] == _links.ArticulationOf[_parts[row.First + 1].Body];
        _rows.Vectors[i] = new RowVectors
        {
            Linear = new Double4(given.Linear0, given.GeometricError),
            Sqrt0 = new Double4(Vector3d.Zero, given.VelocityTarget),
            Sqrt1 = new Double4(Vector3d.Zero, speed),
        };
        _rows.Angular0[i] = given.Angular0;
        PgsConstants.Set(_rows, i, response, given, driveScale, dt, inverseDt);
        if (row.IsInner)
        {
            int body = _parts[row.First].Body;
            _worldSides[_links.ArticulationOf[body]].Add(_links.LinkOf[body], i);
        }
    }

    private void TakeResponse(ref Part part, ArticulationSolver solver)
    {
        part.Response = solver.Responses.Change(_links.LinkOf[part.Body]);
        solver.Responses.Forget();
    }

    // A coupling's sides act on its row's speed through each other too: PhysX has no couplings.
    private double CoupledResponse(in Row row)
    {
        double response = 0;
        for (int p = row.First; p < row.First + row.Parts; p++)
        {
            ref Part part = ref _parts[p];
            response += Wrench.Dot(part.Direction, _links.IsLink(part.Body) ? _links.Solvers[_links.ArticulationOf[part.Body]].Responses.Change(_links.LinkOf[part.Body]) : part.Response);
        }

        for (int p = row.First; p < row.First + row.Parts; p++)
        {
            if (_links.IsLink(_parts[p].Body))
                _links.Solvers[_links.ArticulationOf[_parts[p].Body]].Responses.Forget();
        }

        return response;
    }

    private void PrepareCoupling(CoordinateCoupling coupling, double dt, double inverseDt)
    {
        if (!coupling.IsWhole)
            return;
        Bodies bodies = _mechanism.Bodies;
        ref Row row = ref Begin(-1);
        double sum = 0;
        for (int i = 0; i < coupling.Coordinates.Length; i++)
        {
            JointModel joint = coupling.Coordinates[i].Joint;
            sum += coupling.Evaluate(i, bodies.PoseOf(joint.Body0), bodies.PoseOf(joint.Body1));
            Add(ref row, joint.Body0, coupling.Rows[i].Linear0 * coupling.Factors[i], coupling.Rows[i].Angular0 * coupling.Factors[i]);
            Add(ref row, joint.Body1, coupling.Rows[i].Linear1 * -coupling.Factors[i], coupling.Rows[i].Angular1 * -coupling.Factors[i]);
        }

        var given = new ConstraintRow { GeometricError = sum - coupling.Offset, Minimum = double.NegativeInfinity, Maximum = double.PositiveInfinity, Hint = SolveHint.Equality };
        End(ref row, given, 1, dt, inverseDt);
    }

    private double Solve(int i, double speed)
    {
        ref RowBounds bounds = ref _rows.Bounds[i];
        double impulse = bounds.ImpulseMultiplier * _rows.Impulses[i] + _rows.VelocityMultipliers[i] * speed + _constants[i];
        impulse = Math.Min(bounds.Maximum, Math.Max(bounds.Minimum, impulse));
        double given = impulse - _rows.Impulses[i];
        _rows.Impulses[i] = impulse;
        return given;
    }

    /// <summary>The rows between one articulation's links and the world.</summary>
    private sealed class WorldSide : ILinkRows
    {
        private readonly LinkRows _owner;
        private readonly ArticulationSolver _solver;
        private readonly List<int>[] _rows;

        public WorldSide(LinkRows owner, ArticulationSolver solver)
        {
            _owner = owner;
            _solver = solver;
            _rows = new List<int>[solver.Tree.Count];
            for (int i = 0; i < _rows.Length; i++)
                _rows[i] = new List<int>();
        }

        public bool Has(int link) => _rows[link].Count > 0;

        public void Clear()
        {
            foreach (List<int> rows in _rows)
                rows.Clear();
        }

        public void Add(int link, int row) => _rows[link].Add(row);

        public bool Solve(int link, ref Twist change, ref Wrench impulse)
        {
            bool given = false;
            foreach (int i in _rows[link])
            {
                ref Part part = ref _owner._parts[_owner._made[i].First];
                Twist moved = _solver.Tree.Motions[link] + change - part.Start;
                double by = _owner.Solve(i, Wrench.Dot(part.Direction, moved));
                if (by == 0)
                    continue;
                given = true;
                Wrench push = part.Push * by;
                change += _solver.Responses.Links[link].Times(push);
                impulse += push;
            }

            return given;
        }
    }
}
