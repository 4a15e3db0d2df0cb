using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Copies islands between the world's bodies and the lanes of a batch.</summary>
internal static class Transfer<V>
    where V : struct, ILane<V>
{
    // A kinematic body that is this close to where it was driven has not been moved otherwise, m and half radians.
    private const double Near = 1e-9;

    // Numbers of a pose: position, then rotation xyzw.
    private const int PoseCount = 7;

    // Keeps 0 / 0 out of the limit of a speed.
    private const double LeastSquare = 1e-300;

    /// <summary>Whose bodies a lane holds, and the constants of bodies and joints.</summary>
    public static void LoadConstants(Batch<V> batch, int lane, Island island, MultibodySystem mechanism)
    {
        for (int b = 0; b < island.Bodies.Length; b++)
        {
            int body = island.Bodies[b];
            batch.Members[b * Lane<V>.Width + lane] = body;
            bool isMoving = b < island.MovingBodies;
            Vector3d inverse = isMoving ? mechanism.Bodies.InverseInertias[body] : Vector3d.Zero;
            batch.Bodies[Batch<V>.Body(b, BodySlot.InverseMass) + lane] = isMoving ? mechanism.Bodies.InverseMasses[body] : 0;
            Put(batch.Bodies, Batch<V>.Body(b, BodySlot.InverseInertia) + lane, inverse);
            Put(batch.Bodies, Batch<V>.Body(b, BodySlot.Inertia) + lane, new Vector3d(OrNone(inverse.X), OrNone(inverse.Y), OrNone(inverse.Z)));
            double most = Math.Max(inverse.X, Math.Max(inverse.Y, inverse.Z));
            batch.Bodies[Batch<V>.Body(b, BodySlot.MostInverseInertia) + lane] = most;
            batch.Bodies[Batch<V>.Body(b, BodySlot.LeastInverseInertia) + lane] = Least(inverse, most);
            Put(batch.Bodies, Batch<V>.Body(b, BodySlot.EndQ) + lane, Quaterniond.Identity);
            Put(batch.Bodies, Batch<V>.Body(b, BodySlot.Q) + lane, Quaterniond.Identity);
            if (isMoving)
            {
                // Nowhere yet: wherever the first step finds the body, it has been moved there.
                Put(batch.Bodies, Batch<V>.Body(b, BodySlot.EndX) + lane, new Vector3d(double.NaN, double.NaN, double.NaN));
            }
        }

        for (int n = 0; n < island.Nodes.Length; n++)
        {
            JointModel? joint = island.Nodes[n].Joint;
            if (joint != null)
            {
                batch.JointMembers[n * Lane<V>.Width + lane] = island.Nodes[n].Index;
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

    /// <summary>State, forces and damping of all lanes for a step, before <see cref="Start"/>; fills <see cref="Workspace{V}.Moved"/>.</summary>
    /// <param name="batch">Where to.</param>
    /// <param name="mechanism">Where from.</param>
    /// <param name="dt">Step, s.</param>
    /// <returns>Whether a pose of any lane is not the one that the last step left.</returns>
    public static bool Load(Batch<V> batch, MultibodySystem mechanism, double dt)
    {
        Lane<V>.Splat(0).Store(batch.Work.Moved, 0);
        for (int b = 0; b < batch.Shape.MovingBodies; b++)
        {
            LoadState(batch, b, mechanism.Bodies);
            LoadForces(batch, b, mechanism, dt);
        }

        foreach (int body in batch.Shape.FrozenBodies)
        {
            KeepFrozen(batch, body, mechanism.Bodies);
        }

        for (int b = batch.Shape.MovingBodies; b < batch.Shape.Bodies.Length; b++)
        {
            for (int lane = 0; lane < Lane<V>.Width && !batch.Shape.IsStatic[b]; lane++)
            {
                LoadKinematic(batch, b, lane, mechanism.Bodies, dt);
            }
        }

        bool isMoved = false;
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            isMoved |= batch.Work.Moved[lane] != 0;
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

    /// <summary>Poses and velocities of the first lanes back to the world's bodies, after <see cref="Finish"/>.</summary>
    public static void Store(Batch<V> batch, int lanes, MultibodySystem mechanism)
    {
        Bodies bodies = mechanism.Bodies;
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        for (int b = 0; b < batch.Shape.MovingBodies; b++)
        {
            for (int lane = 0; lane < lanes; lane++)
            {
                int body = batch.Members[b * w + lane];
                int o = Batch<V>.Body(b, 0) + lane;
                bodies.Poses[body] = new Pose(Vector(a, o + BodySlot.EndX * w), Quaternion(a, o + BodySlot.EndQ * w));
                bodies.LinearVelocities[body] = Vector(a, o + BodySlot.V * w);
                bodies.AngularVelocities[body] = Vector(a, o + BodySlot.W * w);
            }
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
    private static void LoadState(Batch<V> batch, int b, Bodies bodies)
    {
        ReadOnlySpan<double> poses = MemoryMarshal.Cast<Pose, double>(bodies.Poses);
        ReadOnlySpan<int> members = batch.Members.AsSpan(b * Lane<V>.Width, Lane<V>.Width);
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        int o = Batch<V>.Body(b, 0);
        Lane<V> moved = Lane<V>.Load(batch.Work.Moved, 0);
        for (int i = 0; i < PoseCount; i++)
        {
            // EndX and EndQ stand as a pose's numbers do, Q apart from X.
            Lane<V> now = Lane<V>.Gather(poses, members, PoseCount, i);
            int x = i < 3 ? BodySlot.X + i : BodySlot.Q - 3 + i;
            now.Store(a, o + x * w);
            moved += Lane<V>.Abs(now - Lane<V>.Load(a, o + (BodySlot.EndX + i) * w));
        }

        moved.Store(batch.Work.Moved, 0);
        LaneVector<V>.Gather(MemoryMarshal.Cast<Vector3d, double>(bodies.LinearVelocities), members, 3, 0).Store(a, o + BodySlot.V * w);
        LaneVector<V>.Gather(MemoryMarshal.Cast<Vector3d, double>(bodies.AngularVelocities), members, 3, 0).Store(a, o + BodySlot.W * w);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void LoadForces(Batch<V> batch, int b, MultibodySystem mechanism, double dt)
    {
        Bodies bodies = mechanism.Bodies;
        ReadOnlySpan<int> members = batch.Members.AsSpan(b * Lane<V>.Width, Lane<V>.Width);
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        int o = Batch<V>.Body(b, 0);
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> one = Lane<V>.Splat(1);
        Lane<V> time = Lane<V>.Splat(dt);
        Lane<V>.Max(zero, one - Lane<V>.Gather(bodies.LinearDampings, members, 1, 0) * time).Store(a, o + BodySlot.Kept * w);
        Lane<V>.Max(zero, one - Lane<V>.Gather(bodies.AngularDampings, members, 1, 0) * time).Store(a, o + (BodySlot.Kept + 1) * w);
        Lane<V>.Gather(bodies.MaxAngularSpeeds, members, 1, 0).Store(a, o + BodySlot.MaxSpeed * w);
        LaneVector<V> force = LaneVector<V>.Gather(MemoryMarshal.Cast<Vector3d, double>(bodies.Forces), members, 3, 0);
        LaneVector<V> acceleration = Lane<V>.Load(a, o + BodySlot.InverseMass * w) * force;
        acceleration.Store(a, o + BodySlot.Acceleration * w);
        for (int lane = 0; lane < w; lane++)
        {
            if (bodies.UseGravity[members[lane]])
            {
                int at = o + BodySlot.Acceleration * w + lane;
                Put(a, at, mechanism.Gravity + Vector(a, at));
            }
        }

        LaneVector<V>.Gather(MemoryMarshal.Cast<Vector3d, double>(bodies.Torques), members, 3, 0).Store(a, o + BodySlot.Torque * w);
    }

    // A frozen rotation takes no torque: in the angular momentum it would spill into the axes that do turn.
    private static void KeepFrozen(Batch<V> batch, int b, Bodies bodies)
    {
        int w = Lane<V>.Width;
        int o = Batch<V>.Body(b, BodySlot.Torque);
        for (int lane = 0; lane < w; lane++)
        {
            int body = batch.Members[b * w + lane];
            Quaterniond q = bodies.Poses[body].Rotation;
            Vector3d inverse = bodies.InverseInertias[body];
            Vector3d inBody = q.InverseRotate(bodies.Torques[body]);
            Put(batch.Bodies, o + lane, q * new Vector3d(inverse.X > 0 ? inBody.X : 0, inverse.Y > 0 ? inBody.Y : 0, inverse.Z > 0 ? inBody.Z : 0));
        }
    }

    // It goes to its target at constant velocity.
    private static void LoadKinematic(Batch<V> batch, int b, int lane, Bodies bodies, double dt)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        int o = Batch<V>.Body(b, 0) + lane;
        int body = batch.Members[b * w + lane];
        Pose pose = bodies.Poses[body];
        bool isMoved = (pose.Position - Vector(a, o + BodySlot.EndX * w)).LengthSquared > Near * Near
            || Distance(pose.Rotation, Quaternion(a, o + BodySlot.EndQ * w)) > Near;
        batch.Work.Moved[lane] += isMoved ? 1 : 0;
        BodyMotion.PredictVelocity(bodies, body, Vector3d.Zero, dt);
        Put(a, o + BodySlot.X * w, pose.Position);
        Put(a, o + BodySlot.Q * w, pose.Rotation);
        Put(a, o + BodySlot.V * w, bodies.LinearVelocities[body]);
        Put(a, o + BodySlot.W * w, bodies.AngularVelocities[body]);
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

    private static double Least(Vector3d inverse, double most)
    {
        double least = most;
        for (int i = 0; i < 3; i++)
        {
            least = inverse[i] > 0 ? Math.Min(least, inverse[i]) : least;
        }

        return least;
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

    /// <summary>Writes a lane's numbers; the index is that of the first of them.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static void Put(double[] a, int index, Vector3d v)
    {
        a[index] = v.X;
        a[index + Lane<V>.Width] = v.Y;
        a[index + 2 * Lane<V>.Width] = v.Z;
    }

    public static void Put(double[] a, int index, Quaterniond q)
    {
        Put(a, index, q.Vector);
        a[index + 3 * Lane<V>.Width] = q.W;
    }

    /// <summary>Reads a lane's numbers; the index is that of the first of them.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Vector3d Vector(double[] a, int index) => new(a[index], a[index + Lane<V>.Width], a[index + 2 * Lane<V>.Width]);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Quaterniond Quaternion(double[] a, int index) =>
        new(a[index], a[index + Lane<V>.Width], a[index + 2 * Lane<V>.Width], a[index + 3 * Lane<V>.Width]);
}
