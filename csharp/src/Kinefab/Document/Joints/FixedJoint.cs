namespace Kinefab.Document;

/// <summary>FixedJoint: holds the relative pose that the bodies have at start-up; removes six freedoms.</summary>
public sealed partial record FixedJoint : Joint
{
    private protected override string Describe() => $"FixedJoint {Ends}";
}
