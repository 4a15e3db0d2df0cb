using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>Rows that come from a joint's or coupling's own Prepare; only for islands that are solved one at a time.</summary>
internal static class PreparedRows<V>
    where V : struct, ILane<V>
{
    public static void Evaluate(Batch<V> batch, int node)
    {
        _ = (batch, node);
    }

    public static void Build(Batch<V> batch, int node)
    {
        _ = (batch, node);
    }
}
