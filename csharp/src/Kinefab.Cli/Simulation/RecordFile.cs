using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Security.Cryptography;
using System.Text.Encodings.Web;
using System.Text.Json;
using Kinefab.Cli.Commands;
using Kinefab.Cli.Motion;
using Kinefab.Diagnostics;
using Kinefab.Dynamics;

namespace Kinefab.Cli.Simulation;

/// <summary>Writes and reads recordings, NAME.kfrec. What is wrong with one is a finding.</summary>
internal static class RecordFile
{
    private const string Format = "kinefab.recording";
    private const string Version = "1.0";

    private static readonly string[] Fields = ["format", "version", "scene", "solver", "step", "steps", "drives", "every", "hashes"];

    // Of the most steps that are run, one hash each, and room to spare.
    private const long MostBytes = 64L << 20;

    internal static Report Save(RunRecord record, string path) => TargetFile.Write(path, target =>
    {
        using var json = new Utf8JsonWriter(target, new JsonWriterOptions { Indented = true, NewLine = "\n", Encoder = JavaScriptEncoder.UnsafeRelaxedJsonEscaping });
        json.WriteStartObject();
        json.WriteString("format", Format);
        json.WriteString("version", Version);
        json.WriteString("scene", record.Scene);
        json.WriteString("solver", record.Solver.ToJson());
        json.WriteNumber("step", record.Step);
        json.WriteNumber("steps", record.Steps);
        json.WriteStartArray("drives");
        foreach (string drive in record.Drives)
            json.WriteStringValue(drive);
        json.WriteEndArray();
        json.WriteNumber("every", record.Every);
        json.WriteStartArray("hashes");
        foreach (ulong hash in record.Hashes)
            json.WriteStringValue(hash.ToString("x16", CultureInfo.InvariantCulture));
        json.WriteEndArray();
        json.WriteEndObject();
    });

    /// <summary>The recording, or null and what is wrong with it.</summary>
    internal static (RunRecord? Record, Report Report) Load(string path)
    {
        try
        {
            // A pipe or device has no length. It is not opened: that alone waits until somebody writes.
            var file = new FileInfo(path);
            if (file.Exists && file.Length is 0 or > MostBytes)
                return Unreadable(path, $"it has {file.Length} bytes; 1 to {MostBytes} are read");
            using JsonDocument document = JsonDocument.Parse(File.ReadAllBytes(path));
            JsonElement root = document.RootElement;
            if (root.ValueKind != JsonValueKind.Object || !root.TryGetProperty("format", out JsonElement format) || format.GetRawText() != $"\"{Format}\"")
                return Unreadable(path, $"its format is not {Format}");
            if (Text(root, "version") is var version && version != Version)
                return (null, new Report([Diagnostic.Of(DiagnosticCodes.RecordingVersionUnknown, "/version", ("path", path), ("version", version), ("known", Version))]));
            return (Read(root), Report.Empty);
        }
        catch (JsonException e)
        {
            return Unreadable(path, string.Create(CultureInfo.InvariantCulture, $"it is no whole JSON text (line {e.LineNumber + 1}, byte {e.BytePositionInLine + 1})"));
        }
        catch (InvalidDataException e)
        {
            return Unreadable(path, e.Message);
        }
        catch (Exception e) when (e is IOException or UnauthorizedAccessException or ArgumentException or NotSupportedException)
        {
            return Unreadable(path, Directory.Exists(path) ? "it is a folder" : e is FileNotFoundException or DirectoryNotFoundException ? "there is no such file" : e.Message.TrimEnd('.'));
        }
    }

    /// <summary>No recording, and why.</summary>
    internal static (RunRecord? Record, Report Report) Unreadable(string path, string detail) =>
        (null, new Report([Diagnostic.Of(DiagnosticCodes.RecordingUnreadable, "", ("path", path), ("detail", detail))]));

    /// <summary>What <see cref="RunRecord.Scene"/> is of a file.</summary>
    internal static string HashOfScene(string path)
    {
        using FileStream file = File.OpenRead(path);
        return Convert.ToHexStringLower(SHA256.HashData(file));
    }

    private static RunRecord Read(JsonElement root)
    {
        // Of two fields of one name either may be meant, and one that was mistyped would not be missed where it stands beside the true one.
        var seen = new HashSet<string>(StringComparer.Ordinal);
        foreach (JsonProperty member in root.EnumerateObject())
        {
            string name = NameOf(member);
            if (!Fields.Contains(name))
                throw new InvalidDataException($"it has a field {name}, which no recording has");
            if (!seen.Add(name))
                throw new InvalidDataException($"it has the field {name} twice");
        }

        string scene = Text(root, "scene");
        if (scene.Length != 64 || !scene.All(char.IsAsciiHexDigitLower))
            throw new InvalidDataException("scene is not 64 hexadecimal digits");
        SolverKind solver = Text(root, "solver") switch
        {
            "unity" => SolverKind.Unity,
            "exact" => SolverKind.Exact,
            var other => throw new InvalidDataException($"solver is {other}; there are unity and exact"),
        };
        double step = Member(root, "step", JsonValueKind.Number).TryGetDouble(out double value) && value >= TypedOptions.ShortestStep && double.IsFinite(value)
            ? value
            : throw new InvalidDataException(string.Create(CultureInfo.InvariantCulture, $"step is no number of seconds from {TypedOptions.ShortestStep} on"));
        int steps = Whole(root, "steps");
        if (!double.IsFinite(steps * step))
            throw new InvalidDataException("steps of step seconds make no finite time");
        int every = Whole(root, "every");
        string[] drives = [.. Member(root, "drives", JsonValueKind.Array).EnumerateArray().Select((d, i) => TextOf(d, $"drives[{i}]"))];
        ulong[] hashes = [.. Member(root, "hashes", JsonValueKind.Array).EnumerateArray().Select((h, i) => Hash(h, i))];
        int count = RunRecord.Count(steps, every);
        return hashes.Length == count
            ? new RunRecord(scene, solver, step, steps, drives, every, hashes)
            : throw new InvalidDataException($"it has {hashes.Length} hashes; {steps} steps with one for every {every} make {count}");
    }

    private static ulong Hash(JsonElement element, int index)
    {
        string text = TextOf(element, $"hashes[{index}]");
        return text.Length == 16 && ulong.TryParse(text, NumberStyles.AllowHexSpecifier, CultureInfo.InvariantCulture, out ulong hash)
            ? hash
            : throw new InvalidDataException($"hashes[{index}] is not 16 hexadecimal digits");
    }

    private static int Whole(JsonElement root, string name) =>
        Member(root, name, JsonValueKind.Number).TryGetInt32(out int value) && value is >= 1 and <= TypedOptions.MostSteps
            ? value
            : throw new InvalidDataException($"{name} is no whole number from 1 to {TypedOptions.MostSteps}");

    private static string Text(JsonElement root, string name) => TextOf(Member(root, name, JsonValueKind.String), name);

    private static string TextOf(JsonElement element, string name)
    {
        try
        {
            return element.ValueKind == JsonValueKind.String ? element.GetString()! : throw new InvalidDataException($"{name} is no text");
        }
        catch (InvalidOperationException)
        {
            throw new InvalidDataException($"{name} is no text of Unicode");
        }
    }

    private static string NameOf(JsonProperty member)
    {
        try
        {
            return member.Name;
        }
        catch (InvalidOperationException)
        {
            throw new InvalidDataException("a field's name is no text of Unicode");
        }
    }

    private static JsonElement Member(JsonElement root, string name, JsonValueKind kind)
    {
        if (!root.TryGetProperty(name, out JsonElement member))
            throw new InvalidDataException($"{name} is missing");
        return member.ValueKind == kind ? member : throw new InvalidDataException($"{name} is no {kind.ToString().ToLowerInvariant()}");
    }
}
