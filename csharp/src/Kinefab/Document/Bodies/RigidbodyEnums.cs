using System;

namespace Kinefab.Document;

/// <summary>Which motions of a Rigidbody are frozen; values are Unity's.</summary>
[Flags]
[Words]
public enum RigidbodyConstraints
{
    /// <summary>None.</summary>
    None = 0,

    /// <summary>No motion along world X.</summary>
    FreezePositionX = 2,

    /// <summary>No motion along world Y.</summary>
    FreezePositionY = 4,

    /// <summary>No motion along world Z.</summary>
    FreezePositionZ = 8,

    /// <summary>No rotation about X.</summary>
    FreezeRotationX = 16,

    /// <summary>No rotation about Y.</summary>
    FreezeRotationY = 32,

    /// <summary>No rotation about Z.</summary>
    FreezeRotationZ = 64,
}

/// <summary>How Unity smooths what is seen between physics steps; no influence on the simulation.</summary>
[Words]
public enum RigidbodyInterpolation
{
    /// <summary>Not at all.</summary>
    None,

    /// <summary>Between the last two steps.</summary>
    Interpolate,

    /// <summary>Ahead of the last step.</summary>
    Extrapolate,
}

/// <summary>How fast bodies are kept from passing through each other.</summary>
[Words]
public enum CollisionDetectionMode
{
    /// <summary>At the steps only.</summary>
    Discrete,

    /// <summary>Swept against static colliders.</summary>
    Continuous,

    /// <summary>Swept against static and continuous bodies.</summary>
    ContinuousDynamic,

    /// <summary>By speculative contacts.</summary>
    ContinuousSpeculative,
}
