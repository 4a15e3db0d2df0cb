using System.Diagnostics;
using System.Globalization;

namespace Kinefab.Diagnostics;

/// <summary>One finding about the data.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class Diagnostic
{
    internal Diagnostic(string code, Severity severity, string message, string remedy, string pointer, int? line, int? column)
    {
        Code = code;
        Severity = severity;
        Message = message;
        Remedy = remedy;
        Pointer = pointer;
        Line = line;
        Column = column;
    }

    /// <summary>A code of the shared table, one of <see cref="DiagnosticCodes"/>.</summary>
    public string Code { get; }

    /// <summary>How grave it is.</summary>
    public Severity Severity { get; }

    /// <summary>JSON pointer (RFC 6901) of the place; empty: the file as a whole.</summary>
#pragma warning disable CA1720 // JSON pointer is RFC 6901's term.
    public string Pointer { get; }
#pragma warning restore CA1720

    /// <summary>Line of the place, from 1; null where the scene did not come from a text.</summary>
    public int? Line { get; }

    /// <summary>Column of the place in UTF-16 code units, from 1, as editors count; null where the scene did not come from a text.</summary>
    public int? Column { get; }

    /// <summary>What is wrong.</summary>
    public string Message { get; }

    /// <summary>What to do about it.</summary>
    public string Remedy { get; }

    /// <summary>"line:column: severity CODE pointer: message remedy".</summary>
    public override string ToString()
    {
        string place = Line is null ? "" : string.Format(CultureInfo.InvariantCulture, "{0}:{1}: ", Line, Column);
        string pointer = Pointer.Length == 0 ? "" : " " + Pointer;
        return $"{place}{Severity.ToJson()} {Code}{pointer}: {Message} {Remedy}";
    }
}
