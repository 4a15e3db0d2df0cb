using System;
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

    /// <summary>A finding of the shared table, with its severity and words.</summary>
    /// <param name="code">One of <see cref="DiagnosticCodes"/>.</param>
    /// <param name="place">JSON pointer (RFC 6901) of the place; empty: the file as a whole.</param>
    /// <param name="values">What the words leave open, by name.</param>
    /// <returns>Without line and column.</returns>
    /// <exception cref="ArgumentException">There is no such code.</exception>
    public static Diagnostic Of(string code, string place, params (string Name, string Value)[] values)
    {
        if (code is null || !DiagnosticTable.Entries.TryGetValue(code, out DiagnosticTable.Entry? entry))
            throw new ArgumentException($"There is no code {code}.", nameof(code));
        return new Diagnostic(code, entry.Severity, DiagnosticTable.Fill(entry.Message, values), DiagnosticTable.Fill(entry.Remedy, values), place, null, null);
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
