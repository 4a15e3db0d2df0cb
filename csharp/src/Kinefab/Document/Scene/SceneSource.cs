namespace Kinefab.Document;

/// <summary>Where the scene came from.</summary>
public sealed partial record SceneSource : DocumentObject
{
    /// <summary>Source file, relative, as given.</summary>
    public string? Uri { get; init; }

    /// <summary>Up axis of the source.</summary>
    public Axis? UpAxis { get; init; }

    /// <summary>Metres in one length unit of the source.</summary>
    public double? MetersPerUnit { get; init; }

    /// <summary>SHA-256 of the source file's bytes, lower-case hexadecimal.</summary>
    public string? Sha256 { get; init; }

    /// <summary>Which of several states of the source it was, as the source names them: variants, configuration, keyframe; null for the only or usual one.</summary>
    [Since(1)]
    public string? Configuration { get; init; }
}
