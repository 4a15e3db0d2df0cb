#if JITTER2
using System.Collections.Generic;
using Jitter2;
using Jitter2.Dynamics;
using Jitter2.Dynamics.Constraints;
using Jitter2.LinearMath;
using Kinefab.Dynamics;
using Kinefab.Numerics;

namespace Kinefab.Bench.Peers;

/// <summary>Jitter2 with its own iterations and softness; a driven hinge has an angular motor that holds speed 0.</summary>
internal sealed class JitterPeer : IPeer
{
    private readonly Jitter2.World _world = new() { AllowDeactivation = false };
    private readonly List<RigidBody> _bodies = new();

    public JitterPeer(MultibodySystem scene, int substeps)
    {
        _world.SubstepCount = substeps;
        _world.Gravity = Of(scene.Gravity);
        Kinefab.Dynamics.Bodies bodies = scene.Bodies;
        for (int i = 0; i < bodies.Count; i++)
        {
            RigidBody body = _world.CreateRigidBody();
            Vector3d inverse = bodies.InverseInertias[i];
            body.SetMassInertia(JMatrix.CreateScale((float)(1 / inverse.X), (float)(1 / inverse.Y), (float)(1 / inverse.Z)), (float)(1 / bodies.InverseMasses[i]));
            body.Position = Of(bodies.Poses[i].Position);
            Quaterniond q = bodies.Poses[i].Rotation;
            body.Orientation = new JQuaternion((float)q.X, (float)q.Y, (float)q.Z, (float)q.W);
            body.Velocity = Of(bodies.LinearVelocities[i]);
            body.AngularVelocity = Of(bodies.AngularVelocities[i]);
            body.Damping = (0, 0);
            _bodies.Add(body);
        }

        foreach (PeerJoint hinge in PeerJoint.Hinges(scene))
        {
            RigidBody body0 = hinge.Body0 < 0 ? _world.NullBody : _bodies[hinge.Body0];
            var joint = new HingeJoint(_world, body0, _bodies[hinge.Body1], Of(hinge.Frame.Position), Of(hinge.Frame.Rotation * Vector3d.UnitX), hinge.Motor is not null);
            if (joint.Motor is { } motor)
            {
                motor.TargetVelocity = 0;
                motor.MaximumForce = 1e6f;
            }
        }
    }

    public void Step(double dt) => _world.Step((float)dt, multiThread: false);

    public void Write(Kinefab.Dynamics.Bodies bodies)
    {
        for (int i = 0; i < bodies.Count; i++)
        {
            RigidBody body = _bodies[i];
            JQuaternion q = body.Orientation;
            bodies.Poses[i] = new Pose(Of(body.Position), new Quaterniond(q.X, q.Y, q.Z, q.W).Normalized());
            bodies.LinearVelocities[i] = Of(body.Velocity);
            bodies.AngularVelocities[i] = Of(body.AngularVelocity);
        }
    }

    public void Dispose() => _world.Dispose();

    private static JVector Of(Vector3d v) => new((float)v.X, (float)v.Y, (float)v.Z);

    private static Vector3d Of(JVector v) => new(v.X, v.Y, v.Z);
}
#endif
