namespace Kinefab.Document;

/// <summary>Anything written as a JSON object in a scene file.  Immutable once made.</summary>
public abstract class DocumentObject
{
    private protected DocumentObject()
    {
    }

    /// <summary>The object's <c>extras</c> as raw JSON text, kept as it stood and never interpreted; null when there are none.</summary>
    public string? ExtrasJson { get; init; }
}
