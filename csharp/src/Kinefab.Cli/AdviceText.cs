using System.Globalization;
using System.IO;
using System.Linq;
using Kinefab.Advice;
using Kinefab.Diagnostics;

namespace Kinefab.Cli;

/// <summary>Stability advice as people read it.</summary>
internal static class AdviceText
{
    /// <summary>What the words before a change mean, and its figure: a small one is a good one.</summary>
    internal const string Legend = "do: the best of the changes that were tried; tried: the others. The figure before a change is what is left once it is made, not what it gains.";

    internal static void Write(string file, AdviceReport advice, TextWriter target)
    {
        int warnings = advice.Report.Count(Severity.Warning);
        Line(target, $"{file}: {Counted.Of(advice.Steps, "step", "steps")} of {advice.Step.ToString(CultureInfo.InvariantCulture)} s in Unity's solver and the exact one; {Counted.Of(warnings, "warning", "warnings")}, {Counted.Of(advice.Trials, "change", "changes")} tried");
        foreach (AdviceFinding finding in advice.Findings)
            Write(finding, target);
        foreach (Diagnostic remark in advice.Report.Diagnostics.Skip(advice.Findings.Count))
            Line(target, $"{remark.Severity.ToJson()} {remark.Code}: {remark.Message} {remark.Remedy}");
        if (advice.Findings.Any(finding => finding.Tried.Count > 0))
            Line(target, Legend);
    }

    private static void Write(AdviceFinding finding, TextWriter target)
    {
        Diagnostic found = finding.Diagnostic;
        Line(target, $"{found.Severity.ToJson()} {found.Code}: {found.Message}");
        int width = finding.Tried.Select(t => t.After.ToString().Length).DefaultIfEmpty(0).Max();
        if (finding.Best is not null)
            Write("do", finding.Best, width, target);
        else if (found.Severity == Severity.Warning)
            Line(target, $"  {found.Remedy}");
        foreach (TriedChange tried in finding.Tried.Where(t => t != finding.Best))
            Write("tried", tried, width, target);
    }

    private static void Write(string word, TriedChange tried, int width, TextWriter target)
    {
        string work = tried.Work == 1 ? "" : $" ({tried.Work.ToString("0.##", CultureInfo.InvariantCulture)} times the work)";
        Line(target, $"  {word,-6} {tried.After.ToString().PadRight(width)}  {tried.Change}{work}");
    }

    private static void Line(TextWriter target, string text) => target.WriteLine(Printable.Text(text));
}
