using System.Collections.Generic;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Patterns of islands that were found before, for those that are found anew. Where one joint's rows have changed, or a mass, most islands are as they
/// were, and a wide grid's pattern takes longer to find than many of its steps.
/// </summary>
internal sealed class KnownPatterns
{
    // By the first body: an island that is the same has the same, and few others have it.
    private readonly Dictionary<int, List<Island>> _islands = new();

    /// <summary>Has its pattern for others, if it has been found.</summary>
    public void Add(Island island)
    {
        if (!island.IsOrdered)
        {
            return;
        }

        if (!_islands.TryGetValue(island.Bodies[0], out List<Island>? known))
        {
            _islands.Add(island.Bodies[0], known = new List<Island>());
        }

        known.Add(island);
    }

    /// <summary>Gives an island its pattern, if it is known.</summary>
    public void GiveTo(Island island)
    {
        if (_islands.TryGetValue(island.Bodies[0], out List<Island>? known))
        {
            known.ForEach(island.TakePattern);
        }
    }
}
