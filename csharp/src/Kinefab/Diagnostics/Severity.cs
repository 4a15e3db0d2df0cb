namespace Kinefab.Diagnostics;

/// <summary>How grave a finding is.</summary>
public enum Severity
{
    /// <summary>Worth knowing.</summary>
    Info,

    /// <summary>Loads, but probably does not do what was meant.</summary>
    Warning,

    /// <summary>Cannot be carried on.</summary>
    Error,
}
