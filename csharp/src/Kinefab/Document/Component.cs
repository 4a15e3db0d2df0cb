namespace Kinefab.Document;

/// <summary>A Unity component of a <see cref="GameObject"/>.</summary>
public abstract record Component : DocumentObject
{
    private protected Component()
    {
    }
}
