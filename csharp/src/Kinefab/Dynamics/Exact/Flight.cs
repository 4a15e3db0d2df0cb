using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// Motion of each body under its own momentum over a step h, angular momentum kept exactly:
/// x' = x + h v; q' = exp(h w) q with w = R(m) I^-1 R(m)^T L at the middle rotation m = exp(h/2 w) q, found by iteration.
/// Second order and time-reversible.
/// </summary>
internal static class Flight<V>
    where V : struct, ILane<V>
{
    /// <summary>Moves all moving bodies from X, Q to EndX, EndQ and fills W and R.</summary>
    /// <param name="batch">The bodies.</param>
    /// <param name="h">Step, s; |w| h up to 1.</param>
    /// <param name="passes">Iterations for w.</param>
    /// <param name="isFirst">Start from w at the start's rotation, else from the last flight's w. Lanes that are not
    /// active keep that w, and so the flight they had.</param>
    public static void Run(Batch<V> batch, double h, int passes, bool isFirst)
    {
        if (isFirst)
        {
            MoveKinematic(batch, h);
        }

        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        Lane<V> active = Lane<V>.Load(batch.Active, 0);
        Lane<V> step = Lane<V>.Splat(h);
        Lane<V> quarter = Lane<V>.Splat(h / 4);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<V>.Body(body, 0);
            LaneVector<V> x = LaneVector<V>.Load(a, o + BodySlot.X * w);
            (x + step * LaneVector<V>.Load(a, o + BodySlot.V * w)).Store(a, o + BodySlot.EndX * w);

            LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o + BodySlot.Q * w);
            LaneVector<V> momentum = LaneVector<V>.Load(a, o + BodySlot.L * w);
            LaneVector<V> inverse = LaneVector<V>.Load(a, o + BodySlot.InverseInertia * w);
            LaneVector<V> rate = isFirst ? Rate(q, momentum, inverse) : LaneVector<V>.Load(a, o + BodySlot.W * w);
            for (int pass = 0; pass < passes; pass++)
            {
                LaneQuaternion<V> middle = LaneQuaternion<V>.Exponential(quarter * rate) * q;
                rate = LaneVector<V>.Select(active, Rate(middle, momentum, inverse), rate);
            }

            rate.Store(a, o + BodySlot.W * w);
            LaneQuaternion<V> half = LaneQuaternion<V>.Exponential(quarter * rate);
            q = (half * (half * q)).NearlyNormalized();
            q.Store(a, o + BodySlot.EndQ * w);
            q.StoreMatrix(a, o + BodySlot.R * w);
        }
    }

    /// <summary>Poses and matrices of the start as those of the end, for all bodies.</summary>
    public static void Stay(Batch<V> batch)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        for (int body = 0; body < batch.Shape.Bodies.Length; body++)
        {
            int o = Batch<V>.Body(body, 0);
            LaneVector<V>.Load(a, o + BodySlot.X * w).Store(a, o + BodySlot.EndX * w);
            LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o + BodySlot.Q * w);
            q.Store(a, o + BodySlot.EndQ * w);
            q.StoreMatrix(a, o + BodySlot.R * w);
        }
    }

    /// <summary>
    /// How much the inverse inertia turns on the way from the start to the middle of the last flight, against its least
    /// principal value: the largest (h |w| / 2)^2 I_max / I_min of each lane's bodies, written to Turning.
    /// </summary>
    public static void MeasureTurning(Batch<V> batch, double h)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        Lane<V> most = Lane<V>.Splat(0);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<V>.Body(body, 0);
            LaneVector<V> rate = LaneVector<V>.Load(a, o + BodySlot.W * w);
            most = Lane<V>.Max(most, LaneVector<V>.Dot(rate, rate) * Lane<V>.Load(a, o + BodySlot.InertiaRatio * w));
        }

        (Lane<V>.Splat(h * h / 4) * most).Store(batch.Turning, 0);
    }

    /// <summary>World inverse inertias at the middle of the last flight where the mask is not 0, at its start elsewhere.</summary>
    public static void MiddleInertias(Batch<V> batch, double h, double[] mask)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        Lane<V> isMiddle = Lane<V>.Load(mask, 0);
        Lane<V> quarter = Lane<V>.Select(isMiddle, Lane<V>.Splat(h / 4), Lane<V>.Splat(0));
        double[] matrix = batch.Rotation;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<V>.Body(body, 0);
            LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o + BodySlot.Q * w);
            LaneVector<V> rate = LaneVector<V>.Load(a, o + BodySlot.W * w);
            (LaneQuaternion<V>.Exponential(quarter * rate) * q).StoreMatrix(matrix, 0);
            ResponseMatrix<V>.InverseInertia(batch, body, matrix, 0);
        }
    }

    private static void MoveKinematic(Batch<V> batch, double h)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        Lane<V> step = Lane<V>.Splat(h);
        Lane<V> half = Lane<V>.Splat(h / 2);
        for (int body = batch.Shape.MovingBodies; body < batch.Shape.Bodies.Length; body++)
        {
            if (batch.Shape.IsStatic[body])
            {
                continue;
            }

            int o = Batch<V>.Body(body, 0);
            LaneVector<V> x = LaneVector<V>.Load(a, o + BodySlot.X * w);
            (x + step * LaneVector<V>.Load(a, o + BodySlot.V * w)).Store(a, o + BodySlot.EndX * w);
            LaneVector<V> rate = LaneVector<V>.Load(a, o + BodySlot.W * w);
            LaneQuaternion<V> q = LaneQuaternion<V>.Exponential(half * rate) * LaneQuaternion<V>.Load(a, o + BodySlot.Q * w);
            q = q.NearlyNormalized();
            q.Store(a, o + BodySlot.EndQ * w);
            q.StoreMatrix(a, o + BodySlot.R * w);
        }
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static LaneVector<V> Rate(LaneQuaternion<V> q, LaneVector<V> momentum, LaneVector<V> inverse) =>
        q.Rotate(LaneVector<V>.Scale(inverse, q.InverseRotate(momentum)));
}
