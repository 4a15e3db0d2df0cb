namespace Kinefab.Document;

/// <summary>How two touching colliders' numbers become one; values are Unity's.</summary>
[Words]
public enum PhysicsMaterialCombine
{
    /// <summary>Half of the sum.</summary>
    Average,

    /// <summary>The product.</summary>
    Multiply,

    /// <summary>The smaller.</summary>
    Minimum,

    /// <summary>The larger.</summary>
    Maximum,
}

/// <summary>PhysicsMaterial (PhysicMaterial before Unity 6) of colliders; no influence here, where nothing touches.</summary>
[Since(1)]
public sealed partial record PhysicsMaterial : DocumentObject
{
    /// <summary>Its name.</summary>
    [Field(Required = true)]
    public string Name { get; init; } = "";

    /// <summary>Coefficient of friction while it slides, a ratio of 0 or more.</summary>
    public double DynamicFriction { get; init; } = 0.6;

    /// <summary>Coefficient of friction while it sticks, a ratio of 0 or more.</summary>
    public double StaticFriction { get; init; } = 0.6;

    /// <summary>Share of the speed kept at a contact, 0 to 1.</summary>
    public double Bounciness { get; init; }

    /// <summary>How its friction meets another's.</summary>
    public PhysicsMaterialCombine FrictionCombine { get; init; }

    /// <summary>How its bounciness meets another's.</summary>
    public PhysicsMaterialCombine BounceCombine { get; init; }

    private protected override string Describe() => Line($"physics material \"{Name}\", friction {DynamicFriction} and {StaticFriction}, bounciness {Bounciness}");
}
