using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>
/// The articulations of a world and which of its bodies are their links: takes what a program set at the bodies before a step, and writes
/// poses and velocities back after it.
/// </summary>
internal sealed class ArticulatedBodies
{
    private readonly MultibodySystem _system;
    private readonly int[][] _bodies;
    private readonly bool _isReduced;

    // Of each link what other joints did to it in the step; its own joint among the system's, by body.
    private readonly Wrench[][] _impulses;
    private readonly int[] _jointOf;

    /// <param name="system">Bodies, links among them.</param>
    /// <param name="trees">The articulations, in the poses of the bodies.</param>
    /// <param name="bodies">For each of them the bodies of its links.</param>
    /// <param name="heldJoints">For each of the system's joints whether an articulation holds it by itself.</param>
    /// <param name="rules">Whose.</param>
    public ArticulatedBodies(MultibodySystem system, IReadOnlyList<ArticulationTree> trees, IReadOnlyList<int[]> bodies, bool[] heldJoints, ArticulationRules rules)
    {
        _system = system;
        _bodies = bodies.ToArray();
        HeldJoints = heldJoints;
        _isReduced = Array.IndexOf(heldJoints, true) >= 0;
        Solvers = trees.Select(tree => new ArticulationSolver(tree, rules)).ToArray();
        _impulses = Solvers.Select(solver => new Wrench[solver.Tree.Count]).ToArray();
        _jointOf = Enumerable.Repeat(-1, system.Bodies.Count).ToArray();
        for (int j = 0; j < heldJoints.Length; j++)
        {
            if (heldJoints[j])
                _jointOf[system.Joints[j].Body1] = j;
        }

        ArticulationOf = Enumerable.Repeat(-1, system.Bodies.Count).ToArray();
        LinkOf = new int[system.Bodies.Count];
        for (int a = 0; a < _bodies.Length; a++)
        {
            for (int link = 0; link < _bodies[a].Length; link++)
            {
                ArticulationOf[_bodies[a][link]] = a;
                LinkOf[_bodies[a][link]] = link;
            }
        }
    }

    /// <summary>A system without articulations.</summary>
    public static ArticulatedBodies None(MultibodySystem system) =>
        new(system, Array.Empty<ArticulationTree>(), Array.Empty<int[]>(), new bool[system.Joints.Length], ArticulationRules.PhysX4);

    public ArticulationSolver[] Solvers { get; }

    /// <summary>For each articulation the bodies of its links, the root first.</summary>
    public IReadOnlyList<int[]> Links => _bodies;

    /// <summary>Of each body the articulation that it is a link of; -1: it is a rigid body by itself.</summary>
    public int[] ArticulationOf { get; }

    /// <summary>Of each body its link.</summary>
    public int[] LinkOf { get; }

    /// <summary>Joints that are part of an articulation.</summary>
    public bool[] HeldJoints { get; }

    public bool IsLink(int body) => body >= 0 && ArticulationOf[body] >= 0;

    /// <summary>A body's velocity changed by what rows gave it so far; only of links.</summary>
    public Twist Motion(int body) => Solvers[ArticulationOf[body]].Motion(LinkOf[body]);

    /// <summary>Takes the bodies' forces, settings and the roots' poses and velocities, and begins the step.</summary>
    /// <param name="dt">s.</param>
    /// <param name="hasJoints">Whether joints or couplings act on links.</param>
    public void Begin(double dt, bool hasJoints)
    {
        Bodies bodies = _system.Bodies;
        for (int a = 0; a < Solvers.Length; a++)
        {
            ArticulationTree tree = Solvers[a].Tree;
            for (int link = 0; link < tree.Count; link++)
            {
                int body = _bodies[a][link];
                LinkDefinition definition = tree.Links[link];
                definition.LinearDamping = bodies.LinearDampings[body];
                definition.AngularDamping = bodies.AngularDampings[body];
                definition.MaxAngularSpeed = bodies.MaxAngularSpeeds[body];
                definition.UseGravity = bodies.UseGravity[body];
                if (bodies.InverseMasses[body] > 0)
                {
                    definition.Mass = 1 / bodies.InverseMasses[body];
                    Vector3d inverse = bodies.InverseInertias[body];
                    definition.Inertia = new Vector3d(1 / inverse.X, 1 / inverse.Y, 1 / inverse.Z);
                }

                Solvers[a].Applied[link] = new Wrench(bodies.Forces[body], bodies.Torques[body]);
                bodies.Forces[body] = Vector3d.Zero;
                bodies.Torques[body] = Vector3d.Zero;
            }

            int root = _bodies[a][0];
            if (bodies.Poses[root] != tree.Poses[0])
                Teleport(tree, bodies.Poses[root]);
            tree.Motions[0] = new Twist(bodies.AngularVelocities[root], bodies.LinearVelocities[root]);
            Solvers[a].Begin(_system.Gravity, dt, hasJoints);
        }
    }

    /// <summary>Writes links' poses and velocities to their bodies; an articulation that left the range of numbers stands still where it was.</summary>
    public void Finish()
    {
        Bodies bodies = _system.Bodies;
        for (int a = 0; a < Solvers.Length; a++)
        {
            ArticulationTree tree = Solvers[a].Tree;
            Solvers[a].Finish();
            bool isInRange = true;
            for (int link = 0; link < tree.Count; link++)
                isInRange &= BodyMotion.InRange(tree.Poses[link], tree.Motions[link].Linear, tree.Motions[link].Angular);
            if (!isInRange)
                Stop(tree, _bodies[a]);
            for (int link = 0; link < tree.Count; link++)
            {
                int body = _bodies[a][link];
                bodies.Poses[body] = tree.Poses[link];
                bodies.LinearVelocities[body] = tree.Motions[link].Linear;
                bodies.AngularVelocities[body] = tree.Motions[link].Angular;
            }
        }
    }

    /// <summary>Of an articulation's links what other joints and couplings did to them in the last step; to be filled in before <see cref="Write"/>.</summary>
    public Wrench[] Impulses(int articulation) => _impulses[articulation];

    /// <summary>The last step's reactions of the joints that articulations hold: on the link above, the torque about the anchor in the link.</summary>
    public void Write(JointReaction[] reactions)
    {
        for (int a = 0; a < Solvers.Length; a++)
        {
            Wrench[] impulses = _impulses[a];
            Solvers[a].Reactions(impulses, impulses);
            for (int link = 1; link < impulses.Length; link++)
            {
                int joint = _jointOf[_bodies[a][link]];
                Wrench w = impulses[link];
                if (joint >= 0)
                    reactions[joint] = w.Force.IsFinite && w.Torque.IsFinite ? new JointReaction { Force = -w.Force, Torque = -w.Torque } : default;
            }
        }
    }

    /// <summary>All that a step or a program changes.</summary>
    public void Exchange(StateTape tape)
    {
        foreach (ArticulationSolver solver in Solvers)
        {
            ArticulationTree tree = solver.Tree;
            tape.Array(tree.Positions);
            tape.Array(tree.Speeds);
            tape.Array(tree.Forces);
            tape.Array(tree.Poses);
            tape.Array(tree.Motions);
            foreach (LinkDefinition link in tree.Links)
            {
                (double friction, double speed) = (link.Friction, link.MaxJointSpeed);
                tape.Value(ref friction);
                tape.Value(ref speed);
                (link.Friction, link.MaxJointSpeed) = (friction, speed);
            }

            foreach (LinkDefinition link in tree.Links)
                tape.Array(link.Axes);
        }
    }

    /// <summary>Takes an articulation's state from its bodies where others moved them: its joints' positions and speeds.</summary>
    public void Read(int articulation)
    {
        ArticulationTree tree = Solvers[articulation].Tree;
        for (int link = 0; link < tree.Count; link++)
        {
            int body = _bodies[articulation][link];
            tree.Poses[link] = _system.Bodies.Poses[body];
            tree.Motions[link] = new Twist(_system.Bodies.AngularVelocities[body], _system.Bodies.LinearVelocities[body]);
        }

        if (!_isReduced)
            TreeKinematics.Read(tree);
    }

    /// <summary>Puts the links where the joints' positions have them, seen from the root, and their bodies with them.</summary>
    public void Place(int articulation)
    {
        ArticulationTree tree = Solvers[articulation].Tree;
        TreeKinematics.Place(tree);
        TreeKinematics.Move(tree);
        for (int link = 1; link < tree.Count; link++)
        {
            int body = _bodies[articulation][link];
            _system.Bodies.Poses[body] = tree.Poses[link];
            _system.Bodies.LinearVelocities[body] = tree.Motions[link].Linear;
            _system.Bodies.AngularVelocities[body] = tree.Motions[link].Angular;
        }
    }

    private static void Teleport(ArticulationTree tree, in Pose root)
    {
        Pose way = root * tree.Poses[0].Inverse();
        tree.Poses[0] = root;
        for (int i = 1; i < tree.Count; i++)
            tree.Poses[i] = way * tree.Poses[i];
    }

    private void Stop(ArticulationTree tree, int[] bodies)
    {
        _system.Stops++;
        Array.Clear(tree.Speeds, 0, tree.Speeds.Length);
        for (int link = 0; link < tree.Count; link++)
        {
            tree.Poses[link] = _system.Bodies.Poses[bodies[link]];
            tree.Motions[link] = default;
        }

        TreeKinematics.Read(tree);
    }
}
