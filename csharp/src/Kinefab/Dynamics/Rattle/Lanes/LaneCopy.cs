using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Copies what a batch holds of islands into another that holds the same ones, in its rows and lanes.</summary>
internal static class LaneCopy<V>
    where V : struct, ILane<V>
{
    /// <summary>What <see cref="LaneTransfer{V}.Gather"/> and <see cref="LaneTransfer{V}.BeginStep"/> have found, into a batch of the same bodies.</summary>
    public static void Start(LaneRecords<V> from, LaneRecords<V> to)
    {
        for (int b = 0; b < from.Shape.Bodies.Length; b++)
        {
            Copy(BodyLanes.X, BodyLanes.EndX - BodyLanes.X);
            Copy(BodyLanes.W, BodyLanes.R - BodyLanes.W);
            Copy(BodyLanes.Acceleration, BodyLanes.Stiffness - BodyLanes.Acceleration);

            void Copy(int slot, int count) => Array.Copy(from.Bodies, LaneRecords<V>.Body(b, slot), to.Bodies, LaneRecords<V>.Body(b, slot), count * Lane<V>.Width);
        }
    }

    /// <summary>A lane's state at the end of a step, and the guess it leaves for the next, into another batch's lane, of the rows that both have.</summary>
    public static void OneLane<S>(LaneRecords<V> batch, int lane, LaneRecords<S> from, int fromLane)
        where S : struct, ILane<S>
    {
        int w = Lane<V>.Width;
        int s = Lane<S>.Width;
        for (int b = 0; b < batch.Shape.Bodies.Length; b++)
        {
            int to = LaneRecords<V>.Body(b, 0) + lane;
            int source = LaneRecords<S>.Body(b, 0) + fromLane;
            for (int i = 0; i < BodyLanes.InverseMass; i++)
            {
                batch.Bodies[to + i * w] = from.Bodies[source + i * s];
            }

            batch.Bodies[to + BodyLanes.Stiffness * w] = from.Bodies[source + BodyLanes.Stiffness * s];
        }

        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            int row = from.Shape.Pattern.Rows[n] * s + fromLane;
            int at = batch.Shape.Pattern.Rows[n] * w + lane;
            for (int i = 0; i < batch.Shape.Blocks[n].BilateralCount; i++, at += w, row += s)
            {
                batch.VelocityImpulses[at] = from.VelocityImpulses[row];
                batch.Work.TotalImpulses[at] = from.Work.TotalImpulses[row];
            }
        }
    }

    /// <summary>The same of all lanes, into a batch of the same islands.</summary>
    public static void AllLanes(LaneRecords<V> batch, LaneRecords<V> from)
    {
        int w = Lane<V>.Width;
        for (int b = 0; b < batch.Shape.Bodies.Length; b++)
        {
            int o = LaneRecords<V>.Body(b, 0);
            Array.Copy(from.Bodies, o, batch.Bodies, o, BodyLanes.InverseMass * w);
            Lane<V>.Load(from.Bodies, o, BodyLanes.Stiffness).Store(batch.Bodies, o, BodyLanes.Stiffness);
        }

        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            int row = from.Shape.Pattern.Rows[n] * w;
            int at = batch.Shape.Pattern.Rows[n] * w;
            int count = batch.Shape.Blocks[n].BilateralCount * w;
            Array.Copy(from.VelocityImpulses, row, batch.VelocityImpulses, at, count);
            Array.Copy(from.Work.TotalImpulses, row, batch.Work.TotalImpulses, at, count);
        }
    }

    /// <summary>The guess that a lane's last step has left for the bilateral rows, and the stiffness that it found, into another batch.</summary>
    public static void Guess<S>(LaneRecords<V> batch, int lane, LaneRecords<S> to, int toLane)
        where S : struct, ILane<S>
    {
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            int row = to.Shape.Pattern.Rows[n] * Lane<S>.Width + toLane;
            int at = batch.Shape.Pattern.Rows[n] * Lane<V>.Width + lane;
            for (int i = 0; i < batch.Shape.Blocks[n].BilateralCount; i++, at += Lane<V>.Width, row += Lane<S>.Width)
            {
                to.VelocityImpulses[row] = batch.VelocityImpulses[at];
            }
        }

        for (int body = 0; body < to.Shape.MovingBodies; body++)
        {
            to.Bodies[LaneRecords<S>.Body(body, BodyLanes.Stiffness) + toLane] = batch.Bodies[LaneRecords<V>.Body(body, BodyLanes.Stiffness) + lane];
        }
    }
}
