using System;
using System.Collections.Generic;

namespace Kinefab.Document;

/// <summary>MeshRenderer: with which materials a GameObject's mesh is drawn.</summary>
public sealed partial record MeshRenderer : Component
{
    /// <summary>Renderer.enabled.</summary>
    public bool Enabled { get; init; } = true;

    /// <summary>Indices into <see cref="SceneDocument.Materials"/>, one for each submesh.</summary>
    [Field(Required = true)]
    public IReadOnlyList<int> Materials { get; init; } = Array.Empty<int>();

    private protected override string Describe() => $"MeshRenderer with materials {string.Join(", ", Materials)}";
}
