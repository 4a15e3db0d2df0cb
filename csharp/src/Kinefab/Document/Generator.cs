namespace Kinefab.Document;

/// <summary>The program that wrote the file.</summary>
public sealed class Generator : DocumentObject
{
    /// <summary>Its name.</summary>
    public string Name { get; init; } = "";

    /// <summary>Its version.</summary>
    public string Version { get; init; } = "";
}
