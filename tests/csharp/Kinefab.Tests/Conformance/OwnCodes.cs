using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using Kinefab.Diagnostics;

namespace Kinefab.Tests.Conformance;

/// <summary>The codes that this library states as constants.</summary>
internal static class OwnCodes
{
    internal static IReadOnlyList<string> All { get; } = typeof(DiagnosticCodes)
        .GetFields(BindingFlags.Public | BindingFlags.Static)
        .Select(field => (string)field.GetRawConstantValue()!)
        .ToArray();
}
