namespace Kinefab.Document;

/// <summary>The program that wrote the file.</summary>
public sealed partial record Generator : DocumentObject
{
    /// <summary>Its name.</summary>
    [Field(Required = true)]
    public string Name { get; init; } = "";

    /// <summary>Its version.</summary>
    [Field(Required = true)]
    public string Version { get; init; } = "";

    private protected override string Describe() => $"{Name} {Version}";
}
