using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.Encodings.Web;
using System.Text.Json;
using Kinefab.Diagnostics;
using Kinefab.Numerics;

namespace Kinefab.Cli.Motion;

/// <summary>Writes trajectories as JSON or CSV.</summary>
internal static class TrajectoryFile
{
    private static readonly string[] PoseParts = ["px", "py", "pz", "qx", "qy", "qz", "qw"];

    /// <summary>.csv by its name, else JSON; the report says what kept it from being written.</summary>
    internal static Report Save(Trajectory trajectory, string path) => TargetFile.Write(path, target =>
    {
        if (Path.GetExtension(path).Equals(".csv", StringComparison.OrdinalIgnoreCase))
            WriteCsv(trajectory, target);
        else
            WriteJson(trajectory, target);
    });

    private static void WriteCsv(Trajectory trajectory, Stream file)
    {
        using var target = new StreamWriter(file, new UTF8Encoding(encoderShouldEmitUTF8Identifier: false), leaveOpen: true) { NewLine = "\n" };
        IEnumerable<string> columns = trajectory.Coordinates.Select(c => c.Name)
            .Concat(trajectory.Bodies.SelectMany(b => PoseParts.Select(p => b.Id + "." + p)))
            .Prepend(trajectory.Driver is null ? "time" : "driver " + trajectory.Driver.Name);
        target.WriteLine(string.Join(',', columns.Select(Quoted)));
        for (int i = 0; i < trajectory.At.Count; i++)
        {
            IEnumerable<double> row = trajectory.Coordinates.Select(c => c.Values[i])
                .Concat(trajectory.Bodies.SelectMany(b => Numbers(b.Poses[i])))
                .Prepend(trajectory.At[i]);
            target.WriteLine(string.Join(',', row.Select(v => v.ToString("R", CultureInfo.InvariantCulture))));
        }
    }

    private static void WriteJson(Trajectory trajectory, Stream target)
    {
        using var json = new Utf8JsonWriter(target, new JsonWriterOptions { Encoder = JavaScriptEncoder.UnsafeRelaxedJsonEscaping });
        json.WriteStartObject();
        json.WriteString("format", "kinefab.trajectory");
        json.WriteString("version", "1.0");
        json.WriteString("solver", trajectory.Solver);
        if (trajectory.Step is double step)
            json.WriteNumber("step", step);
        if (trajectory.Driver is TrajectoryCoordinate driver)
        {
            json.WriteStartObject("driver");
            WriteFields(json, driver);
            Array(json, "values", trajectory.At);
            json.WriteEndObject();
        }
        else
        {
            Array(json, "times", trajectory.At);
        }

        json.WriteStartArray("coordinates");
        foreach (TrajectoryCoordinate coordinate in trajectory.Coordinates)
        {
            json.WriteStartObject();
            WriteFields(json, coordinate);
            Array(json, "values", coordinate.Values);
            json.WriteEndObject();
        }

        json.WriteEndArray();
        json.WriteStartArray("bodies");
        foreach (TrajectoryBody body in trajectory.Bodies)
        {
            json.WriteStartObject();
            json.WriteNumber("gameObject", body.GameObject);
            json.WriteString("id", body.Id);
            json.WriteStartArray("poses");
            foreach (Pose pose in body.Poses)
                Array(json, null, Numbers(pose));
            json.WriteEndArray();
            json.WriteEndObject();
        }

        json.WriteEndArray();
        json.WriteEndObject();
    }

    private static void WriteFields(Utf8JsonWriter json, TrajectoryCoordinate coordinate)
    {
        json.WriteNumber("gameObject", coordinate.GameObject);
        json.WriteString("id", coordinate.Id);
        json.WriteNumber("component", coordinate.Component);
        json.WriteString("coordinate", coordinate.Coordinate.ToJson());
    }

    private static void Array(Utf8JsonWriter json, string? name, IEnumerable<double> values)
    {
        if (name is not null)
            json.WritePropertyName(name);
        json.WriteStartArray();
        foreach (double value in values)
            json.WriteNumberValue(value);
        json.WriteEndArray();
    }

    private static double[] Numbers(Pose pose) =>
        [pose.Position.X, pose.Position.Y, pose.Position.Z, pose.Rotation.X, pose.Rotation.Y, pose.Rotation.Z, pose.Rotation.W];

    private static string Quoted(string text) =>
        text.AsSpan().IndexOfAny(",\"\r\n") < 0 ? text : "\"" + text.Replace("\"", "\"\"", StringComparison.Ordinal) + "\"";
}
