using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>Copies one island between the world's bodies and a lane of a batch.</summary>
internal static class Transfer<V>
    where V : struct, ILane<V>
{
    // A kinematic body that is this close to where it was driven has not been moved otherwise, m and half radians.
    private const double Near = 1e-9;

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

    /// <summary>State, forces and damping for a step of dt; true when a pose is not the one that the last step left.</summary>
    /// <param name="batch">Where to.</param>
    /// <param name="lane">Which lane of it.</param>
    /// <param name="island">Whose bodies.</param>
    /// <param name="mechanism">Where from.</param>
    /// <param name="dt">Step, s.</param>
    /// <param name="fastest">Largest angular speed of the moving bodies, rad/s.</param>
    public static bool Load(Batch<V> batch, int lane, Island island, MultibodySystem mechanism, double dt, out double fastest)
    {
        fastest = 0;
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

            Vector3d v = bodies.LinearVelocities[body] * Math.Max(0, 1 - bodies.LinearDampings[body] * dt);
            Vector3d w = bodies.AngularVelocities[body] * Math.Max(0, 1 - bodies.AngularDampings[body] * dt);
            double speed = w.Length;
            if (speed > bodies.MaxAngularSpeeds[body])
            {
                w *= bodies.MaxAngularSpeeds[body] / speed;
                speed = bodies.MaxAngularSpeeds[body];
            }

            fastest = Math.Max(fastest, speed);

            Put(a, o + BodySlot.V * Lane<V>.Width, v);
            Put(a, o + BodySlot.L * Lane<V>.Width, Momentum(pose.Rotation, w, bodies.InverseInertias[body]));
            Vector3d gravity = bodies.UseGravity[body] ? mechanism.Gravity : Vector3d.Zero;
            Put(a, o + BodySlot.Acceleration * Lane<V>.Width, gravity + bodies.Forces[body] * bodies.InverseMasses[body]);
            Put(a, o + BodySlot.Torque * Lane<V>.Width, OnTurningAxes(pose.Rotation, bodies.Torques[body], bodies.InverseInertias[body]));
        }

        return isMoved;
    }

    /// <summary>Poses and velocities back to the world's bodies; forces are used up.</summary>
    public static void Store(Batch<V> batch, int lane, Island island, MultibodySystem mechanism)
    {
        Bodies bodies = mechanism.Bodies;
        double[] a = batch.Bodies;
        for (int b = 0; b < island.MovingBodies; b++)
        {
            int body = island.Bodies[b];
            int o = Batch<V>.Body(b, 0) + lane;
            Quaterniond q = Quaternion(a, o + BodySlot.EndQ * Lane<V>.Width);
            bodies.Poses[body] = new Pose(Vector(a, o + BodySlot.EndX * Lane<V>.Width), q);
            bodies.LinearVelocities[body] = Vector(a, o + BodySlot.V * Lane<V>.Width);
            Vector3d momentum = Vector(a, o + BodySlot.L * Lane<V>.Width);
            bodies.AngularVelocities[body] = q * Vector3d.Scale(bodies.InverseInertias[body], q.InverseRotate(momentum));
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
            batch.Total[i * Lane<V>.Width + lane] = from.Total[i];
        }
    }

    private static Vector3d Momentum(Quaterniond q, Vector3d w, Vector3d inverse)
    {
        Vector3d inBody = q.InverseRotate(w);
        return q * new Vector3d(Over(inBody.X, inverse.X), Over(inBody.Y, inverse.Y), Over(inBody.Z, inverse.Z));
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

    // An infinite moment does not turn: its momentum is left out.
    private static double Over(double w, double inverse) => inverse > 0 ? w / inverse : 0;

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
