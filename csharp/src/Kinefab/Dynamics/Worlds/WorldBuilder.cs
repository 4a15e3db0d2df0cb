using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Dynamics.Articulations;
using Kinefab.Joints;
using Kinefab.Mechanisms;
using Kinefab.Numerics;
using Kinefab.Validation;
using Document = Kinefab.Document;

namespace Kinefab.Dynamics;

/// <summary>Makes a world's bodies and joints from a scene.</summary>
internal sealed class WorldBuilder
{
    private const double Radians = Math.PI / 180;

    private readonly ValidScene _scene;

    private readonly MechanismDefinition _definition;
    private readonly List<Kinefab.Joints.JointModel> _joints;

    /// <summary>Bodies and joints of a scene.</summary>
    /// <param name="scene">What to make them from.</param>
    /// <param name="locksAsJoints">Frozen positions are held by joints to the world, for a solver that knows no locks.</param>
    public WorldBuilder(ValidScene scene, bool locksAsJoints)
    {
        _scene = scene;
        _definition = MechanismDefinition.From(scene);
        int[] objects = _definition.GameObjects;
        var bodies = new Bodies(Array.ConvertAll(objects, i => RigidbodyModel.Of(scene.Body(i)!, scene.Document.Physics, scene.WorldTransform(i).Pose)));
        _joints = new List<Kinefab.Joints.JointModel>(_definition.MakeJoints(scene, bodies.Poses));
        if (locksAsJoints)
        {
            MakeLocks(bodies);
        }
        else
        {
            LeaveLinksInPlace();
        }

        MultibodySystem = new MultibodySystem(bodies, _joints.ToArray(), MakeCouplings(bodies)) { Gravity = scene.Document.Physics.Gravity };
        Articulated = ArticulationModel.Of(scene, _definition, MultibodySystem, isReduced: !locksAsJoints);
        Bodies = new WorldBody[objects.Length];
        for (int i = 0; i < Bodies.Length; i++)
        {
            int gameObject = objects[i];
            Rigidbody body = scene.Body(gameObject)!;
            Bodies[i] = new WorldBody(MultibodySystem, i, gameObject, scene, body);
        }

        foreach (int[] links in Articulated.Links)
            Bodies[links[0]].LinksBelow = links.AsSpan(1).ToArray();
        Joints = new WorldJoint[_definition.Joints.Count];
        for (int i = 0; i < Joints.Length; i++)
        {
            JointDefinition joint = _definition.Joints[i];
            var place = new JointPlace(joint.GameObject, joint.Component, scene.Document.GameObjects[joint.GameObject].Id);
            Joints[i] = joint.Source switch
            {
                _ when joint.Link is not null && joint.Connected >= 0 => new WorldLinkJoint(MultibodySystem, i, place, joint, Articulated),
                HingeJoint hinge => new WorldHingeJoint(MultibodySystem, i, place, hinge),
                ConfigurableJoint configurable => new WorldConfigurableJoint(MultibodySystem, i, place, configurable),
                _ => new WorldFixedJoint(MultibodySystem, i, place),
            };
        }
    }

    public MultibodySystem MultibodySystem { get; }

    /// <summary>Its articulations; none in a scene without.</summary>
    public ArticulatedBodies Articulated { get; }

    public WorldBody[] Bodies { get; }

    public WorldJoint[] Joints { get; }

    // PhysX projects no joint that a link takes part in: its pose follows from its joints.
    private void LeaveLinksInPlace()
    {
        for (int i = 0; i < _definition.Joints.Count; i++)
        {
            JointDefinition joint = _definition.Joints[i];
            if (IsLink(joint.Own) || IsLink(joint.Connected))
                _joints[i].Projection = false;
        }
    }

    private bool IsLink(int body) => body >= 0 && _scene.Document.GameObjects[_definition.GameObjects[body]].Link is not null;

    // They stand behind the scene's joints, so that those keep their indices. Actor 0 is the world: its axes do not turn.
    private void MakeLocks(Bodies bodies)
    {
        for (int i = 0; i < bodies.Count; i++)
        {
            BodyLocks locks = bodies.Locks[i];
            if (locks != BodyLocks.None && !bodies.IsKinematic[i])
            {
                _joints.Add(new D6Joint
                {
                    Body1 = i,
                    Frame0 = new Pose(bodies.Poses[i].Position, Quaterniond.Identity),
                    X = Locked(locks, BodyLocks.LinearX),
                    Y = Locked(locks, BodyLocks.LinearY),
                    Z = Locked(locks, BodyLocks.LinearZ),
                    Twist = AxisMotion.Free,
                    Swing1 = AxisMotion.Free,
                    Swing2 = AxisMotion.Free,
                });
            }
        }
    }

    private static AxisMotion Locked(BodyLocks locks, BodyLocks one) => (locks & one) != 0 ? AxisMotion.Locked : AxisMotion.Free;

    private Kinefab.Joints.CoordinateCoupling[] MakeCouplings(Bodies bodies)
    {
        var couplings = new List<Kinefab.Joints.CoordinateCoupling>();
        foreach (Document.Coupling coupling in _scene.Document.Couplings)
        {
            if (MakeCoupling(coupling, bodies) is Kinefab.Joints.CoordinateCoupling made)
            {
                couplings.Add(made);
            }
        }

        return couplings.ToArray();
    }

    /// <summary>In radians, and with the coordinates' values at the start in the offset: the file counts from there. Null when a joint's object is inactive.</summary>
    private Kinefab.Joints.CoordinateCoupling? MakeCoupling(Document.Coupling coupling, Bodies bodies)
    {
        if (Find(coupling.B) is not Kinefab.Joints.CoordinateAxisMap driven)
        {
            return null;
        }

        double unit = driven.IsAngle ? Radians : 1;
        double offset = coupling.Offset * unit + Start(driven);
        var terms = new List<(Kinefab.Joints.CoordinateAxisMap, double)>();
        foreach (Document.CouplingTerm term in coupling.Followed)
        {
            if (Find(term.Coordinate) is not Kinefab.Joints.CoordinateAxisMap followed)
            {
                return null;
            }

            double ratio = term.Ratio * unit / (followed.IsAngle ? Radians : 1);
            offset -= ratio * Start(followed);
            terms.Add((followed, ratio));
        }

        return new Kinefab.Joints.CoordinateCoupling(driven, terms, offset);

        double Start(in Kinefab.Joints.CoordinateAxisMap of) => of.Evaluate(bodies.PoseOf(of.Joint.Body0), bodies.PoseOf(of.Joint.Body1), 0, out _);
    }

    /// <summary>Null when the joint's object is inactive.</summary>
    private Kinefab.Joints.CoordinateAxisMap? Find(Document.JointCoordinate coordinate)
    {
        int index = _definition.IndexOf(coordinate.GameObject, coordinate.Component);
        if (index < 0)
        {
            return null;
        }

        CoordinateAxis axis = coordinate.Coordinate == Coordinate.Angle
            ? CoordinateAxis.AngularX
            : (CoordinateAxis)(coordinate.Coordinate - Coordinate.X);
        return new Kinefab.Joints.CoordinateAxisMap(_joints[index], axis, UnityJoints.CoordinateSign(_definition.Joints[index].Source));
    }
}
