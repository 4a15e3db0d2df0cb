namespace Kinefab.Document;

/// <summary>What the source states of one coordinate. No joint of Unity's has a field for it, and neither solver follows it.</summary>
[Since(1)]
public sealed partial record StatedAxis : DocumentObject
{
    /// <summary>Nothing stated.</summary>
    public static StatedAxis Default { get; } = new();

    /// <summary>Largest force of whatever drives it, N or N m; infinite: not stated.</summary>
    public double Effort { get; init; } = double.PositiveInfinity;

    /// <summary>Largest rate, m/s or degrees/s; infinite: not stated.</summary>
    public double Speed { get; init; } = double.PositiveInfinity;

    /// <summary>Largest dry friction, N or N m.</summary>
    public double Friction { get; init; }

    /// <summary>Inertia that moves with it, kg or kg m^2.</summary>
    public double Armature { get; init; }

    private protected override string Describe() => Line($"effort {Effort}, speed {Speed}, friction {Friction}, armature {Armature}");
}
