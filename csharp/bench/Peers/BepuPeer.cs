#if BEPU
using System;
using System.Collections.Generic;
using System.Numerics;
using BepuPhysics;
using BepuPhysics.Collidables;
using BepuPhysics.CollisionDetection;
using BepuPhysics.Constraints;
using BepuUtilities;
using BepuUtilities.Memory;
using Kinefab.Dynamics;
using Kinefab.Numerics;

namespace Kinefab.Bench.Peers;

/// <summary>BepuPhysics 2; a driven hinge has a twist servo beside it.</summary>
internal sealed class BepuPeer : IPeer
{
    private readonly BufferPool _pool = new();
    private readonly Simulation _simulation;
    private readonly List<BodyHandle> _bodies = new();

    /// <param name="scene">What moves.</param>
    /// <param name="iterations">Of each substep.</param>
    /// <param name="substeps">Of each step.</param>
    /// <param name="frequency">Of the joints' springs, Hz: Bepu's own advice is half of the rate of its substeps at most.</param>
    public BepuPeer(MultibodySystem scene, int iterations, int substeps, float frequency)
    {
        _simulation = Simulation.Create(_pool, new NoContacts(), new Gravity(Of(scene.Gravity)), new SolveDescription(iterations, substeps));
        Kinefab.Dynamics.Bodies bodies = scene.Bodies;
        for (int i = 0; i < bodies.Count; i++)
        {
            Vector3d inverse = bodies.InverseInertias[i];
            var inertia = new BodyInertia
            {
                InverseMass = (float)bodies.InverseMasses[i],
                InverseInertiaTensor = new Symmetric3x3 { XX = (float)inverse.X, YY = (float)inverse.Y, ZZ = (float)inverse.Z },
            };
            var pose = new RigidPose(Of(bodies.Poses[i].Position), Of(bodies.Poses[i].Rotation));
            var velocity = new BodyVelocity(Of(bodies.LinearVelocities[i]), Of(bodies.AngularVelocities[i]));
            _bodies.Add(_simulation.Bodies.Add(BodyDescription.CreateDynamic(pose, velocity, inertia, default, new BodyActivityDescription(-1))));
        }

        BodyHandle world = _simulation.Bodies.Add(BodyDescription.CreateKinematic(RigidPose.Identity, default, new BodyActivityDescription(-1)));
        var spring = new SpringSettings(frequency, 1);
        foreach (PeerJoint hinge in PeerJoint.Hinges(scene))
        {
            BodyHandle body0 = hinge.Body0 < 0 ? world : _bodies[hinge.Body0];
            BodyHandle body1 = hinge.Body1 < 0 ? world : _bodies[hinge.Body1];
            _simulation.Solver.Add(body0, body1, new Hinge
            {
                LocalOffsetA = Of(hinge.Frame0.Position),
                LocalHingeAxisA = Vector3.Normalize(Of(hinge.Frame0.Rotation * Vector3d.UnitX)),
                LocalOffsetB = Of(hinge.Frame1.Position),
                LocalHingeAxisB = Vector3.Normalize(Of(hinge.Frame1.Rotation * Vector3d.UnitX)),
                SpringSettings = spring,
            });
            if (hinge.Motor is not null)
            {
                // The servo's axis is Z of its bases.
                Quaterniond toX = new Quaterniond(0, 1, 0, 1).Normalized();
                _simulation.Solver.Add(body0, body1, new TwistServo
                {
                    LocalBasisA = Of(hinge.Frame0.Rotation * toX),
                    LocalBasisB = Of(hinge.Frame1.Rotation * toX),
                    SpringSettings = spring,
                    ServoSettings = ServoSettings.Default,
                });
            }
        }
    }

    public void Step(double dt) => _simulation.Timestep((float)dt);

    public void Write(Kinefab.Dynamics.Bodies bodies)
    {
        for (int i = 0; i < bodies.Count; i++)
        {
            BodyReference body = _simulation.Bodies[_bodies[i]];
            Quaternion q = body.Pose.Orientation;
            bodies.Poses[i] = new Pose(Of(body.Pose.Position), new Quaterniond(q.X, q.Y, q.Z, q.W).Normalized());
            bodies.LinearVelocities[i] = Of(body.Velocity.Linear);
            bodies.AngularVelocities[i] = Of(body.Velocity.Angular);
        }
    }

    public void Dispose()
    {
        _simulation.Dispose();
        _pool.Clear();
    }

    private static Vector3 Of(Vector3d v) => new((float)v.X, (float)v.Y, (float)v.Z);

    private static Vector3d Of(Vector3 v) => new(v.X, v.Y, v.Z);

    private static Quaternion Of(Quaterniond q) => Quaternion.Normalize(new Quaternion((float)q.X, (float)q.Y, (float)q.Z, (float)q.W));

    private struct NoContacts : INarrowPhaseCallbacks
    {
        public readonly void Initialize(Simulation simulation)
        {
        }

        public readonly bool AllowContactGeneration(int workerIndex, CollidableReference a, CollidableReference b, ref float speculativeMargin) => false;

        public readonly bool AllowContactGeneration(int workerIndex, CollidablePair pair, int childIndexA, int childIndexB) => false;

        public readonly bool ConfigureContactManifold<TManifold>(int workerIndex, CollidablePair pair, ref TManifold manifold, out PairMaterialProperties pairMaterial)
            where TManifold : unmanaged, IContactManifold<TManifold>
        {
            pairMaterial = default;
            return false;
        }

        public readonly bool ConfigureContactManifold(int workerIndex, CollidablePair pair, int childIndexA, int childIndexB, ref ConvexContactManifold manifold) => false;

        public readonly void Dispose()
        {
        }
    }

    private struct Gravity : IPoseIntegratorCallbacks
    {
        private readonly Vector3 _gravity;
        private Vector3Wide _change;

        public Gravity(Vector3 gravity)
        {
            _gravity = gravity;
            _change = default;
        }

        public readonly AngularIntegrationMode AngularIntegrationMode => AngularIntegrationMode.ConserveMomentum;

        public readonly bool AllowSubstepsForUnconstrainedBodies => true;

        public readonly bool IntegrateVelocityForKinematics => false;

        public readonly void Initialize(Simulation simulation)
        {
        }

        public void PrepareForIntegration(float dt) => _change = Vector3Wide.Broadcast(_gravity * dt);

        public readonly void IntegrateVelocity(Vector<int> bodyIndices, Vector3Wide position, QuaternionWide orientation, BodyInertiaWide localInertia, Vector<int> integrationMask, int workerIndex, Vector<float> dt, ref BodyVelocityWide velocity) =>
            velocity.Linear += _change;
    }
}
#endif
