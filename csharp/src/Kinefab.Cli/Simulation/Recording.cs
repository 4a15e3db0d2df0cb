using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.Json;
using Kinefab.Dynamics;
using Kinefab.Numerics;

namespace Kinefab.Cli.Simulation;

/// <summary>The poses of all bodies' objects after every step, world frame, and the file they go to.</summary>
internal sealed class Recording
{
    private readonly World world;
    private readonly SolverKind solver;
    private readonly double step;
    private readonly List<double> times = [];
    private readonly List<Pose>[] poses;

    internal Recording(World world, SolverKind solver, double step)
    {
        this.world = world;
        this.solver = solver;
        this.step = step;
        poses = world.Bodies.Select(_ => new List<Pose>()).ToArray();
        Note();
    }

    /// <summary>Takes down where everything is.</summary>
    internal void Note()
    {
        times.Add(world.Time);
        for (int i = 0; i < poses.Length; i++)
            poses[i].Add(world.Bodies[i].Pose);
    }

    /// <summary>Writes the whole file or none of it; .csv by its name, else JSON.</summary>
    internal void Save(string path)
    {
        string temporary = path + ".part";
        using (var file = new StreamWriter(temporary, append: false, new UTF8Encoding(encoderShouldEmitUTF8Identifier: false)) { NewLine = "\n" })
        {
            if (Path.GetExtension(path).Equals(".csv", StringComparison.OrdinalIgnoreCase))
                WriteCsv(file);
            else
                WriteJson(file.BaseStream);
        }

        File.Move(temporary, path, overwrite: true);
    }

    private void WriteCsv(StreamWriter target)
    {
        string[] parts = ["px", "py", "pz", "qx", "qy", "qz", "qw"];
        target.WriteLine(string.Join(',', world.Bodies.SelectMany(b => parts.Select(p => Quoted(b.Id + "." + p))).Prepend("time")));
        for (int i = 0; i < times.Count; i++)
        {
            IEnumerable<double> row = poses.SelectMany(track => Numbers(track[i])).Prepend(times[i]);
            target.WriteLine(string.Join(',', row.Select(v => v.ToString("R", CultureInfo.InvariantCulture))));
        }
    }

    private void WriteJson(Stream target)
    {
        using var json = new Utf8JsonWriter(target);
        json.WriteStartObject();
        json.WriteString("format", "kinefab.trajectory");
        json.WriteString("version", "1.0");
        json.WriteString("solver", solver.ToString().ToLowerInvariant());
        json.WriteNumber("step", step);
        Array(json, "times", times);
        json.WriteStartArray("bodies");
        for (int i = 0; i < poses.Length; i++)
        {
            json.WriteStartObject();
            json.WriteNumber("gameObject", world.Bodies[i].GameObject);
            json.WriteString("id", world.Bodies[i].Id);
            json.WriteStartArray("poses");
            foreach (Pose pose in poses[i])
                Array(json, null, Numbers(pose));
            json.WriteEndArray();
            json.WriteEndObject();
        }

        json.WriteEndArray();
        json.WriteEndObject();
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
        text.AsSpan().IndexOfAny(',', '"', '\n') < 0 ? text : "\"" + text.Replace("\"", "\"\"", StringComparison.Ordinal) + "\"";
}
