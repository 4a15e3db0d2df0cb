using System;
using System.Collections.Generic;
using System.Linq;

namespace Kinefab.Document;

/// <summary>A node of the hierarchy.</summary>
public sealed partial record GameObject : DocumentObject
{
    private Component[] components = Array.Empty<Component>();

    /// <summary>Unique and stable: made from the source's own path.</summary>
    [Field(Required = true)]
    public string Id { get; init; } = "";

    /// <summary>GameObject.name.</summary>
    [Field(Required = true, Shared = true)]
    public string Name { get; init; } = "";

    /// <summary>Index of an EARLIER GameObject; null for a root.</summary>
    public int? Parent { get; init; }

    /// <summary>GameObject.activeSelf.</summary>
    public bool Active { get; init; } = true;

    /// <summary>Local to the parent.</summary>
    public Transform Transform { get; init; } = Transform.Default;

    /// <summary>In order; couplings refer to joints by their place here.</summary>
    [Field(Into = nameof(ReadComponents))]
    public IReadOnlyList<Component> Components
    {
        get => components;
        init => SetComponents(value.ToArray());
    }

    /// <summary>The source's word for its layer; Unity's layers are the project's. Null for none.</summary>
    [Since(1)]
    [Field(Shared = true)]
    public string? Layer { get; init; }

    /// <summary>The source's word for its tag; null for none.</summary>
    [Since(1)]
    [Field(Shared = true)]
    public string? Tag { get; init; }

    /// <summary>Of the part, shared by all its occurrences; null when it is not told.</summary>
    [Since(1)]
    [Field(Shared = true)]
    public string? Definition { get; init; }

    /// <summary>What it is there for, where it is no part of the source; null for all others.</summary>
    [Since(1)]
    public GameObjectRole? Role { get; init; }

    /// <summary>The same, without the price of an interface.</summary>
    internal ReadOnlySpan<Component> ComponentSpan => components;

    /// <summary>The first Rigidbody among the components, or the first ArticulationBody as one; a valid scene has no second one.</summary>
    internal Rigidbody? Body { get; private set; }

    /// <summary>The first ArticulationBody among the components; a valid scene has no second one.</summary>
    internal ArticulationBody? Link { get; private set; }

    // Without a copy: nobody else has what was read.
    private Component[] ReadComponents
    {
        init => SetComponents(value);
    }

    private void SetComponents(Component[] value)
    {
        components = value;
        Body = null;
        Link = null;
        foreach (Component component in value)
        {
            Body ??= component as Rigidbody;
            Link ??= component as ArticulationBody;
        }

        Body ??= Link?.AsRigidbody;
    }

    private protected override string Describe() => $"\"{Id}\" ({string.Join(", ", components.Select(component => component.GetType().Name))}){(Active ? "" : ", inactive")}";
}
