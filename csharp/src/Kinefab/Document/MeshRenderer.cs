using System;
using System.Collections.Generic;

namespace Kinefab.Document;

/// <summary>MeshRenderer: with which materials a GameObject's mesh is drawn.</summary>
public sealed class MeshRenderer : Component
{
    /// <summary>Renderer.enabled.</summary>
    public bool Enabled { get; init; } = true;

    /// <summary>Indices into <see cref="SceneDocument.Materials"/>, one for each submesh.</summary>
    public IReadOnlyList<int> Materials { get; init; } = Array.Empty<int>();
}
