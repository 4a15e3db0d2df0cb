using System;
using System.Collections.Generic;

namespace Kinefab.Document;

/// <summary>A node of the hierarchy.</summary>
public sealed class GameObject : DocumentObject
{
    /// <summary>Unique and stable: made from the source's own path.</summary>
    public string Id { get; init; } = "";

    /// <summary>GameObject.name.</summary>
    public string Name { get; init; } = "";

    /// <summary>Index of an EARLIER GameObject; null for a root.</summary>
    public int? Parent { get; init; }

    /// <summary>GameObject.activeSelf.</summary>
    public bool Active { get; init; } = true;

    /// <summary>Local to the parent.</summary>
    public Transform Transform { get; init; } = Transform.Default;

    /// <summary>In order; couplings refer to joints by their place here.</summary>
    public IReadOnlyList<Component> Components { get; init; } = Array.Empty<Component>();
}
