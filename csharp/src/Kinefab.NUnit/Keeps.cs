namespace Kinefab.NUnit;

/// <summary>What is kept while a mechanism moves by itself.</summary>
public static class Keeps
{
    /// <summary>Kinetic and potential energy together: <c>Keeps.Energy.Within(0.1).Percent.For(seconds: 10)</c>.</summary>
    public static EnergyConstraint Energy => new();
}
