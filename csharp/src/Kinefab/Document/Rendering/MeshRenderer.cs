using System;
using System.Collections.Generic;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>MeshRenderer: with which materials a GameObject's mesh is drawn.</summary>
public sealed record MeshRenderer : Component
{
    internal static readonly FieldNames Fields = new(["type", "materials"], "enabled", "extras");

    /// <summary>Unity's defaults.</summary>
    public MeshRenderer()
    {
    }

    internal MeshRenderer(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "enabled":
                    Enabled = json.Boolean();
                    break;
                case "materials":
                    Materials = json.List(static (ref JsonCursor at) => at.Int());
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Renderer.enabled.</summary>
    public bool Enabled { get; init; } = true;

    /// <summary>Indices into <see cref="SceneDocument.Materials"/>, one for each submesh.</summary>
    public IReadOnlyList<int> Materials { get; init; } = Array.Empty<int>();

    private protected override string Describe() => $"MeshRenderer with materials {string.Join(", ", Materials)}";
}
