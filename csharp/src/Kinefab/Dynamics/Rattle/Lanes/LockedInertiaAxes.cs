using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Bodies with an infinite moment of inertia. What joints press against such an axis goes nowhere: kept in the angular
/// momentum, it would spill into the axes that do turn as soon as the body turns, and make a gyroscope of it.
/// </summary>
internal static class LockedInertiaAxes<V>
    where V : struct, ILane<V>
{
    /// <summary>Takes what lies along such axes, as they stand at the start of the step, out of the angular momenta.</summary>
    public static void ClearMomentum(LaneRecords<V> batch)
    {
        foreach (int body in batch.Shape.LockedInertiaBodies)
        {
            ClearMomentum(batch.Bodies, LaneRecords<V>.Body(body, 0));
        }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void ClearMomentum(double[] a, int o)
    {
        LaneQuaternion<V> q = LaneQuaternion<V>.Load(a, o, BodyLanes.Q);
        LaneVector<V> inBody = q.InverseRotate(LaneVector<V>.Load(a, o, BodyLanes.L));

        // 1 for an axis that turns, 0 for one that does not.
        LaneVector<V> turns = LaneVector<V>.Scale(
            LaneVector<V>.Load(a, o, BodyLanes.Inertia), LaneVector<V>.Load(a, o, BodyLanes.InverseInertia));
        q.Rotate(LaneVector<V>.Scale(turns, inBody)).Store(a, o, BodyLanes.L);
    }
}
