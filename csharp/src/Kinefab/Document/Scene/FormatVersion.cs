using System;
using System.Globalization;
using Kinefab.Diagnostics;
using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Which files this library reads: format kinefab.scene, version 1.x, unknown fields of a newer x left aside.</summary>
internal static class FormatVersion
{
    internal const string Format = "kinefab.scene";
    internal const int Major = 1;
    internal const int Minor = 1;

    /// <summary>Another format ends the reading: nothing else in the file can be trusted to mean what it says.</summary>
    internal static string ReadFormat(ref JsonCursor json)
    {
        string format = json.Text();
        if (format != Format)
            json.ReportAlone(DiagnosticCodes.FormatUnknown, ("format", format));
        return format;
    }

    /// <summary>Another major version ends the reading, a newer minor one is a warning.</summary>
    internal static string ReadVersion(ref JsonCursor json)
    {
        string version = json.Text();
        string[] parts = version.Split('.');
        if (parts.Length != 2 || !TryNumber(parts[0], out int major) || !TryNumber(parts[1], out int minor))
            json.Report(DiagnosticCodes.VersionInvalid, ("version", version));
        else if (major != Major)
            json.ReportAlone(DiagnosticCodes.VersionUnsupported, ("version", version));
        else if (minor > Minor)
            json.Report(DiagnosticCodes.VersionNewer, ("version", version));
        return version;
    }

    /// <summary>The version that a file states: the scene's own or the least that what is in it needs, and none newer than this library writes.</summary>
    internal static string AtLeast(string stated, int minor)
    {
        string[] parts = stated.Split('.');
        int own = parts.Length == 2 && TryNumber(parts[1], out int known) ? Math.Min(known, Minor) : 0;
        return $"{Invariant.Text(Major)}.{Invariant.Text(Math.Max(own, minor))}";
    }

    private static bool TryNumber(string text, out int number) =>
        int.TryParse(text, NumberStyles.None, CultureInfo.InvariantCulture, out number) && (text.Length == 1 || text[0] != '0');
}
