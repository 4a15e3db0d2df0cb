using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using System.Xml;
using Kinefab.Diagnostics;

namespace Kinefab.Cli;

/// <summary>A JUnit report, as CI servers read it: one test case a file, without times, so that the same outcome gives the same bytes.</summary>
internal static class JUnitFile
{
    internal static void Write(Stream target, string command, IReadOnlyList<(string File, SceneOutcome Outcome)> outcomes)
    {
        var settings = new XmlWriterSettings { Encoding = new UTF8Encoding(encoderShouldEmitUTF8Identifier: false), Indent = true, NewLineChars = "\n", CloseOutput = false };
        using XmlWriter xml = XmlWriter.Create(target, settings);
        xml.WriteStartElement("testsuites");
        xml.WriteStartElement("testsuite");
        xml.WriteAttributeString("name", "kinefab " + command);
        xml.WriteAttributeString("tests", outcomes.Count.ToString(CultureInfo.InvariantCulture));
        xml.WriteAttributeString("failures", outcomes.Count(one => one.Outcome.ExitCode != 0).ToString(CultureInfo.InvariantCulture));
        foreach ((string file, SceneOutcome outcome) in outcomes)
            Write(xml, command, file, outcome);
        xml.WriteEndElement();
        xml.WriteEndElement();
    }

    private static void Write(XmlWriter xml, string command, string file, SceneOutcome outcome)
    {
        xml.WriteStartElement("testcase");
        xml.WriteAttributeString("classname", "kinefab." + command);
        xml.WriteAttributeString("name", Text(file));
        List<string> errors = [.. outcome.Report.Diagnostics.Where(d => d.Severity == Severity.Error).Select(d => d.ToString())];
        if (outcome.Fault is string fault)
            errors.Add(fault);
        if (outcome.ExitCode != 0)
        {
            xml.WriteStartElement("failure");
            xml.WriteAttributeString("message", Text(errors.Count > 0 ? errors[0] : $"exit {outcome.ExitCode}"));
            xml.WriteString(string.Join('\n', errors.Select(Text)));
            xml.WriteEndElement();
        }

        string[] others = [.. outcome.Report.Diagnostics.Where(d => d.Severity != Severity.Error).Select(d => Text(d.ToString()))];
        if (others.Length > 0)
            xml.WriteElementString("system-out", string.Join('\n', others));
        xml.WriteEndElement();
    }

    // XML has no control characters, and no halves of pairs.
    private static string Text(string text)
    {
        string printable = Printable.Text(text);
        return printable.Any(char.IsSurrogate) ? Encoding.UTF8.GetString(Encoding.UTF8.GetBytes(printable)) : printable;
    }
}
