using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Runs;

namespace Kinefab.Advice.Changes;

/// <summary>
/// A change of a scene, made in all its islands at once: since they do not feel each other, one run shows what it does to each.
/// </summary>
internal sealed class Change
{
    private const int MostNamed = 2;

    public Change(string kind, IEnumerable<ChangePart> parts, bool altersMotion = false)
    {
        Kind = kind;
        AltersMotion = altersMotion;
        Parts = parts.ToArray();
    }

    /// <summary>Tells changes apart.</summary>
    public string Kind { get; }

    public IReadOnlyList<ChangePart> Parts { get; }

    /// <summary>Whether the mechanism is meant to move otherwise with it, so that its motion before is no measure.</summary>
    public bool AltersMotion { get; }

    /// <summary>Both at once.</summary>
    public static Change Both(Change a, Change b) => new(a.Kind + " + " + b.Kind, a.Parts.Concat(b.Parts), a.AltersMotion || b.AltersMotion);

    /// <summary>What of it an island has to do with.</summary>
    public IReadOnlyList<ChangePart> In(RunIsland island) =>
        Parts.Where(p => p.GameObject is not int gameObject || island.Holds(gameObject)).ToArray();

    /// <summary>Parts in words.</summary>
    public static string Words(IReadOnlyList<ChangePart> parts)
    {
        // Parts of a kind stand together; of each kind two are named.
        IEnumerable<string> groups = parts.GroupBy(p => p.What).Select(group =>
        {
            string[] places = group.Select(p => p.Place).Where(place => place.Length > 0).ToArray();
            string more = places.Length > MostNamed ? $" and {places.Length - MostNamed} more" : "";
            return places.Length == 0 ? group.Key : $"{group.Key} on {string.Join(", ", places.Take(MostNamed))}{more}";
        });
        return string.Join("; ", groups);
    }
}

/// <summary>A change of one component or of the project's settings.</summary>
internal sealed class ChangePart
{
    public ChangePart(int? gameObject, string what, string place, params SceneEdit[] edits)
    {
        GameObject = gameObject;
        What = what;
        Place = place;
        Edits = edits;
    }

    /// <summary>The object changed; null: the project.</summary>
    public int? GameObject { get; }

    /// <summary>What to do, as Unity's windows and scripts name it.</summary>
    public string What { get; }

    /// <summary>Where; empty for the project.</summary>
    public string Place { get; }

    public IReadOnlyList<SceneEdit> Edits { get; }
}
