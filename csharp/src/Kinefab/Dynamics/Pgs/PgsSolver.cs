using System;
using Kinefab.Dynamics.Articulations;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Projected Gauss-Seidel as PhysX 4.1 does it and so Unity: position iterations with the error as bias, whose
/// velocity moves the bodies; then velocity iterations without it, whose velocity is kept. No warm start. Its drift, softness and loss of energy
/// are PhysX's own. Of both iterations there are as many as the moving body that asks for most, as PhysX has it among up to 128 bodies.
/// Source: DySolverControl.cpp, DyConstraintSetup.cpp, DySolverConstraints.cpp (solve1D), DyBodyCoreIntegrator.h.
/// </summary>
internal sealed class PgsSolver : ISolver, IStepParts
{
    private readonly MultibodySystem _mechanism;
    private readonly Bodies _bodies;
    private readonly SolveOrder _order;
    private readonly ProjectionOrder _projection;
    private readonly CouplingRows _couplings;
    private readonly ArticulatedBodies _articulated;
    private readonly LinkRows _linkRows;
    private readonly Action<JointReaction[]> _writeReactions;
    private Action<JointReaction[]>? _unread;
    private double _dt;

    // One more than there are bodies: the last stands for the world and never moves.
    private readonly Pose[] _startPoses;
    private readonly Vector3d[] _startLinear;
    private readonly Vector3d[] _startAngular;
    private BodyDelta[] _deltas = Array.Empty<BodyDelta>();
    private BodyDelta[] _motions = Array.Empty<BodyDelta>();
    private readonly Vector3d[] _rootInertia;
    private readonly SqrtInertia[] _sqrtInertia;

    private readonly JointBlock[] _blocks;
    private readonly SweepRows _rows;
    private readonly ReactionSums _reactions;
    private Part[] _parts = Array.Empty<Part>();
    private int _positionIterations;
    private int _velocityIterations;

    public PgsSolver(MultibodySystem mechanism)
        : this(mechanism, ArticulatedBodies.None(mechanism))
    {
    }

    /// <summary>With articulations among the bodies.</summary>
    public PgsSolver(MultibodySystem mechanism, ArticulatedBodies articulated)
    {
        _mechanism = mechanism;
        _bodies = mechanism.Bodies;
        _articulated = articulated;
        _linkRows = new LinkRows(mechanism, articulated);
        _writeReactions = WriteReactions;
        bool isOnePart = mechanism.Couplings.Length > 0 || articulated.Solvers.Length > 0;
        _order = new SolveOrder(mechanism, _linkRows.Takes, _articulated.IsLink, isOnePart);
        _projection = new ProjectionOrder(mechanism);
        _couplings = new CouplingRows(mechanism, _linkRows.TakesCoupling);
        int slots = _bodies.Count + 1;
        _startPoses = new Pose[slots];
        _startPoses[_bodies.Count] = Pose.Identity;
        _startLinear = new Vector3d[slots];
        _startAngular = new Vector3d[slots];
        _rootInertia = Array.ConvertAll(_bodies.InverseInertias, SqrtInertia.Root);
        _sqrtInertia = new SqrtInertia[slots];
        _blocks = new JointBlock[mechanism.Joints.Length];
        _rows = new SweepRows(mechanism.Joints.Length);
        _reactions = new ReactionSums(mechanism, _blocks, _rows, _startPoses);
        MakeParts();
    }

    /// <inheritdoc/>
    public void Step(double dt)
    {
        if (_mechanism.HasChangedBodies)
        {
            _mechanism.HasChangedBodies = false;
            for (int i = 0; i < _bodies.Count; i++)
                _rootInertia[i] = SqrtInertia.Root(_bodies.InverseInertias[i]);
        }

        _dt = dt;
        Begin();
        if (_order.IsOnePart)
        {
            SolveAsOne(dt);
        }
        else
        {
            StepThreads.ForEach(this, _parts.Length, _mechanism.Threads);
        }

        int blocks = _order.Joints.Length;
        bool broken = _reactions.Break(blocks, dt) | _linkRows.Break(dt);
        if (_articulated.Solvers.Length > 0)
        {
            _unread = _mechanism.UnreadReactions;
            _mechanism.UnreadReactions = _writeReactions;
        }

        for (int i = 0; i < _bodies.Count; i++)
        {
            if (_bodies.IsKinematic[i] && !_articulated.IsLink(i))
                _bodies.Poses[i] = _bodies.KinematicTargets[i];
        }

        foreach (Part part in _parts)
        {
            _mechanism.Stops += part.Stops;
            part.Stops = 0;
        }

        _articulated.Finish();

        _projection.Apply();
        if (broken)
        {
            Refresh();
        }

        _couplings.Finish(dt);
    }

    /// <inheritdoc/>
    public void Exchange(StateTape tape)
    {
        _articulated.Exchange(tape);
        // Nothing is kept from step to step but what follows from the joints.
        if (!tape.IsPlaying)
            return;
        _mechanism.HasChangedBodies = true;
        Refresh();
    }

    /// <inheritdoc/>
    void IStepParts.Do(int part)
    {
        Part own = _parts[part];
        foreach (int body in own.Bodies)
            Predict(body);
        own.Preparation.Prepare(_order.Joints, own.First, own.End, _dt);
        foreach (int body in own.Bodies)
            _deltas[body] = default;
        for (int i = 0; i < _positionIterations; i++)
            Sweep(own, _rows.BiasedConstants);
        foreach (int body in own.Bodies)
            _motions[body] = _deltas[body];
        for (int i = 0; i < _velocityIterations; i++)
            Sweep(own, _rows.UnbiasedConstants);
        foreach (int body in own.Bodies)
            Move(own, body, _dt);
    }

    // With what bodies and joints do not do by themselves: couplings after every sweep, articulations after these.
    private void SolveAsOne(double dt)
    {
        Part all = _parts[0];
        foreach (int body in all.Bodies)
            Predict(body);
        all.Preparation.Prepare(_order.Joints, all.First, all.End, dt);
        _couplings.Prepare(_sqrtInertia, dt);
        _articulated.Begin(dt, _linkRows.IsNeeded);
        _linkRows.Prepare(dt);
        Array.Clear(_deltas, 0, _deltas.Length);
        for (int i = 0; i < _positionIterations; i++)
        {
            Sweep(all, _rows.BiasedConstants);
            _couplings.Sweep(_deltas);
            SweepArticulations(isVelocityIteration: false);
        }

        foreach (ArticulationSolver articulation in _articulated.Solvers)
            articulation.EndPositionIterations();
        _linkRows.RemoveBias();
        Array.Copy(_deltas, _motions, _deltas.Length);
        _couplings.RemoveBias();
        for (int i = 0; i < _velocityIterations; i++)
        {
            Sweep(all, _rows.UnbiasedConstants);
            _couplings.Sweep(_deltas);
            SweepArticulations(isVelocityIteration: true);
        }

        foreach (int body in all.Bodies)
            Move(all, body, dt);
    }

    // What parts share: how often all are swept, and the bodies that move as they are told.
    private void Begin()
    {
        _positionIterations = 0;
        _velocityIterations = 0;
        for (int i = 0; i < _bodies.Count; i++)
        {
            bool isLink = _articulated.IsLink(i);
            if (_bodies.IsKinematic[i] && !isLink)
            {
                Predict(i);
                continue;
            }

            _positionIterations = Math.Max(_positionIterations, _bodies.PositionIterations[i]);
            _velocityIterations = Math.Max(_velocityIterations, _bodies.VelocityIterations[i]);
            if (isLink)
                Note(i);
        }
    }

    private void Predict(int i)
    {
        BodyMotion.PredictVelocity(_bodies, i, _mechanism.Gravity, _dt);
        Note(i);
    }

    private void Note(int i)
    {
        _sqrtInertia[i] = SqrtInertia.At(_bodies.Poses[i].Rotation, _rootInertia[i]);
        _startPoses[i] = _bodies.Poses[i];
        _startLinear[i] = _bodies.LinearVelocities[i];
        _startAngular[i] = _bodies.AngularVelocities[i];
    }

    // The parts after joints broke.
    private void Refresh()
    {
        _order.Refresh();
        _projection.Refresh();
        MakeParts();
    }

    private void MakeParts()
    {
        _parts = new Part[_order.PartCount];

        // Behind those of bodies and world each part has a slot that takes the changes of what cannot move, and one between it and the next:
        // two threads do not write to one line of memory.
        int unread = _bodies.Count + 1;
        _deltas = new BodyDelta[unread + 2 * _parts.Length];
        _motions = new BodyDelta[_deltas.Length];
        for (int p = 0; p < _parts.Length; p++)
        {
            _parts[p] = new Part
            {
                First = _order.FirstJoint(p),
                End = _order.FirstJoint(p + 1),
                Bodies = _order.Bodies(p),
                Preparation = new JointPreparation(_mechanism, _blocks, _rows, _startPoses, _startLinear, _startAngular, _sqrtInertia, unread + 2 * p),
            };
        }
    }

    private void SweepArticulations(bool isVelocityIteration)
    {
        _linkRows.Sweep(_deltas, _sqrtInertia);
        foreach (ArticulationSolver articulation in _articulated.Solvers)
            articulation.Sweep(isVelocityIteration);
    }

    private void WriteReactions(JointReaction[] reactions)
    {
        _unread?.Invoke(reactions);
        _linkRows.Write(reactions, _dt);
    }

    private void Sweep(Part part, double[] constants)
    {
        _mechanism.Cancellation.ThrowIfCancellationRequested();
        for (int b = part.First; b < part.End; b++)
        {
            ref JointBlock block = ref _blocks[b];
            if (block.Equalities > block.Start)
            {
                _rows.SolveInTurn(block.Start, block.Equalities, block, _deltas, constants);
            }

            if (block.Inequalities > block.Equalities)
            {
                _rows.SolveTogether(block, _deltas, constants);
            }

            if (block.End > block.Inequalities)
            {
                _rows.SolveInTurn(block.Inequalities, block.End, block, _deltas, constants);
            }
        }
    }

    private void Move(Part part, int i, double dt)
    {
        Vector3d dv = _deltas[i].Linear.Vector;
        Vector3d du = _deltas[i].Angular.Vector;
        Vector3d motionV = _motions[i].Linear.Vector;
        Vector3d motionU = _motions[i].Angular.Vector;
        BodyLocks locks = _bodies.Locks[i];
        if (locks != BodyLocks.None)
        {
            dv = BodyMotion.Unlocked(dv, locks, BodyLocks.LinearX, BodyLocks.LinearY, BodyLocks.LinearZ);
            du = BodyMotion.Unlocked(du, locks, BodyLocks.AngularX, BodyLocks.AngularY, BodyLocks.AngularZ);
            motionV = BodyMotion.Unlocked(motionV, locks, BodyLocks.LinearX, BodyLocks.LinearY, BodyLocks.LinearZ);
            motionU = BodyMotion.Unlocked(motionU, locks, BodyLocks.AngularX, BodyLocks.AngularY, BodyLocks.AngularZ);
        }

        Vector3d v = _bodies.LinearVelocities[i];
        Vector3d w = _bodies.AngularVelocities[i];
        Pose pose = BodyMotion.Integrate(_bodies.Poses[i], v + motionV, w + _sqrtInertia[i].Times(motionU).Vector, dt);
        v += dv;
        w += _sqrtInertia[i].Times(du).Vector;
        if (!BodyMotion.InRange(pose, v, w))
        {
            part.Stops++;
            v = Vector3d.Zero;
            w = Vector3d.Zero;
            pose = _bodies.Poses[i];
        }

        _bodies.Poses[i] = pose;
        _bodies.LinearVelocities[i] = v;
        _bodies.AngularVelocities[i] = w;
    }

    /// <summary>Joints and moving bodies of islands that are solved one after the other, by one thread.</summary>
    private sealed class Part
    {
        /// <summary>In the order of the sweeps, and after the last.</summary>
        public int First;
        public int End;
        public int[] Bodies = Array.Empty<int>();
        public JointPreparation Preparation = null!;

        /// <summary>Bodies that left the range of numbers in the step.</summary>
        public int Stops;
    }
}
