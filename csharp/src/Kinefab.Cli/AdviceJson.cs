using System.Text.Json;
using Kinefab.Advice;
using Kinefab.Diagnostics;

namespace Kinefab.Cli;

/// <summary>Stability advice as programs read it: the field "advice" of schemas/advice.schema.json.</summary>
internal static class AdviceJson
{
    internal static void Write(AdviceReport advice, Utf8JsonWriter json)
    {
        json.WriteStartObject("advice");
        json.WriteNumber("step", advice.Step);
        json.WriteNumber("steps", advice.Steps);
        json.WriteNumber("trials", advice.Trials);
        json.WriteStartArray("findings");
        foreach (AdviceFinding finding in advice.Findings)
            Write(finding, json);
        json.WriteEndArray();
        json.WriteEndObject();
    }

    private static void Write(AdviceFinding finding, Utf8JsonWriter json)
    {
        Diagnostic found = finding.Diagnostic;
        json.WriteStartObject();
        json.WriteString("code", found.Code);
        json.WriteString("severity", found.Severity.ToJson());
        json.WriteString("pointer", found.Pointer);
        json.WriteString("id", finding.Id);
        json.WriteString("message", found.Message);
        json.WriteString("remedy", found.Remedy);
        Write("before", finding.Before, json);
        json.WriteNumber("score", finding.Score);
        json.WriteStartArray("tried");
        foreach (TriedChange tried in finding.Tried)
        {
            json.WriteStartObject();
            json.WriteString("change", tried.Change);
            json.WriteBoolean("best", tried == finding.Best);
            json.WriteStartArray("edits");
            foreach (SceneEdit edit in tried.Edits)
            {
                json.WriteStartObject();
                json.WriteString("pointer", edit.Pointer);
                json.WritePropertyName("value");
                json.WriteRawValue(edit.Value);
                json.WriteEndObject();
            }

            json.WriteEndArray();
            Write("after", tried.After, json);
            json.WriteNumber("score", tried.Score);
            json.WriteNumber("work", tried.Work);
            json.WriteEndObject();
        }

        json.WriteEndArray();
        json.WriteEndObject();
    }

    private static void Write(string name, AdviceMeasure measure, Utf8JsonWriter json)
    {
        json.WriteStartObject(name);
        if (measure.Distance is double distance)
            json.WriteNumber("distance", distance);
        if (measure.Angle is double angle)
            json.WriteNumber("angle", angle);
        json.WriteEndObject();
    }
}
