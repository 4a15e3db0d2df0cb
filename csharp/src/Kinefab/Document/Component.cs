namespace Kinefab.Document;

/// <summary>A Unity component of a <see cref="GameObject"/>.</summary>
public abstract class Component : DocumentObject
{
    private protected Component()
    {
    }
}
