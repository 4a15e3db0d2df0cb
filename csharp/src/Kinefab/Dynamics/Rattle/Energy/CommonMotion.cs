using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// What an island that hangs on nothing moves with as if it were one body: the velocity of its centre of mass and the angular velocity that its
/// angular momentum about that asks for. No inner force changes it, and it has no part in J v; by König's theorem its energy and that of the rest add up.
/// </summary>
internal readonly struct CommonMotion
{
    private readonly Vector3d _centre;
    private readonly Vector3d _velocity;
    private readonly Vector3d _turning;

    /// <param name="batch">Built at the end pose.</param>
    /// <param name="lane">The island's.</param>
    /// <param name="energy">Kinetic energy of that motion, J.</param>
    public static CommonMotion Of<V>(LaneRecords<V> batch, int lane, out double energy)
        where V : struct, ILane<V>
    {
        double mass = 0;
        Vector3d moment = Vector3d.Zero, momentum = Vector3d.Zero;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            double own = Mass(batch, body, lane);
            mass += own;
            moment += own * Read(batch, body, BodyLanes.EndX, lane);
            momentum += own * Read(batch, body, BodyLanes.V, lane);
        }

        Vector3d centre = (1 / mass) * moment;
        Vector3d turning = Vector3d.Zero, x = Vector3d.Zero, y = Vector3d.Zero, z = Vector3d.Zero;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            double own = Mass(batch, body, lane);
            Vector3d arm = Read(batch, body, BodyLanes.EndX, lane) - centre;
            turning += own * Vector3d.Cross(arm, Read(batch, body, BodyLanes.V, lane)) + Read(batch, body, BodyLanes.L, lane);
            x += Inertia(batch, body, lane, Vector3d.UnitX) + own * Vector3d.Cross(arm, Vector3d.Cross(Vector3d.UnitX, arm));
            y += Inertia(batch, body, lane, Vector3d.UnitY) + own * Vector3d.Cross(arm, Vector3d.Cross(Vector3d.UnitY, arm));
            z += Inertia(batch, body, lane, Vector3d.UnitZ) + own * Vector3d.Cross(arm, Vector3d.Cross(Vector3d.UnitZ, arm));
        }

        double determinant = Vector3d.Dot(x, Vector3d.Cross(y, z));
        Vector3d rate = determinant > 0
            ? (1 / determinant) * new Vector3d(Vector3d.Dot(turning, Vector3d.Cross(y, z)), Vector3d.Dot(turning, Vector3d.Cross(z, x)), Vector3d.Dot(turning, Vector3d.Cross(x, y)))
            : Vector3d.Zero;
        energy = (momentum.LengthSquared / mass + Vector3d.Dot(turning, rate)) / 2;
        return new CommonMotion(centre, (1 / mass) * momentum, rate);
    }

    private CommonMotion(Vector3d centre, Vector3d velocity, Vector3d turning)
    {
        _centre = centre;
        _velocity = velocity;
        _turning = turning;
    }

    /// <summary>Scales what a body has beyond it.</summary>
    /// <param name="batch">Built at the end pose.</param>
    /// <param name="body">Index in the island.</param>
    /// <param name="lane">The island's.</param>
    /// <param name="factor">Of velocity and angular momentum.</param>
    public void ScaleRest<V>(LaneRecords<V> batch, int body, int lane, double factor)
        where V : struct, ILane<V>
    {
        Vector3d velocity = _velocity + Vector3d.Cross(_turning, Read(batch, body, BodyLanes.EndX, lane) - _centre);
        Vector3d momentum = Inertia(batch, body, lane, _turning);
        Write(batch, body, BodyLanes.V, lane, velocity + factor * (Read(batch, body, BodyLanes.V, lane) - velocity));
        Write(batch, body, BodyLanes.L, lane, momentum + factor * (Read(batch, body, BodyLanes.L, lane) - momentum));
    }

    private static double Mass<V>(LaneRecords<V> batch, int body, int lane)
        where V : struct, ILane<V>
        => 1 / batch.Bodies[LaneRecords<V>.Body(body, BodyLanes.InverseMass) + lane];

    // R I Rᵀ v.
    private static Vector3d Inertia<V>(LaneRecords<V> batch, int body, int lane, Vector3d v)
        where V : struct, ILane<V>
    {
        Vector3d x = Read(batch, body, BodyLanes.R, lane), y = Read(batch, body, BodyLanes.R + 3, lane), z = Read(batch, body, BodyLanes.R + 6, lane);
        Vector3d inBody = Vector3d.Scale(Read(batch, body, BodyLanes.Inertia, lane), v.X * x + v.Y * y + v.Z * z);
        return new Vector3d(Vector3d.Dot(x, inBody), Vector3d.Dot(y, inBody), Vector3d.Dot(z, inBody));
    }

    private static Vector3d Read<V>(LaneRecords<V> batch, int body, int number, int lane)
        where V : struct, ILane<V>
        => LaneTransfer<V>.ReadVector(batch.Bodies, LaneRecords<V>.Body(body, number) + lane);

    private static void Write<V>(LaneRecords<V> batch, int body, int number, int lane, Vector3d v)
        where V : struct, ILane<V>
    {
        int o = LaneRecords<V>.Body(body, number) + lane, w = Lane<V>.Width;
        (batch.Bodies[o], batch.Bodies[o + w], batch.Bodies[o + 2 * w]) = (v.X, v.Y, v.Z);
    }
}
