namespace Kinefab.Dynamics.Rattle;

/// <summary>An island that is stepped in lanes: as it is there, and with all of its rows for the steps that it makes alone.</summary>
internal sealed class LaneIsland
{
    public LaneIsland(Island inLanes, Island alone)
    {
        InLanes = inLanes;
        Alone = alone;
    }

    public Island InLanes { get; }

    public Island Alone { get; }

    /// <summary>Whether both can share lanes.</summary>
    public bool HasShapeOf(LaneIsland other) => InLanes.HasShapeOf(other.InLanes) && (InLanes == Alone || Alone.HasShapeOf(other.Alone));
}
