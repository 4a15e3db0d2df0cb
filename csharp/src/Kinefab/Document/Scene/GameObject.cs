using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>A node of the hierarchy.</summary>
public sealed record GameObject : DocumentObject
{
    internal static readonly FieldNames Fields = new(
        ["id", "name"],
        "parent", "active", "transform", "components", "extras");

    private Component[] components = Array.Empty<Component>();

    /// <summary>Unity's defaults.</summary>
    public GameObject()
    {
    }

    internal GameObject(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "id":
                    Id = json.Text();
                    break;
                case "name":
                    Name = json.Text();
                    break;
                case "parent":
                    Parent = json.Int();
                    break;
                case "active":
                    Active = json.Boolean();
                    break;
                case "transform":
                    Transform = new Transform(ref json);
                    break;
                case "components":
                    SetComponents(json.List(ComponentReader.Read));
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

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
    public IReadOnlyList<Component> Components
    {
        get => components;
        init => SetComponents(value.ToArray());
    }

    /// <summary>The same, without the price of an interface.</summary>
    internal ReadOnlySpan<Component> ComponentSpan => components;

    /// <summary>The first Rigidbody among the components, or the first ArticulationBody as one; a valid scene has no second one.</summary>
    internal Rigidbody? Body { get; private set; }

    /// <summary>The first ArticulationBody among the components; a valid scene has no second one.</summary>
    internal ArticulationBody? Link { get; private set; }

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
