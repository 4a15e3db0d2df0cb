using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Copies islands between the world's bodies and the lanes of a batch.</summary>
internal static class LaneTransfer<V>
    where V : struct, ILane<V>
{
    // A kinematic body that is this close to where it was driven has not been moved otherwise, m and half radians.
    private const double Near = 1e-9;

    // What a program's targets leave of an even velocity, of their distance from the origin a step.
    private const double Rounding = 1e-14;

    // Numbers of a pose: position, then rotation xyzw.
    private const int PoseCount = 7;

    // Keeps 0 / 0 out of the limit of a speed.
    private const double LeastSquare = 1e-300;

    /// <summary>Whose bodies a lane holds, and the constants of bodies and joints.</summary>
    public static void GatherConstants(LaneRecords<V> batch, int lane, Island island, MultibodySystem mechanism)
    {
        for (int b = 0; b < island.Bodies.Length; b++)
        {
            int body = island.Bodies[b];
            batch.Members[b * Lane<V>.Width + lane] = body;
            bool isMoving = b < island.MovingBodies;
            Vector3d inverse = isMoving ? mechanism.Bodies.InverseInertias[body] : Vector3d.Zero;
            batch.Bodies[LaneRecords<V>.Body(b, BodyLanes.InverseMass) + lane] = isMoving ? mechanism.Bodies.InverseMasses[body] : 0;
            Write(batch.Bodies, LaneRecords<V>.Body(b, BodyLanes.InverseInertia) + lane, inverse);
            Write(batch.Bodies, LaneRecords<V>.Body(b, BodyLanes.Inertia) + lane, new Vector3d(OrNone(inverse.X), OrNone(inverse.Y), OrNone(inverse.Z)));
            double most = Math.Max(inverse.X, Math.Max(inverse.Y, inverse.Z));
            batch.Bodies[LaneRecords<V>.Body(b, BodyLanes.LeastInverseInertia) + lane] = Least(inverse, most);
            Write(batch.Bodies, LaneRecords<V>.Body(b, BodyLanes.EndQ) + lane, Quaterniond.Identity);
            Write(batch.Bodies, LaneRecords<V>.Body(b, BodyLanes.Q) + lane, Quaterniond.Identity);
            if (isMoving)
            {
                // Nowhere yet: wherever the first step finds the body, it has been moved there.
                Write(batch.Bodies, LaneRecords<V>.Body(b, BodyLanes.EndX) + lane, new Vector3d(double.NaN, double.NaN, double.NaN));
            }
        }

        for (int n = 0; n < island.Blocks.Length; n++)
        {
            JointModel? joint = island.Blocks[n].Joint;
            batch.Models[n * Lane<V>.Width + lane] = joint;
            batch.Couplings[n * Lane<V>.Width + lane] = island.Blocks[n].Coupling;
            if (joint != null)
            {
                batch.JointMembers[n * Lane<V>.Width + lane] = island.Blocks[n].Index;
                for (int side = 0; side < 2; side++)
                {
                    Pose frame = side == 0 ? joint.Frame0 : joint.Frame1;
                    WriteFrame(batch.Joints, LaneRecords<V>.Joint(n, LaneRecords<V>.Frame(side)) + lane, frame);

                    // On the world they are placed once and for all.
                    WriteFrame(batch.Joints, LaneRecords<V>.Joint(n, LaneRecords<V>.WorldFrame(side)) + lane, frame);
                }
            }
        }
    }

    /// <summary>State, forces and damping of all lanes for a step, before <see cref="BeginStep"/>; fills <see cref="Workspace{V}.Moved"/>.</summary>
    /// <param name="batch">Where to.</param>
    /// <param name="mechanism">Where from.</param>
    /// <param name="dt">Step, s.</param>
    /// <returns>Whether a pose of any lane is not the one that the last step left.</returns>
    public static bool Gather(LaneRecords<V> batch, MultibodySystem mechanism, double dt)
    {
        batch.Work.Cancellation = mechanism.Cancellation;
        Lane<V>.Splat(0).Store(batch.Work.Moved, 0);
        Lane<V>.Splat(0).Store(batch.Work.Uneven, 0);
        for (int b = 0; b < batch.Shape.MovingBodies; b++)
        {
            GatherState(batch, b, mechanism.Bodies);
            GatherForces(batch, b, mechanism, dt);
        }

        foreach (int body in batch.Shape.LockedInertiaBodies)
        {
            ClearLockedTorque(batch, body, mechanism.Bodies);
        }

        for (int b = batch.Shape.MovingBodies; b < batch.Shape.Bodies.Length; b++)
        {
            for (int lane = 0; lane < Lane<V>.Width && !batch.Shape.IsStatic[b]; lane++)
            {
                GatherKinematic(batch, b, lane, mechanism.Bodies, dt);
            }
        }

        bool isMoved = false;
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            isMoved |= batch.Work.Moved[lane] != 0;
        }

        return isMoved;
    }

    /// <summary>Whether two velocities of a kinematic body differ by no more than the rounding of its targets.</summary>
    /// <param name="velocity">One, m/s.</param>
    /// <param name="other">The other, m/s.</param>
    /// <param name="position">Where it is, m.</param>
    /// <param name="dt">Step, s.</param>
    public static bool IsSame(Vector3d velocity, Vector3d other, Vector3d position, double dt) =>
        (velocity - other).Length <= Rounding * (position.Length / dt + velocity.Length);

    /// <summary>Damping, the limit of the angular speed, and momenta, in all lanes after their <see cref="Gather"/>.</summary>
    public static void BeginStep(LaneRecords<V> batch)
    {
        Lane<V>.Splat(0).Store(batch.Work.Fastest, 0);
        Lane<V>.Splat(0).Store(batch.Work.Slowed, 0);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            Dampen(batch, o);
            TakeMomentum(batch.Bodies, o);
            Lane<V> turn = FreeMotion<V>.SphericalHalfRate(batch.Bodies, o, batch.Shape.RotationSplittings[body]);
            Lane<V>.Max(Lane<V>.Load(batch.Work.Fastest, 0), turn * turn).Store(batch.Work.Fastest, 0);
        }

        Lane<V>.Sqrt(Lane<V>.Load(batch.Work.Fastest, 0)).Store(batch.Work.Fastest, 0);
    }

    /// <summary>Angular velocities in all lanes, by the matrix of the end pose.</summary>
    public static void EndStep(LaneRecords<V> batch)
    {
        double[] a = batch.Bodies;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            LaneVector<V>.Transform(a, o, BodyLanes.WorldInverse, LaneVector<V>.Load(a, o, BodyLanes.L)).Store(a, o, BodyLanes.W);
        }
    }

    /// <summary>Poses and velocities of the first lanes that are active back to the world's bodies, after <see cref="EndStep"/>.</summary>
    public static void Scatter(LaneRecords<V> batch, int lanes, MultibodySystem mechanism)
    {
        Bodies bodies = mechanism.Bodies;
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        for (int b = 0; b < batch.Shape.MovingBodies; b++)
        {
            for (int lane = 0; lane < lanes; lane++)
            {
                if (batch.Work.Active[lane] == 0)
                {
                    continue;
                }

                int body = batch.Members[b * w + lane];
                int o = LaneRecords<V>.Body(b, 0) + lane;
                bodies.Poses[body] = new Pose(ReadVector(a, o + BodyLanes.EndX * w), ReadQuaternion(a, o + BodyLanes.EndQ * w));
                bodies.LinearVelocities[body] = ReadVector(a, o + BodyLanes.V * w);
                bodies.AngularVelocities[body] = ReadVector(a, o + BodyLanes.W * w);
            }
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void GatherState(LaneRecords<V> batch, int b, Bodies bodies)
    {
        ReadOnlySpan<double> poses = MemoryMarshal.Cast<Pose, double>(bodies.Poses);
        ReadOnlySpan<int> members = batch.Members.AsSpan(b * Lane<V>.Width, Lane<V>.Width);
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        int o = LaneRecords<V>.Body(b, 0);
        Lane<V> moved = Lane<V>.Load(batch.Work.Moved, 0);
        for (int i = 0; i < PoseCount; i++)
        {
            // EndX and EndQ stand as a pose's numbers do, Q apart from X.
            Lane<V> now = Lane<V>.Gather(poses, members, PoseCount, i);
            int x = i < 3 ? BodyLanes.X + i : BodyLanes.Q - 3 + i;
            now.Store(a, o + x * w);
            moved += Lane<V>.Abs(now - Lane<V>.Load(a, o + (BodyLanes.EndX + i) * w));
        }

        moved.Store(batch.Work.Moved, 0);
        LaneVector<V>.Gather(MemoryMarshal.Cast<Vector3d, double>(bodies.LinearVelocities), members).Store(a, o, BodyLanes.V);
        LaneVector<V>.Gather(MemoryMarshal.Cast<Vector3d, double>(bodies.AngularVelocities), members).Store(a, o, BodyLanes.W);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void GatherForces(LaneRecords<V> batch, int b, MultibodySystem mechanism, double dt)
    {
        Bodies bodies = mechanism.Bodies;
        ReadOnlySpan<int> members = batch.Members.AsSpan(b * Lane<V>.Width, Lane<V>.Width);
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        int o = LaneRecords<V>.Body(b, 0);
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> one = Lane<V>.Splat(1);
        Lane<V> time = Lane<V>.Splat(dt);
        Lane<V>.Max(zero, one - Lane<V>.Gather(bodies.LinearDampings, members, 1, 0) * time).Store(a, o, BodyLanes.DampingFactors);
        Lane<V>.Max(zero, one - Lane<V>.Gather(bodies.AngularDampings, members, 1, 0) * time).Store(a, o, BodyLanes.DampingFactors + 1);
        Lane<V>.Gather(bodies.MaxAngularSpeeds, members, 1, 0).Store(a, o, BodyLanes.MaxAngularSpeed);
        LaneVector<V> force = LaneVector<V>.Gather(MemoryMarshal.Cast<Vector3d, double>(bodies.Forces), members);
        LaneVector<V> acceleration = Lane<V>.Load(a, o, BodyLanes.InverseMass) * force;
        acceleration.Store(a, o, BodyLanes.Acceleration);
        for (int lane = 0; lane < w; lane++)
        {
            if (bodies.UseGravity[members[lane]])
            {
                int at = o + BodyLanes.Acceleration * w + lane;
                Write(a, at, mechanism.Gravity + ReadVector(a, at));
            }
        }

        LaneVector<V>.Gather(MemoryMarshal.Cast<Vector3d, double>(bodies.Torques), members).Store(a, o, BodyLanes.Torque);
    }

    // An axis of infinite moment takes no torque: in the angular momentum it would spill into the axes that do turn.
    private static void ClearLockedTorque(LaneRecords<V> batch, int b, Bodies bodies)
    {
        int w = Lane<V>.Width;
        int o = LaneRecords<V>.Body(b, BodyLanes.Torque);
        for (int lane = 0; lane < w; lane++)
        {
            int body = batch.Members[b * w + lane];
            Quaterniond q = bodies.Poses[body].Rotation;
            Vector3d inverse = bodies.InverseInertias[body];
            Vector3d inBody = q.InverseRotate(bodies.Torques[body]);
            Write(batch.Bodies, o + lane, q * new Vector3d(inverse.X > 0 ? inBody.X : 0, inverse.Y > 0 ? inBody.Y : 0, inverse.Z > 0 ? inBody.Z : 0));
        }
    }

    // It goes to its target at constant velocity.
    private static void GatherKinematic(LaneRecords<V> batch, int b, int lane, Bodies bodies, double dt)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        int o = LaneRecords<V>.Body(b, 0) + lane;
        int body = batch.Members[b * w + lane];
        Pose pose = bodies.Poses[body];
        bool isMoved = (pose.Position - ReadVector(a, o + BodyLanes.EndX * w)).LengthSquared > Near * Near
            || Distance(pose.Rotation, ReadQuaternion(a, o + BodyLanes.EndQ * w)) > Near;
        batch.Work.Moved[lane] += isMoved ? 1 : 0;
        BodyMotion.PredictVelocity(bodies, body, Vector3d.Zero, dt);
        batch.Work.Uneven[lane] += IsSame(bodies.LinearVelocities[body], ReadVector(a, o + BodyLanes.V * w), pose.Position, dt) ? 0 : 1;
        Write(a, o + BodyLanes.X * w, pose.Position);
        Write(a, o + BodyLanes.Q * w, pose.Rotation);
        Write(a, o + BodyLanes.V * w, bodies.LinearVelocities[body]);

        // Where it stands, the product of the two rotations leaves it a speed of rounding.
        Write(a, o + BodyLanes.W * w, bodies.KinematicTargets[body].Rotation == pose.Rotation ? Vector3d.Zero : bodies.AngularVelocities[body]);
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void Dampen(LaneRecords<V> batch, int o)
    {
        double[] a = batch.Bodies;
        (Lane<V>.Load(a, o, BodyLanes.DampingFactors) * LaneVector<V>.Load(a, o, BodyLanes.V)).Store(a, o, BodyLanes.V);
        LaneVector<V> rate = Lane<V>.Load(a, o, BodyLanes.DampingFactors + 1) * LaneVector<V>.Load(a, o, BodyLanes.W);
        Lane<V> square = LaneVector<V>.Dot(rate, rate);
        Lane<V> most = Lane<V>.Load(a, o, BodyLanes.MaxAngularSpeed);
        Lane<V> speed = Lane<V>.Sqrt(square + Lane<V>.Splat(LeastSquare));
        Lane<V> share = Lane<V>.Min(most / speed, Lane<V>.Splat(1));
        (share * rate).Store(a, o, BodyLanes.W);
        Lane<V>.Max(Lane<V>.Load(batch.Work.Slowed, 0), Lane<V>.Splat(1) - share).Store(batch.Work.Slowed, 0);
        Lane<V>.Max(Lane<V>.Load(batch.Work.Fastest, 0), share * share * square).Store(batch.Work.Fastest, 0);
    }

    // L = R I R^T w; an infinite moment does not turn, and its momentum is left out.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void TakeMomentum(double[] a, int o)
    {
        LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o, BodyLanes.Q);
        LaneVector<V> inBody = q.InverseRotate(LaneVector<V>.Load(a, o, BodyLanes.W));
        q.Rotate(LaneVector<V>.Scale(LaneVector<V>.Load(a, o, BodyLanes.Inertia), inBody)).Store(a, o, BodyLanes.L);
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

    private static void WriteFrame(double[] a, int index, Pose frame)
    {
        Write(a, index, frame.Position);
        Write(a, index + 3 * Lane<V>.Width, frame.Rotation * Vector3d.UnitX);
        Write(a, index + 6 * Lane<V>.Width, frame.Rotation * Vector3d.UnitY);
        Write(a, index + 9 * Lane<V>.Width, frame.Rotation * Vector3d.UnitZ);
    }

    /// <summary>A lane's pose of a body at the end of the drift.</summary>
    public static Pose ReadPose(LaneRecords<V> batch, int body, int lane) => new(
        ReadVector(batch.Bodies, LaneRecords<V>.Body(body, BodyLanes.EndX) + lane), ReadQuaternion(batch.Bodies, LaneRecords<V>.Body(body, BodyLanes.EndQ) + lane));

    /// <summary>Writes a lane's numbers; the index is that of the first of them.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static void Write(double[] a, int index, Vector3d v)
    {
        a[index] = v.X;
        a[index + Lane<V>.Width] = v.Y;
        a[index + 2 * Lane<V>.Width] = v.Z;
    }

    public static void Write(double[] a, int index, Quaterniond q)
    {
        Write(a, index, q.Vector);
        a[index + 3 * Lane<V>.Width] = q.W;
    }

    /// <summary>Reads a lane's numbers; the index is that of the first of them.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Vector3d ReadVector(double[] a, int index) => new(a[index], a[index + Lane<V>.Width], a[index + 2 * Lane<V>.Width]);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Quaterniond ReadQuaternion(double[] a, int index) =>
        new(a[index], a[index + Lane<V>.Width], a[index + 2 * Lane<V>.Width], a[index + 3 * Lane<V>.Width]);
}
