using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics;

/// <summary>What happens to a body on its own before and after the joints are solved.</summary>
internal static class BodyMotion
{
    /// <summary>
    /// Forces, gravity, damping and the speed clamp, in this order: v += g dt; v *= max(0, 1 - d dt).
    /// A kinematic body gets the velocity that brings it to its target. Source: DyBodyCoreIntegrator.h.
    /// </summary>
    public static void PredictVelocity(Bodies bodies, int i, Vector3d gravity, double dt)
    {
        if (bodies.IsKinematic[i])
        {
            Pose from = bodies.Poses[i];
            Pose to = bodies.KinematicTargets[i];
            bodies.LinearVelocities[i] = (to.Position - from.Position) * (1 / dt);
            bodies.AngularVelocities[i] = RotationVector(to.Rotation * from.Rotation.Conjugate()) * (1 / dt);
            return;
        }

        Vector3d v = bodies.LinearVelocities[i] + bodies.Forces[i] * (bodies.InverseMasses[i] * dt);
        Vector3d w = bodies.AngularVelocities[i];
        bodies.Forces[i] = Vector3d.Zero;
        if (bodies.Torques[i] != Vector3d.Zero)
        {
            Quaterniond q = bodies.Poses[i].Rotation;
            w += q * Vector3d.Scale(bodies.InverseInertias[i], q.InverseRotate(bodies.Torques[i])) * dt;
            bodies.Torques[i] = Vector3d.Zero;
        }

        if (bodies.UseGravity[i])
        {
            v += gravity * dt;
        }

        v *= Math.Max(0, 1 - bodies.LinearDampings[i] * dt);
        w *= Math.Max(0, 1 - bodies.AngularDampings[i] * dt);
        double limit = bodies.MaxAngularSpeeds[i];
        double speed = w.Length;
        if (speed > limit)
        {
            w *= limit / speed;
        }

        bodies.LinearVelocities[i] = Unlocked(v, bodies.Locks[i], BodyLocks.LinearX, BodyLocks.LinearY, BodyLocks.LinearZ);
        bodies.AngularVelocities[i] = Unlocked(w, bodies.Locks[i], BodyLocks.AngularX, BodyLocks.AngularY, BodyLocks.AngularZ);
    }

    /// <summary>The pose after dt at constant velocity: x + v dt, exp(w dt / 2) q. Source: DyBodyCoreIntegrator.h, integrateCore.</summary>
    public static Pose Integrate(in Pose pose, Vector3d v, Vector3d w, double dt)
    {
        Vector3d position = pose.Position + v * dt;
        double speed = w.Length;
        if (speed == 0)
        {
            return new Pose(position, pose.Rotation);
        }

        double half = dt * speed * 0.5;
        Vector3d s = w * (Trigonometry.Sin(half) / speed);
        var turn = new Quaterniond(s.X, s.Y, s.Z, Trigonometry.Cos(half));
        return new Pose(position, (turn * pose.Rotation).Normalized());
    }

    /// <summary>False once squares of these numbers could overflow a float, PhysX's range, or one is not a number.</summary>
    public static bool InRange(in Pose pose, Vector3d v, Vector3d w)
    {
        const double limit = 1e18;
        return pose.Position.LengthSquared < limit * limit && v.LengthSquared < limit * limit && w.LengthSquared < limit * limit
            && pose.Rotation.LengthSquared > 0.5;
    }

    /// <summary>A velocity with its locked components set to 0.</summary>
    public static Vector3d Unlocked(Vector3d v, BodyLocks locks, BodyLocks x, BodyLocks y, BodyLocks z) =>
        locks == BodyLocks.None
            ? v
            : new Vector3d((locks & x) != 0 ? 0 : v.X, (locks & y) != 0 ? 0 : v.Y, (locks & z) != 0 ? 0 : v.Z);

    /// <summary>A pose moved and turned from where the body is, without the locked parts of the way and of the rotation vector.
    /// Source: ScConstraintSim.cpp, constrainMotion.</summary>
    public static Pose Unlocked(in Pose from, in Pose to, BodyLocks locks)
    {
        if (locks == BodyLocks.None)
        {
            return to;
        }

        Vector3d way = Unlocked(to.Position - from.Position, locks, BodyLocks.LinearX, BodyLocks.LinearY, BodyLocks.LinearZ);
        Vector3d turn = RotationVector(to.Rotation * from.Rotation.Conjugate());
        return Integrate(from, way, Unlocked(turn, locks, BodyLocks.AngularX, BodyLocks.AngularY, BodyLocks.AngularZ), 1);
    }

    private static Vector3d RotationVector(Quaterniond q)
    {
        Vector3d v = q.W < 0 ? -q.Vector : q.Vector;
        double s = v.Length;
        return s > 0 ? v * (2 * Trigonometry.Atan2(s, Math.Abs(q.W)) / s) : Vector3d.Zero;
    }
}
