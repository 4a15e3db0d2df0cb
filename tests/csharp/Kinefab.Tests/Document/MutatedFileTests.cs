using System;
using System.Buffers.Binary;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Document;

/// <summary>
/// Files that are nearly scenes, as text and in one file: each is a report with errors or a valid scene; what a valid one says is what
/// another reader of JSON finds in it, and it is the same after saving. <c>KINEFAB_MUTANTS</c> names how many; without it, as many as take seconds.
/// </summary>
public class MutatedFileTests
{
    private static readonly byte[][] Packed = SceneMutants.Scenes.Where(scene => scene.Document.Buffers.Count <= 1).Select(scene => Bytes(scene.Document with { Container = SceneContainer.Binary })).ToArray();

    private static int Count => SceneMutants.Count(3000) / 2;

    [Test]
    public void Parse_Texts_AreAReportOrTheSceneThatTheySay()
    {
        int valid = 0;
        for (int seed = 0; seed < Count; seed++)
        {
            byte[] text = Encoding.UTF8.GetBytes(SceneMutants.Text(new Random(seed)));
            valid += Holds(text, text, $"seed {seed}") ? 1 : 0;
        }

        Assert.That(valid, Is.GreaterThan(Count / 20), "some are scenes still, or nothing is compared");
    }

    [Test]
    public void Parse_ScenesInOneFile_AreAReportOrTheSceneThatTheySay()
    {
        int valid = 0;
        for (int seed = 0; seed < Count; seed++)
        {
            var random = new Random(seed);
            byte[] file = (byte[])Packed[random.Next(Packed.Length)].Clone();
            int length = BinaryPrimitives.ReadInt32LittleEndian(file.AsSpan(12));
            switch (random.Next(4))
            {
                case 0:
                    for (int fault = random.Next(1, 4); fault > 0; fault--)
                        file[random.Next(random.Next(2) == 0 ? 28 : file.Length)] = (byte)random.Next(256);
                    break;
                case 1:
                    file = file.AsSpan(0, random.Next(file.Length)).ToArray();
                    if (file.Length > 12 && random.Next(2) == 0)
                        BinaryPrimitives.WriteInt32LittleEndian(file.AsSpan(8), file.Length);
                    break;
                default:
                    file = WithText(file, length, SceneMutants.Replaced(Encoding.UTF8.GetString(file, 20, length).TrimEnd(' '), random));
                    break;
            }

            int now = file.Length < 20 ? 0 : Math.Clamp(BinaryPrimitives.ReadInt32LittleEndian(file.AsSpan(12)), 0, file.Length - 20);
            valid += Holds(file, file.Length < 20 ? [] : file.AsSpan(20, now).ToArray(), $"seed {seed}") ? 1 : 0;
        }

        Assert.That(valid, Is.GreaterThan(Count / 40), "some are scenes still, or nothing is compared");
    }

    private static byte[] WithText(byte[] file, int length, string text)
    {
        byte[] written = Encoding.UTF8.GetBytes(text);
        byte[] padded = [.. written, .. Enumerable.Repeat((byte)' ', -written.Length & 3)];
        byte[] longer = [.. file.AsSpan(0, 20), .. padded, .. file.AsSpan(20 + length)];
        BinaryPrimitives.WriteInt32LittleEndian(longer.AsSpan(8), longer.Length);
        BinaryPrimitives.WriteInt32LittleEndian(longer.AsSpan(12), padded.Length);
        return longer;
    }

    // Whether it is a valid scene; then also what it says.
    private static bool Holds(byte[] file, byte[] text, string which)
    {
        SceneReading reading = SceneFile.Parse(file, uri => SceneMutants.Buffers.TryGetValue(uri, out byte[]? bytes) ? bytes : new byte[72]);
        if (reading.Document is null)
        {
            Assert.That(reading.Report.HasErrors, which);
            Assert.That(reading.Report.Diagnostics.All(found => (found.Line > 0 && found.Column > 0) || found.Code.StartsWith("CONTAINER_", StringComparison.Ordinal)), which);
            return false;
        }

        SceneValidation validation = SceneValidator.Validate(reading.Document);
        Assert.That(validation.Report.HasErrors, Is.EqualTo(validation.Scene is null), which);
        if (validation.Scene is null)
            return false;
        byte[] saved = Bytes(reading.Document with { Container = SceneContainer.Text, Buffers = [] });
        Assert.That(Bytes(SceneFile.Parse(saved).Document!), Is.EqualTo(saved), which);
        using JsonDocument said = JsonDocument.Parse(text, new JsonDocumentOptions { MaxDepth = 200 });
        using JsonDocument kept = JsonDocument.Parse(saved);
        Compare(kept.RootElement, said.RootElement, which);
        return true;
    }

    // What is kept is said, but for what stands at its place always.
    private static void Compare(JsonElement kept, JsonElement said, string at)
    {
        Assert.That(said.ValueKind == kept.ValueKind, $"{at}: {said} is kept as {kept}");
        switch (kept.ValueKind)
        {
            case JsonValueKind.Object:
                foreach (JsonProperty property in kept.EnumerateObject().Where(property => property.Name is not ("version" or "buffers")))
                {
                    if (property.Name == "constraints" && property.Value[0].ValueKind == JsonValueKind.String)
                        Assert.That(Words(property.Value), Is.EquivalentTo(Words(said.GetProperty("constraints"))), at);
                    else if (said.TryGetProperty(property.Name, out JsonElement value))
                        Compare(property.Value, value, $"{at}/{property.Name}");
                    else
                        Assert.That(IsAlwaysWritten(property), $"{at}: {property.Name} is not said, and kept as {property.Value}");
                }

                break;
            case JsonValueKind.Array:
                Assert.That(said.GetArrayLength(), Is.EqualTo(kept.GetArrayLength()), at);
                for (int i = 0; i < kept.GetArrayLength(); i++)
                    Compare(kept[i], said[i], $"{at}/{i}");
                break;
            case JsonValueKind.Number:
                Assert.That(kept.GetDouble(), Is.EqualTo(said.GetDouble()), at);
                break;
            case JsonValueKind.String:
                Assert.That(kept.GetString(), Is.EqualTo(said.GetString()), at);
                break;
        }
    }

    // Lists of an analysis, empty, and what of a gap there is none.
    private static bool IsAlwaysWritten(JsonProperty property) => property.Name switch
    {
        "islands" or "bodies" or "directions" or "axes" => property.Value.GetArrayLength() == 0,
        "position" or "angle" => property.Value.GetDouble() == 0,
        _ => false,
    };

    private static IEnumerable<string?> Words(JsonElement list) => list.EnumerateArray().Select(word => word.GetString());

    private static byte[] Bytes(SceneDocument document)
    {
        using var stream = new MemoryStream();
        SceneFile.Save(document, stream);
        return stream.ToArray();
    }
}
