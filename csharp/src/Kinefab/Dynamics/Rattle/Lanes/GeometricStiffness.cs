using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// How stiff tension makes each body: a force F pulling on an anchor at the lever r holds the body's turns across r like a
/// pendulum's, F.r / (I + m r^2), with I the moment across r. The sum over the anchors is near the square of the fastest of the
/// body's swings; times h^2, a leapfrog is stable below 4.
/// </summary>
internal static class GeometricStiffness<V>
    where V : struct, ILane<V>
{
    private const double LeastSquare = 1e-300;

    /// <summary>Writes the square of that frequency, 1/s^2, for each body.</summary>
    /// <param name="batch">Built at the end pose.</param>
    /// <param name="impulses">Impulses of the rows.</param>
    /// <param name="duration">Seconds in which they act.</param>
    public static void Estimate(LaneRecords<V> batch, double[] impulses, double duration)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> half = Lane<V>.Splat(0.5);
        Lane<V> rate = Lane<V>.Splat(1 / duration);
        Lane<V> least = Lane<V>.Splat(LeastSquare);
        Island shape = batch.Shape;
        for (int body = 0; body < shape.MovingBodies; body++)
        {
            zero.Store(a, LaneRecords<V>.Body(body, BodyLanes.Stiffness));
        }

        for (int n = 0; n < shape.Blocks.Length; n++)
        {
            RowBlock block = shape.Blocks[n];
            if (block.LinearMask != 7)
            {
                continue;
            }

            LaneVector<V> impulse = LaneVector<V>.Load(impulses, shape.Pattern.Rows[n] * w);
            for (int side = 0; side < 2; side++)
            {
                int body = block.Bodies[side];
                if (body >= shape.MovingBodies)
                {
                    continue;
                }

                LaneVector<V> lever = LaneVector<V>.Load(batch.Joints, LaneRecords<V>.Joint(n, LaneRecords<V>.WorldFrame(side)));
                int inverse = LaneRecords<V>.Body(body, BodyLanes.WorldInverse);
                Lane<V> trace = Lane<V>.Load(a, inverse) + Lane<V>.Load(a, inverse, 1) + Lane<V>.Load(a, inverse, 2);
                Lane<V> square = LaneVector<V>.Dot(lever, lever);
                Lane<V> light = half * (trace * square - LaneVector<V>.Dot(lever, LaneVector<V>.Transform(a, inverse, 0, lever)));
                Lane<V> heavy = Lane<V>.Splat(1) / Lane<V>.Load(a, LaneRecords<V>.Body(body, BodyLanes.InverseMass));
                Lane<V> pull = LaneVector<V>.Dot(impulse, lever) / (square + least);
                pull = side == 0 ? pull : zero - pull;
                Lane<V> stiffness = rate * Lane<V>.Max(pull, zero) * (light / (Lane<V>.Splat(1) + heavy * light));
                int o = LaneRecords<V>.Body(body, BodyLanes.Stiffness);
                (Lane<V>.Load(a, o) + stiffness).Store(a, o);
            }
        }
    }
}
