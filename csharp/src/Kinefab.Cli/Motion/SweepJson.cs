using System.Linq;
using System.Text.Json;
using Kinefab.Kinematics;

namespace Kinefab.Cli.Motion;

/// <summary>A sweep as programs read it: the field "sweep" of schemas/report.schema.json.</summary>
internal static class SweepJson
{
    internal static void Write(Mechanism mechanism, SweepResult result, RangeLimit low, RangeLimit high, Utf8JsonWriter json)
    {
        MechanismCoordinate driven = mechanism.Coordinates[result.Coordinate];
        json.WriteStartObject("sweep");
        json.WriteString("coordinate", driven.Name);
        json.WriteString("unit", driven.Unit);
        json.WriteNumber("first", result.Values[0]);
        json.WriteNumber("last", result.Values[^1]);
        json.WriteNumber("steps", result.States.Count - 1);
        Write("low", mechanism, low, json);
        Write("high", mechanism, high, json);
        if (result.Stop is RangeLimit stop)
            Write("stopped", mechanism, stop, json);
        json.WriteStartArray("jumps");
        foreach (double jump in result.Jumps)
            json.WriteNumberValue(jump);
        json.WriteEndArray();
        json.WriteNumber("branches", result.Branches.Count);
        json.WriteNumber("worstGap", result.WorstErrorMetres);
        json.WriteNumber("worstGapAngle", result.WorstErrorDegrees);
        json.WriteStartArray("coordinates");
        for (int i = 0; i < mechanism.Coordinates.Count; i++)
        {
            int index = i;
            json.WriteStartObject();
            json.WriteString("name", mechanism.Coordinates[i].Name);
            json.WriteString("unit", mechanism.Coordinates[i].Unit);
            json.WriteNumber("least", result.States.Min(state => state.Coordinate(index)));
            json.WriteNumber("greatest", result.States.Max(state => state.Coordinate(index)));
            json.WriteEndObject();
        }

        json.WriteEndArray();
        json.WriteEndObject();
    }

    private static void Write(string field, Mechanism mechanism, RangeLimit limit, Utf8JsonWriter json)
    {
        json.WriteStartObject(field);
        json.WriteNumber("value", limit.Value);
        json.WriteString("end", limit.End.ToJson());
        if (limit.Limit is ReachedLimit reached && mechanism.FindCoordinate(reached.GameObject, reached.Component, reached.Coordinate) is int index and >= 0)
            json.WriteString("limit", mechanism.Coordinates[index].Name);
        json.WriteEndObject();
    }
}
