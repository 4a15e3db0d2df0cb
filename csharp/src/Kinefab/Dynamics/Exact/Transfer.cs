using System;
using System.Runtime.CompilerServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>Copies one island between the world's bodies and a lane of a batch.</summary>
internal static class Transfer<V>
    where V : struct, ILane<V>
{
    // A kinematic body that is this close to where it was driven has not been moved otherwise, m and half radians.
    private const double Near = 1e-9;

    // Keeps 0 / 0 out of the limit of a speed.
    private const double LeastSquare = 1e-300;

    /// <summary>Constants of bodies and joints.</summary>
    public static void LoadConstants(Batch<V> batch, int lane, Island island, MultibodySystem mechanism)
    {
        for (int b = 0; b < island.Bodies.Length; b++)
        {
            int body = island.Bodies[b];
            bool isMoving = b < island.MovingBodies;
            Vector3d inverse = isMoving ? mechanism.Bodies.InverseInertias[body] : Vector3d.Zero;
            batch.Bodies[Batch<V>.Body(b, BodySlot.InverseMass) + lane] = isMoving ? mechanism.Bodies.InverseMasses[body] : 0;
            Put(batch.Bodies, Batch<V>.Body(b, BodySlot.InverseInertia) + lane, inverse);
            Put(batch.Bodies, Batch<V>.Body(b, BodySlot.Inertia) + lane, new Vector3d(OrNone(inverse.X), OrNone(inverse.Y), OrNone(inverse.Z)));
            double most = Math.Max(inverse.X, Math.Max(inverse.Y, inverse.Z));
            batch.Bodies[Batch<V>.Body(b, BodySlot.MostInverseInertia) + lane] = most;
            Put(batch.Bodies, Batch<V>.Body(b, BodySlot.EndQ) + lane, Quaterniond.Identity);
            Put(batch.Bodies, Batch<V>.Body(b, BodySlot.Q) + lane, Quaterniond.Identity);
        }

        for (int n = 0; n < island.Nodes.Length; n++)
        {
            Joint? joint = island.Nodes[n].Joint;
            if (joint != null)
            {
                for (int side = 0; side < 2; side++)
                {
                    Pose frame = side == 0 ? joint.Frame0 : joint.Frame1;
                    PutFrame(batch.Joints, Batch<V>.Joint(n, Batch<V>.Frame(side)) + lane, frame);

                    // On the world they are placed once and for all.
                    PutFrame(batch.Joints, Batch<V>.Joint(n, Batch<V>.Placed(side)) + lane, frame);
                }
            }
        }
    }

    /// <summary>State, forces and damping for a step of dt, before <see cref="Start"/>; true when a pose is not the one that the last step left.</summary>
    /// <param name="batch">Where to.</param>
    /// <param name="lane">Which lane of it.</param>
    /// <param name="island">Whose bodies.</param>
    /// <param name="mechanism">Where from.</param>
    /// <param name="dt">Step, s.</param>
    public static bool Load(Batch<V> batch, int lane, Island island, MultibodySystem mechanism, double dt)
    {
        bool isMoved = false;
        Bodies bodies = mechanism.Bodies;
        double[] a = batch.Bodies;
        for (int b = 0; b < island.Bodies.Length; b++)
        {
            int body = island.Bodies[b];
            if (body == Joint.World)
            {
                continue;
            }

            int o = Batch<V>.Body(b, 0) + lane;
            Pose pose = bodies.Poses[body];
            Vector3d lastPosition = Vector(a, o + BodySlot.EndX * Lane<V>.Width);
            Quaterniond lastRotation = Quaternion(a, o + BodySlot.EndQ * Lane<V>.Width);
            isMoved |= b < island.MovingBodies
                ? pose.Position != lastPosition || pose.Rotation != lastRotation
                : (pose.Position - lastPosition).LengthSquared > Near * Near || Distance(pose.Rotation, lastRotation) > Near;
            Put(a, o + BodySlot.X * Lane<V>.Width, pose.Position);
            Put(a, o + BodySlot.Q * Lane<V>.Width, pose.Rotation);
            if (b >= island.MovingBodies)
            {
                // A kinematic body goes to its target at constant velocity.
                BodyMotion.PredictVelocity(bodies, body, Vector3d.Zero, dt);
                Put(a, o + BodySlot.V * Lane<V>.Width, bodies.LinearVelocities[body]);
                Put(a, o + BodySlot.W * Lane<V>.Width, bodies.AngularVelocities[body]);
                continue;
            }

            Put(a, o + BodySlot.V * Lane<V>.Width, bodies.LinearVelocities[body]);
            Put(a, o + BodySlot.W * Lane<V>.Width, bodies.AngularVelocities[body]);
            a[o + BodySlot.Kept * Lane<V>.Width] = Math.Max(0, 1 - bodies.LinearDampings[body] * dt);
            a[o + (BodySlot.Kept + 1) * Lane<V>.Width] = Math.Max(0, 1 - bodies.AngularDampings[body] * dt);
            a[o + BodySlot.MaxSpeed * Lane<V>.Width] = bodies.MaxAngularSpeeds[body];
            Vector3d gravity = bodies.UseGravity[body] ? mechanism.Gravity : Vector3d.Zero;
            Put(a, o + BodySlot.Acceleration * Lane<V>.Width, gravity + bodies.Forces[body] * bodies.InverseMasses[body]);
            Put(a, o + BodySlot.Torque * Lane<V>.Width, OnTurningAxes(pose.Rotation, bodies.Torques[body], bodies.InverseInertias[body]));
        }

        return isMoved;
    }

    /// <summary>Damping, the limit of the angular speed, and momenta, in all lanes after their <see cref="Load"/>.</summary>
    public static void Start(Batch<V> batch)
    {
        Lane<V>.Splat(0).Store(batch.Work.Fastest, 0);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<V>.Body(body, 0);
            Dampen(batch, o);
            TakeMomentum(batch.Bodies, o);
            Lane<V> turn = Flight<V>.SphereRate(batch.Bodies, o, batch.Shape.Spins[body]);
            Lane<V>.Max(Lane<V>.Load(batch.Work.Fastest, 0), turn * turn).Store(batch.Work.Fastest, 0);
        }

        Lane<V>.Sqrt(Lane<V>.Load(batch.Work.Fastest, 0)).Store(batch.Work.Fastest, 0);
    }

    /// <summary>Angular velocities in all lanes, by the matrix of the end pose.</summary>
    public static void Finish(Batch<V> batch)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<V>.Body(body, 0);
            ResponseMatrix<V>.Turn(a, o + BodySlot.WorldInverse * w, LaneVector<V>.Load(a, o + BodySlot.L * w)).Store(a, o + BodySlot.W * w);
        }
    }

    /// <summary>Poses and velocities back to the world's bodies, after <see cref="Finish"/>.</summary>
    public static void Store(Batch<V> batch, int lane, Island island, MultibodySystem mechanism)
    {
        Bodies bodies = mechanism.Bodies;
        double[] a = batch.Bodies;
        for (int b = 0; b < island.MovingBodies; b++)
        {
            int body = island.Bodies[b];
            int o = Batch<V>.Body(b, 0) + lane;
            bodies.Poses[body] = new Pose(Vector(a, o + BodySlot.EndX * Lane<V>.Width), Quaternion(a, o + BodySlot.EndQ * Lane<V>.Width));
            bodies.LinearVelocities[body] = Vector(a, o + BodySlot.V * Lane<V>.Width);
            bodies.AngularVelocities[body] = Vector(a, o + BodySlot.W * Lane<V>.Width);
        }
    }

    /// <summary>A lane's state at the end of a step, and the guess it leaves for the next, into another batch's lane.</summary>
    public static void CopyFrom(Batch<V> batch, int lane, Batch<ScalarLane> from)
    {
        for (int b = 0; b < batch.Shape.MovingBodies; b++)
        {
            int to = Batch<V>.Body(b, 0) + lane;
            int source = Batch<ScalarLane>.Body(b, 0);
            for (int i = 0; i < BodySlot.InverseMass; i++)
            {
                batch.Bodies[to + i * Lane<V>.Width] = from.Bodies[source + i];
            }
        }

        for (int i = 0; i < from.Half.Length; i++)
        {
            batch.Half[i * Lane<V>.Width + lane] = from.Half[i];
            batch.Work.Total[i * Lane<V>.Width + lane] = from.Work.Total[i];
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void Dampen(Batch<V> batch, int o)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        (Lane<V>.Load(a, o + BodySlot.Kept * w) * LaneVector<V>.Load(a, o + BodySlot.V * w)).Store(a, o + BodySlot.V * w);
        LaneVector<V> rate = Lane<V>.Load(a, o + (BodySlot.Kept + 1) * w) * LaneVector<V>.Load(a, o + BodySlot.W * w);
        Lane<V> square = LaneVector<V>.Dot(rate, rate);
        Lane<V> most = Lane<V>.Load(a, o + BodySlot.MaxSpeed * w);
        Lane<V> speed = Lane<V>.Sqrt(square + Lane<V>.Splat(LeastSquare));
        Lane<V> share = Lane<V>.Min(most / speed, Lane<V>.Splat(1));
        (share * rate).Store(a, o + BodySlot.W * w);
        Lane<V>.Max(Lane<V>.Load(batch.Work.Fastest, 0), share * share * square).Store(batch.Work.Fastest, 0);
    }

    // L = R I R^T w; an infinite moment does not turn, and its momentum is left out.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void TakeMomentum(double[] a, int o)
    {
        int w = Lane<V>.Width;
        LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o + BodySlot.Q * w);
        LaneVector<V> inBody = q.InverseRotate(LaneVector<V>.Load(a, o + BodySlot.W * w));
        q.Rotate(LaneVector<V>.Scale(LaneVector<V>.Load(a, o + BodySlot.Inertia * w), inBody)).Store(a, o + BodySlot.L * w);
    }

    // A frozen rotation takes no torque: in the angular momentum it would spill into the axes that do turn.
    private static Vector3d OnTurningAxes(Quaterniond q, Vector3d torque, Vector3d inverse)
    {
        if (inverse.X > 0 && inverse.Y > 0 && inverse.Z > 0)
        {
            return torque;
        }

        Vector3d inBody = q.InverseRotate(torque);
        return q * new Vector3d(inverse.X > 0 ? inBody.X : 0, inverse.Y > 0 ? inBody.Y : 0, inverse.Z > 0 ? inBody.Z : 0);
    }

    private static double OrNone(double inverse) => inverse > 0 ? 1 / inverse : 0;

    private static double Distance(Quaterniond a, Quaterniond b) => (a * b.Conjugate()).Vector.Length;

    private static void PutFrame(double[] a, int index, Pose frame)
    {
        Put(a, index, frame.Position);
        Put(a, index + 3 * Lane<V>.Width, frame.Rotation * Vector3d.UnitX);
        Put(a, index + 6 * Lane<V>.Width, frame.Rotation * Vector3d.UnitY);
        Put(a, index + 9 * Lane<V>.Width, frame.Rotation * Vector3d.UnitZ);
    }

    private static void Put(double[] a, int index, Vector3d v)
    {
        a[index] = v.X;
        a[index + Lane<V>.Width] = v.Y;
        a[index + 2 * Lane<V>.Width] = v.Z;
    }

    private static void Put(double[] a, int index, Quaterniond q)
    {
        Put(a, index, q.Vector);
        a[index + 3 * Lane<V>.Width] = q.W;
    }

    private static Vector3d Vector(double[] a, int index) => new(a[index], a[index + Lane<V>.Width], a[index + 2 * Lane<V>.Width]);

    private static Quaterniond Quaternion(double[] a, int index) =>
        new(a[index], a[index + Lane<V>.Width], a[index + 2 * Lane<V>.Width], a[index + 3 * Lane<V>.Width]);
}
