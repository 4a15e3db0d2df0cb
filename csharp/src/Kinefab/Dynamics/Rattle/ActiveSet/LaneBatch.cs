using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Up to Width islands of one shape, side by side: their numbers, and the active set that decides about their scalar rows.</summary>
internal sealed class LaneBatch<V> : LaneRecords<V>
    where V : struct, ILane<V>
{
    /// <param name="shape">What all its islands look like.</param>
    /// <param name="workspace">Arrays that hold nothing from step to step, shared by the batches of a shape.</param>
    public LaneBatch(Island shape, Workspace<V> workspace)
        : base(shape, workspace)
    {
        AngularShare = shape.Loops switch
        {
            LoopConsistency.Inconsistent => DelassusMatrix<V>.InconsistentShare,
            LoopConsistency.Rounded => DelassusMatrix<V>.RoundedShare,
            _ => DelassusMatrix<V>.AngularShare,
        };
        Axes = AxisRows<V>.Of(this);
        if (Scalars != null)
        {
            ActiveSet = new ActiveSet<V>(this, Scalars);
        }
    }

    /// <summary>Decides which scalar rows act; null without any.</summary>
    public ActiveSet<V>? ActiveSet { get; }

    /// <summary>The rows of drives and limits about hinges' axes; null without any.</summary>
    public AxisRows<V>? Axes { get; }

    /// <summary>Share added to the diagonal of angular rows in RATTLE steps.</summary>
    public double AngularShare { get; }
}
