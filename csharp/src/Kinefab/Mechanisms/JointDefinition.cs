namespace Kinefab.Mechanisms;

/// <summary>A joint component and the bodies at its two ends.</summary>
internal readonly struct JointDefinition
{
    public readonly int GameObject;
    public readonly int Component;
    public readonly Document.Joint Source;

    /// <summary>The body that carries the component.</summary>
    public readonly int Own;

    /// <summary>The connected body, or JointModel.World.</summary>
    public readonly int Connected;

    /// <summary>The link whose joint it is; null: it is a component by itself.</summary>
    public readonly Document.ArticulationBody? Link;

    public JointDefinition(int gameObject, int component, Document.Joint source, int own, int connected, Document.ArticulationBody? link = null)
    {
        GameObject = gameObject;
        Component = component;
        Source = source;
        Own = own;
        Connected = connected;
        Link = link;
    }
}
