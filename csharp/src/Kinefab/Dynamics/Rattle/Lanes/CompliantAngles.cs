using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Locked angles of an inexact island as springs, so that it moves as it does in Unity though its axes are off. The
/// impulse p of a step is that of the error at its end, C + h s A p = 0, with A the row's response and s its share
/// (<see cref="DelassusMatrix{V}.InconsistentShare"/>): implicit Euler for a spring of 1 / (h^2 s A), too stiff to ring. It acts
/// before the drift; the projection leaves the angles alone. With the share on the matrix's diagonal it is one more row
/// of the chord iteration.
/// </summary>
internal static class CompliantAngles<V>
    where V : struct, ILane<V>
{
    /// <summary>What the springs add to the errors at the end of the drift.</summary>
    public static void Evaluate(LaneRecords<V> batch)
    {
        int w = Lane<V>.Width;
        Lane<V> h = Lane<V>.Splat(batch.CompliantStep);
        bool[] isAngular = batch.Shape.IsAngular;
        for (int i = 0; i < isAngular.Length; i++)
        {
            if (isAngular[i])
            {
                Lane<V> held = h * Lane<V>.Load(batch.Compliance, i * w) * Lane<V>.Load(batch.Work.PositionImpulses, i * w);
                (Lane<V>.Load(batch.Work.Error, i * w) + held).Store(batch.Work.Error, i * w);
            }
        }
    }
}
