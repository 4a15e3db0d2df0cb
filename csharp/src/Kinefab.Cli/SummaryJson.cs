using System.Linq;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Cli;

/// <summary>A summary as programs read it: the field "summary" of schemas/report.schema.json.</summary>
internal static class SummaryJson
{
    internal static void Write(SceneSummary summary, Utf8JsonWriter json)
    {
        SceneDocument document = summary.Document;
        json.WriteStartObject("summary");
        json.WriteNumber("gameObjects", document.GameObjects.Count);
        json.WriteNumber("bodies", summary.Bodies);
        json.WriteNumber("colliders", summary.Colliders);
        json.WriteNumber("meshes", document.Meshes.Count);
        json.WriteNumber("vertices", summary.Vertices);
        json.WriteNumber("triangles", summary.Triangles);
        json.WriteNumber("couplings", document.Couplings.Count);
        if (document.Analysis is Analysis analysis)
            json.WriteNumber("mobility", analysis.Mobility);
        json.WriteStartArray("joints");
        foreach (JointSummary joint in summary.Joints)
            Write(joint, document, json);
        json.WriteEndArray();
        WriteLosses(summary, json);
        json.WriteEndObject();
    }

    private static void Write(JointSummary summary, SceneDocument document, Utf8JsonWriter json)
    {
        json.WriteStartObject();
        json.WriteString("type", summary.Type);
        json.WriteString("gameObject", document.GameObjects[summary.GameObject].Id);
        json.WriteNumber("component", summary.Component);
        if (summary.Joint.ConnectedBody is int body)
            json.WriteString("connectedBody", document.GameObjects[body].Id);
        if (!summary.Joint.Enabled)
            json.WriteBoolean("enabled", false);
        json.WriteStartArray("freedoms");
        foreach (JointFreedom freedom in summary.Freedoms)
        {
            json.WriteStartObject();
            json.WriteString("coordinate", freedom.Coordinate.ToJson());
            json.WriteString("unit", freedom.IsAngle ? "deg" : "m");
            if (freedom.IsLimited)
            {
                json.WriteNumber("lower", freedom.Lower);
                json.WriteNumber("upper", freedom.Upper);
            }

            json.WriteEndObject();
        }

        json.WriteEndArray();
        json.WriteEndObject();
    }

    private static void WriteLosses(SceneSummary summary, Utf8JsonWriter json)
    {
        json.WriteStartObject("outcomes");
        json.WriteNumber("kept", summary.Count(Outcome.Kept));
        json.WriteNumber("approximated", summary.Count(Outcome.Approximated));
        json.WriteNumber("dropped", summary.Count(Outcome.Dropped));
        json.WriteEndObject();
        json.WriteStartArray("losses");
        foreach (ReportEntry entry in summary.Document.Report.Where(entry => entry.Outcome != Outcome.Kept))
        {
            json.WriteStartObject();
            json.WriteString("feature", entry.Feature);
            json.WriteString("outcome", entry.Outcome.ToJson());
            WriteOptional("code", entry.Code, json);
            WriteOptional("message", entry.Message, json);
            WriteOptional("source", entry.Source, json);
            json.WriteEndObject();
        }

        json.WriteEndArray();
    }

    private static void WriteOptional(string name, string? value, Utf8JsonWriter json)
    {
        if (value is not null)
            json.WriteString(name, value);
    }
}
