using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The frame in which a lane makes its step, by Galilei's principle the same step. An island that hangs on nothing has that of its centre of mass, lest what
/// it may gain be a share of the energy of its way. One that hangs on kinematic bodies alone, which all go on with one velocity and do not turn, has
/// theirs: there they stand, as the world does, and give no energy, of which the world's frame knows but a bound; not with linear damping, which is against
/// the world.
/// </summary>
internal static class MovingFrame<V>
    where V : struct, ILane<V>
{
    /// <summary>Of all lanes, after <see cref="LaneTransfer{V}.Gather"/>, the velocity of the frame; 0 where there is none.</summary>
    /// <param name="batch">The lanes.</param>
    /// <param name="dt">Step, s.</param>
    public static void Find(LaneRecords<V> batch, double dt)
    {
        Island shape = batch.Shape;
        for (int lane = 0; lane < Lane<V>.Width && Array.IndexOf(shape.IsStatic, true) < 0; lane++)
        {
            LaneTransfer<V>.Write(batch.Work.FrameVelocity, lane, shape.HasKinematic ? OfKinematic(batch, lane, dt) : OfCentre(batch, lane));
        }
    }

    /// <summary>The frame of a lane, found in another batch.</summary>
    public static void Copy<S>(LaneRecords<S> from, int fromLane, LaneRecords<V> to, int lane)
        where S : struct, ILane<S>
        => LaneTransfer<V>.Write(to.Work.FrameVelocity, lane, LaneTransfer<S>.ReadVector(from.Work.FrameVelocity, fromLane));

    /// <summary>Velocities of all lanes in their frames, after <see cref="LaneTransfer{V}.BeginStep"/>.</summary>
    public static void Enter(LaneRecords<V> batch)
    {
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            Vector3d frame = LaneTransfer<V>.ReadVector(batch.Work.FrameVelocity, lane);
            for (int body = 0; body < batch.Shape.Bodies.Length && frame != Vector3d.Zero; body++)
            {
                Vector3d velocity = body < batch.Shape.MovingBodies ? Read(batch, body, BodyLanes.V, lane) - frame : Vector3d.Zero;
                LaneTransfer<V>.Write(batch.Bodies, LaneRecords<V>.Body(body, BodyLanes.V) + lane, velocity);
            }
        }
    }

    /// <summary>End poses and velocities of the active lanes in the world's frame again.</summary>
    /// <param name="batch">The lanes.</param>
    /// <param name="dt">Step, s.</param>
    public static void Leave(LaneRecords<V> batch, double dt)
    {
        for (int lane = 0; lane < Lane<V>.Width; lane++)
        {
            Vector3d frame = batch.Work.Active[lane] != 0 ? LaneTransfer<V>.ReadVector(batch.Work.FrameVelocity, lane) : Vector3d.Zero;
            for (int body = 0; body < batch.Shape.Bodies.Length && frame != Vector3d.Zero; body++)
            {
                int o = LaneRecords<V>.Body(body, 0) + lane;
                LaneTransfer<V>.Write(batch.Bodies, o + BodyLanes.EndX * Lane<V>.Width, Read(batch, body, BodyLanes.EndX, lane) + dt * frame);
                LaneTransfer<V>.Write(batch.Bodies, o + BodyLanes.V * Lane<V>.Width, Read(batch, body, BodyLanes.V, lane) + frame);
            }
        }
    }

    private static Vector3d OfCentre(LaneRecords<V> batch, int lane)
    {
        double mass = 0;
        Vector3d momentum = Vector3d.Zero;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            double own = 1 / batch.Bodies[LaneRecords<V>.Body(body, BodyLanes.InverseMass) + lane];
            mass += own;
            momentum += own * Read(batch, body, BodyLanes.V, lane);
        }

        return (1 / mass) * momentum;
    }

    // Where a velocity has changed since the last step the joints have a blow to take; one at a start that was moved is taken before the step.
    private static Vector3d OfKinematic(LaneRecords<V> batch, int lane, double dt)
    {
        Island shape = batch.Shape;
        Vector3d velocity = Read(batch, shape.MovingBodies, BodyLanes.V, lane);
        bool isCommon = batch.Work.Uneven[lane] == 0 || batch.Work.Moved[lane] != 0;
        for (int body = 0; body < shape.MovingBodies && isCommon; body++)
        {
            isCommon = batch.Bodies[LaneRecords<V>.Body(body, BodyLanes.DampingFactors) + lane] == 1;
        }

        for (int body = shape.MovingBodies; body < shape.Bodies.Length && isCommon; body++)
        {
            isCommon = Read(batch, body, BodyLanes.W, lane) == Vector3d.Zero
                && LaneTransfer<V>.IsSame(Read(batch, body, BodyLanes.V, lane), velocity, Read(batch, body, BodyLanes.X, lane), dt);
        }

        return isCommon ? velocity : Vector3d.Zero;
    }

    private static Vector3d Read(LaneRecords<V> batch, int body, int number, int lane) =>
        LaneTransfer<V>.ReadVector(batch.Bodies, LaneRecords<V>.Body(body, number) + lane);
}
