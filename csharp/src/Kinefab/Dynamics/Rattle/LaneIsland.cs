using System;
using System.Collections.Generic;

namespace Kinefab.Dynamics.Rattle;

/// <summary>An island that is stepped in lanes: as it is there, and with all of its rows for the steps that it makes alone.</summary>
internal sealed class LaneIsland
{
    private LaneIsland(Island inLanes, Island? resting, Island alone)
    {
        InLanes = inLanes;
        Resting = resting;
        Alone = alone;
    }

    public Island InLanes { get; }

    /// <summary>As it is in lanes while hinges rest on their limits; null where that is <see cref="InLanes"/> too, or where no hinge has limits.</summary>
    public Island? Resting { get; }

    public Island Alone { get; }

    /// <summary>All of them, each once.</summary>
    public IEnumerable<Island> Forms
    {
        get
        {
            yield return Alone;
            if (InLanes != Alone)
            {
                yield return InLanes;
            }

            if (Resting != null)
            {
                yield return Resting;
            }
        }
    }

    /// <summary>The island's forms; null where it has rows that are not written in lanes.</summary>
    public static LaneIsland? Of(Island island)
    {
        Island? free = island.InLanes(false);
        Island? resting = free is null ? null : island.InLanes(true);
        if (free is null || resting is null)
        {
            return free is null ? null : new LaneIsland(free, null, island);
        }

        // Drives have their rows in every step: the limits' beside them cost no more than a row that is not there.
        bool isDriven = Array.Exists(free.Blocks, block => block.HasAxisRow);
        return isDriven || free.RowCount == resting.RowCount ? new LaneIsland(resting, null, island) : new LaneIsland(free, resting, island);
    }

    /// <summary>Whether both can share lanes.</summary>
    public bool HasShapeOf(LaneIsland other) => InLanes.HasShapeOf(other.InLanes) && (InLanes == Alone || Alone.HasShapeOf(other.Alone));
}
