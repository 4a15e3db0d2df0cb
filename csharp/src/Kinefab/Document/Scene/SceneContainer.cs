namespace Kinefab.Document;

/// <summary>What a scene file is on the disk.</summary>
public enum SceneContainer
{
    /// <summary>JSON, and buffers as files beside it.</summary>
    Text,

    /// <summary>One file with the JSON and a buffer in it (<c>schemas/SPEC.md</c>, section 1).</summary>
    Binary,
}
