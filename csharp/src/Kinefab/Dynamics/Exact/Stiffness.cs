using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// How stiff tension makes each body: with the anchors' forces F at levers r, K = sum (F.r) 1 - sym(r F^T), the square of
/// the fastest of its swings is at most about half the trace of I^-1 K, tension alone counted. Times h^2, a leapfrog is stable
/// below 4.
/// </summary>
internal static class Stiffness<V>
    where V : struct, ILane<V>
{
    /// <summary>Writes the square of that frequency, 1/s^2, for each body.</summary>
    /// <param name="batch">Built at the end pose.</param>
    /// <param name="impulses">Impulses of the rows.</param>
    /// <param name="duration">Seconds in which they act.</param>
    public static void Measure(Batch<V> batch, double[] impulses, double duration)
    {
        double[] a = batch.Bodies;
        int w = Lane<V>.Width;
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> half = Lane<V>.Splat(0.5 / duration);
        Island shape = batch.Shape;
        for (int body = 0; body < shape.MovingBodies; body++)
        {
            zero.Store(a, Batch<V>.Body(body, BodySlot.Stiffness));
        }

        for (int n = 0; n < shape.Nodes.Length; n++)
        {
            Node node = shape.Nodes[n];
            if (node.LinearMask != 7)
            {
                continue;
            }

            LaneVector<V> impulse = LaneVector<V>.Load(impulses, shape.Pattern.Rows[n] * w);
            for (int side = 0; side < 2; side++)
            {
                int body = node.Bodies[side];
                if (body >= shape.MovingBodies)
                {
                    continue;
                }

                LaneVector<V> lever = LaneVector<V>.Load(batch.Joints, Batch<V>.Joint(n, side == 0 ? Batch<V>.Lever0 : Batch<V>.Lever1));
                int inverse = Batch<V>.Body(body, BodySlot.WorldInverse);
                Lane<V> trace = Lane<V>.Load(a, inverse) + Lane<V>.Load(a, inverse + w) + Lane<V>.Load(a, inverse + 2 * w);
                Lane<V> pull = LaneVector<V>.Dot(impulse, lever) * trace
                    - LaneVector<V>.Dot(lever, ResponseMatrix<V>.Turn(a, inverse, impulse));
                pull = side == 0 ? pull : zero - pull;
                int o = Batch<V>.Body(body, BodySlot.Stiffness);
                (Lane<V>.Load(a, o) + half * Lane<V>.Max(pull, zero)).Store(a, o);
            }
        }
    }
}
