using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Json;

namespace Kinefab.Mechanisms;

/// <summary>Ids that no object of a scene has yet: what is wished for, else with the least number from 2 that is free.</summary>
internal sealed class FreeIds
{
    private readonly HashSet<string> taken = new(StringComparer.Ordinal);

    // The number to try next, of each id that was wished for; all below it are taken. Thousands of joints without an id may wish for that of their one body.
    private readonly Dictionary<string, int> next = new(StringComparer.Ordinal);

    internal FreeIds(IReadOnlyList<GameObject> objects)
    {
        foreach (GameObject gameObject in objects)
            taken.Add(gameObject.Id);
    }

    /// <summary>It is taken from now on.</summary>
    internal string Take(string wished)
    {
        string free = wished;
        int count = next.TryGetValue(wished, out int number) ? number : 2;
        while (!taken.Add(free))
            free = $"{wished}#{Invariant.Text(count++)}";
        next[wished] = count;
        return free;
    }
}
