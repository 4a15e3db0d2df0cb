namespace Kinefab.Document;

/// <summary>What a GameObject is there for, where it is no part of the source.</summary>
[Words(Letters.Camel)]
public enum GameObjectRole
{
    /// <summary>Stands for the ground: what the source fixes hangs on it. A scene without one is fixed to the world.</summary>
    Ground,

    /// <summary>A named frame of the GameObject above it: a tool's tip, a sensor, a camera.</summary>
    Site,
}
