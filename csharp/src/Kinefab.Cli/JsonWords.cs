using System;

namespace Kinefab.Cli;

/// <summary>Enumerations as the scene file writes those whose words start in lower case.</summary>
internal static class JsonWords
{
    internal static string ToJson(this Enum value)
    {
        string name = value.ToString();
        return char.ToLowerInvariant(name[0]) + name.Substring(1);
    }
}
