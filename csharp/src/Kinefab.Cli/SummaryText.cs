using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Cli;

/// <summary>A summary as people read it.</summary>
internal static class SummaryText
{
    internal static void Write(SceneSummary summary, TextWriter target)
    {
        SceneDocument document = summary.Document;
        Line(target, $"objects    {document.GameObjects.Count}, bodies {summary.Bodies}, colliders {summary.Colliders}");
        Line(target, $"meshes     {document.Meshes.Count}, vertices {summary.Vertices}, triangles {summary.Triangles}");
        Line(target, $"joints     {summary.Joints.Count}");
        foreach (JointSummary joint in summary.Joints)
            Entry(target, Describe(joint, summary));
        Line(target, $"couplings  {document.Couplings.Count}");
        foreach (Coupling coupling in document.Couplings)
            Entry(target, Describe(coupling, summary));
        if (document.Analysis is Analysis analysis)
            WriteAnalysis(analysis, target);
        Line(target, $"source     {summary.Count(Outcome.Kept)} kept, {summary.Count(Outcome.Approximated)} approximated, {summary.Count(Outcome.Dropped)} dropped");
        foreach (IGrouping<(Outcome, string?, string?), ReportEntry> alike in document.Report.Where(entry => entry.Outcome != Outcome.Kept).GroupBy(entry => (entry.Outcome, entry.Code, entry.Message)))
            WriteLosses([.. alike], target);
    }

    private static void WriteAnalysis(Analysis analysis, TextWriter target)
    {
        string redundant = analysis.Redundant is int rows ? FormattableString.Invariant($", {rows} redundant {(rows == 1 ? "row" : "rows")}") : "";
        Line(target, $"mobility   {analysis.Mobility} in {Counted.Of(analysis.Islands.Count, "island", "islands")}{redundant}");
    }

    private static string Describe(JointSummary joint, SceneSummary summary)
    {
        string other = joint.Joint.ConnectedBody is int body ? summary.Document.GameObjects[body].Id : "world";
        string freedoms = joint.Freedoms.Count == 0 ? "nothing free" : string.Join(", ", joint.Freedoms.Select(Describe));
        string closure = joint.Joint.Closure ? ", closes a loop" : "";
        string exact = joint.Joint.Exact ? "" : ", approximated";
        string off = joint.Joint.Enabled ? "" : ", switched off";
        return $"{joint.Type} {summary.NameOf(joint.GameObject, joint.Component)} - {other}: {freedoms}{closure}{exact}{off}";
    }

    private static string Describe(JointFreedom freedom)
    {
        string name = freedom.Coordinate.ToJson();
        if (!freedom.IsLimited)
            return name + " free";
        string unit = freedom.IsAngle ? "deg" : "m";
        return $"{name} {Number(freedom.Lower)}..{Number(freedom.Upper)} {unit}";
    }

    private static string Describe(Coupling coupling, SceneSummary summary)
    {
        string offset = coupling.Offset == 0 ? "" : " + " + Number(coupling.Offset);
        IEnumerable<string> terms = coupling.Followed.Select(term => $"{term.Ratio.ToString("G6", CultureInfo.InvariantCulture)} * {Describe(term.Coordinate, summary)}");
        return $"{coupling.Kind}: {Describe(coupling.B, summary)} = {string.Join(" + ", terms)}{offset}";
    }

    private static string Describe(JointCoordinate coordinate, SceneSummary summary) =>
        $"{summary.NameOf(coordinate.GameObject, coordinate.Component)}.{coordinate.Coordinate.ToJson()}";

    // Features lost for one reason: the reason once, and each of them below it.
    private static void WriteLosses(IReadOnlyList<ReportEntry> alike, TextWriter target)
    {
        ReportEntry first = alike[0];
        bool isOne = alike.Count == 1;
        string code = first.Code is null ? "" : " " + first.Code;
        string message = first.Message is null ? "" : ": " + first.Message;
        Entry(target, $"{first.Outcome.ToJson()} {(isOne ? first.Feature : Counted.Of(alike.Count, "feature", "features"))}{code}{message}{(isOne ? Place(first) : "")}");
        foreach (ReportEntry entry in isOne ? [] : alike)
            Entry(target, $"  {entry.Feature}{Place(entry)}");
    }

    private static string Place(ReportEntry entry) => entry.Source is null ? "" : $" ({entry.Source})";

    private static string Number(double value) => value.ToString("0.######", CultureInfo.InvariantCulture);

    private static void Entry(TextWriter target, string text) => target.WriteLine("  " + Printable.Text(text));

    private static void Line(TextWriter target, FormattableString text) => target.WriteLine(text.ToString(CultureInfo.InvariantCulture));
}
