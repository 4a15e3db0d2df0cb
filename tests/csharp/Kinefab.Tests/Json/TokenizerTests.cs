using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Reading;
using Kinefab.Tests.Conformance;
using NUnit.Framework;

namespace Kinefab.Tests.Json;

/// <summary>The tokenizer against the framework's own, which is strict: the same tokens, values to the last bit, and places of faults.</summary>
public sealed class TokenizerTests
{
    private const int MaxDepth = 80;

    // KINEFAB_JSON_MUTANTS sets another number; what the suite runs takes some seconds.
    private static readonly int Mutants = int.Parse(Environment.GetEnvironmentVariable("KINEFAB_JSON_MUTANTS") ?? "200000", CultureInfo.InvariantCulture);

    [TestCase("null")]
    [TestCase("  [1, -0, 0.5, 1e5, 1E+05, 123456789012345678901234567890, 9223372036854775807, -9223372036854775808, 9223372036854775808]\r\n\t")]
    [TestCase("[4.9406564584124654e-324, 1.7976931348623157e308, 1e999, -1e-999, 0.1000000000000000055511151231257827, 17.000000000000001]")]
    [TestCase("""{"a": {"b": [true, false, null, {}, [], ""]}, "a": 2}""")]
    [TestCase("""["\" \\ \/ \b \f \n \r \t \u0041 \uD83D\uDE00", "\uD83D", "\uDE00\uD83D", "é € 😀"]""")]
    [TestCase("""{"\u0061\n": 1, "": 2}""")]
    [TestCase("")]
    [TestCase("   ")]
    [TestCase("[1,]")]
    [TestCase("{\"a\":1,}")]
    [TestCase("[1 2]")]
    [TestCase("{\"a\" 1}")]
    [TestCase("{\"a\"}")]
    [TestCase("{\"a\":}")]
    [TestCase("{a:1}")]
    [TestCase("{\"a\":1")]
    [TestCase("{\"a\":")]
    [TestCase("{\"a\"")]
    [TestCase("[")]
    [TestCase("[1")]
    [TestCase("[1,")]
    [TestCase("{\"a\":1,")]
    [TestCase("[1}")]
    [TestCase("{\"a\":1]")]
    [TestCase("{]")]
    [TestCase("[,1]")]
    [TestCase("[1,,2]")]
    [TestCase("]")]
    [TestCase("1 2")]
    [TestCase("{} {}")]
    [TestCase("[01]")]
    [TestCase("[-]")]
    [TestCase("[-01]")]
    [TestCase("-")]
    [TestCase("[1.]")]
    [TestCase("[.5]")]
    [TestCase("[1e]")]
    [TestCase("[1e+]")]
    [TestCase("1e")]
    [TestCase("1.")]
    [TestCase("[+1]")]
    [TestCase("[1x]")]
    [TestCase("[NaN]")]
    [TestCase("[Infinity]")]
    [TestCase("[tru]")]
    [TestCase("tru")]
    [TestCase("truex")]
    [TestCase("[nul, 1]")]
    [TestCase("// comment\n1")]
    [TestCase("[1, /* two */ 2]")]
    [TestCase("\"open")]
    [TestCase("[\"open\\")]
    [TestCase("\"\\x\"")]
    [TestCase("\"\\u12G4\"")]
    [TestCase("\"\\u12")]
    [TestCase("\"a\nb\"")]
    [TestCase("\"a\tb\"")]
    [TestCase("'a'")]
    public void Tokens_OfAText_AreTheFrameworks(string text) => Assert.That(Tokens(text), Is.EqualTo(Frameworks(text)));

    [Test]
    public void Tokens_OfDeepTexts_AreTheFrameworks()
    {
        foreach (int depth in new[] { 1, 63, 64, 65, 66, 79, 80, 81, 200 })
        {
            string open = string.Concat(Enumerable.Range(0, depth).Select(i => i % 3 == 0 ? "[" : "{\"a\":"));
            string close = string.Concat(Enumerable.Range(0, depth).Reverse().Select(i => i % 3 == 0 ? "]" : "}"));
            Assert.That(Tokens($"{open}1{close}"), Is.EqualTo(Frameworks($"{open}1{close}")), $"depth {depth}");
            Assert.That(Tokens($"{open}1{close.Replace('}', ']')}"), Is.EqualTo(Frameworks($"{open}1{close.Replace('}', ']')}")), $"depth {depth}, closed wrongly");
        }
    }

    [Test]
    public void Tokens_OfMutatedTexts_AreTheFrameworks()
    {
        var random = new Random(20261127);
        string[] pieces = ["{", "}", "[", "]", ",", ":", "\"", "\\", "\\u", "\\uD83D", "\\uDE00", "0", "-", "-0", ".", "e", "E+", "1e400", "true", "null", "NaN", " ", "\n", "\u0001", "é", "😀", "//", "\"a\":", "18446744073709551616", "0.30000000000000004", "2.2250738585072011e-308"];
        int sound = 0;
        for (int i = 0; i < Mutants; i++)
        {
            var text = new StringBuilder(Generated(random, 0));
            for (int changes = random.Next(4); changes > 0; changes--)
            {
                int at = random.Next(text.Length + 1);
                if (random.Next(3) > 0 || at == text.Length)
                    text.Insert(at, pieces[random.Next(pieces.Length)]);
                else if (random.Next(4) > 0)
                    text.Remove(at, Math.Min(random.Next(1, 4), text.Length - at));
                else
                    text.Length = at;
            }

            string whole = Encoding.UTF8.GetString(Encoding.UTF8.GetBytes(text.ToString()));
            List<string> expected = Frameworks(whole);
            sound += expected[^1] == "end" ? 1 : 0;
            if (!Tokens(whole).SequenceEqual(expected))
                Assert.That(Tokens(whole), Is.EqualTo(expected), whole);
        }

        Assert.That(sound, Is.InRange(Mutants / 10, Mutants * 9 / 10), "sound texts and broken ones");
    }

    [Test]
    public void Tree_WrittenAndReadAgain_IsTheSame()
    {
        byte[] text = File.ReadAllBytes(Path.Combine(ConformanceCases.Folder, "..", "..", "fixtures", "lever", "lever.kinefab"));
        string once = JsonTree.Parse(text).ToString();
        Assert.That(JsonTree.Parse(once).ToString(), Is.EqualTo(once));
        Assert.That(Tokens(once).Select(WithoutPlace), Is.EqualTo(Frameworks(Encoding.UTF8.GetString(text)).Select(WithoutPlace)));

        static string WithoutPlace(string token) => token[(token.IndexOf(' ', StringComparison.Ordinal) + 1)..];
    }

    [Test]
    public void Tree_SetAtPointers_ChangesAndMakes()
    {
        JsonTree tree = JsonTree.Parse("""{"a/b": [1, {"~": 2}], "c": "\u0041"}""");
        tree.Set("/a~1b/1/~0", JsonTree.Parse("[true]"));
        tree.Set("/a~1b/0", JsonTree.Numbers(-10, 0.1));
        tree.Set("/d/e", JsonTree.String("x\"\n"));
        Assert.That(tree.ToString(), Is.EqualTo("""{"a/b":[[-10,0.1],{"~":[true]}],"c":"\u0041","d":{"e":"x\"\n"}}"""));
        Assert.That(tree["c"]!.AsString(), Is.EqualTo("A"));
    }

    [Test]
    public void JsonTestSuite_EveryCase_IsTakenOrRefusedAsItSays()
    {
        string? folder = Environment.GetEnvironmentVariable("KINEFAB_JSON_TEST_SUITE");
        if (folder is null)
            Assert.Ignore("KINEFAB_JSON_TEST_SUITE names no folder of github.com/nst/JSONTestSuite's test_parsing.");
        string[] files = Directory.GetFiles(folder!, "*.json");
        Assert.That(files, Has.Length.GreaterThan(300));
        using (Assert.EnterMultipleScope())
        {
            foreach (string file in files)
            {
                string name = Path.GetFileName(file);
                byte[] bytes = File.ReadAllBytes(file);
                bool isTaken = Utf8Check.FirstInvalid(bytes) < 0 && Tokens(bytes, 1024)[^1] == "end";
                if (name[0] != 'i')
                    Assert.That(isTaken, Is.EqualTo(name[0] == 'y'), name);
            }
        }
    }

    [Test]
    public void Library_ForUnity_ReferencesNothingButNetstandard()
    {
        string dll = Path.GetFullPath(Path.Combine(
            ConformanceCases.Folder, "..", "..", "csharp", "src", "Kinefab", "bin",
            Path.GetFileName(Path.GetDirectoryName(TestContext.CurrentContext.TestDirectory.TrimEnd(Path.DirectorySeparatorChar)))!, "netstandard2.1", "Kinefab.dll"));
        using var file = new System.Reflection.PortableExecutable.PEReader(File.OpenRead(dll));
        System.Reflection.Metadata.MetadataReader metadata = System.Reflection.Metadata.PEReaderExtensions.GetMetadataReader(file);
        Assert.That(metadata.AssemblyReferences.Select(r => metadata.GetString(metadata.GetAssemblyReference(r).Name)), Is.EqualTo(["netstandard"]));
    }

    private static string Generated(Random random, int depth)
    {
        string space = random.Next(8) == 0 ? " " : random.Next(20) == 0 ? "\n" : "";
        switch (random.Next(depth > 3 ? 5 : 8))
        {
            case 0:
                return space + random.Next(-1000, 1000).ToString(CultureInfo.InvariantCulture);
            case 1:
                return space + (random.NextDouble() * Math.Pow(10, random.Next(-330, 310))).ToString("R", CultureInfo.InvariantCulture);
            case 2:
                return new[] { "true", "false", "null", "0", "-0.0", "1e5", "12.5E-3", "100000000000000000000" }[random.Next(8)];
            case 3 or 4:
                return "\"" + new[] { "", "a", "type", "Lever/Crank:1", "\\n", "\\u00e9", "é", "\\ud83d\\ude00", "\\ud83d", "😀 and more than a few characters" }[random.Next(10)] + "\"";
            case 5:
                return $"[{space}{string.Join(",", Enumerable.Range(0, random.Next(4)).Select(_ => Generated(random, depth + 1)))}]";
            default:
                return $"{{{string.Join(",", Enumerable.Range(0, random.Next(4)).Select(i => $"{space}\"f{i}\"{space}:{Generated(random, depth + 1)}"))}{space}}}";
        }
    }

    private static List<string> Tokens(string text) => Tokens(Encoding.UTF8.GetBytes(text), MaxDepth);

    private static List<string> Tokens(byte[] text, int maxDepth)
    {
        var tokens = new List<string>();
        var json = new Utf8Tokenizer(text, maxDepth);
        try
        {
            while (json.Read())
            {
                string value = json.Token switch
                {
                    JsonToken.String or JsonToken.PropertyName => json.TryGetString(out string plain) ? plain : "half a surrogate",
                    JsonToken.Number => Number(json.TryGetInt64(out long integer), integer, true, json.GetDouble()),
                    _ => "",
                };
                tokens.Add($"{json.TokenStart}-{json.Consumed} {json.Token} {value}");
            }

            tokens.Add("end");
        }
        catch (JsonSyntaxException fault)
        {
            tokens.Add($"fault at {fault.Offset}");
        }

        return tokens;
    }

    private static List<string> Frameworks(string text)
    {
        byte[] bytes = Encoding.UTF8.GetBytes(text);
        var tokens = new List<string>();
        var json = new Utf8JsonReader(bytes, new JsonReaderOptions { MaxDepth = MaxDepth });
        try
        {
            while (json.Read())
            {
                string value = "";
                if (json.TokenType is JsonTokenType.String or JsonTokenType.PropertyName)
                {
                    try
                    {
                        value = json.GetString()!;
                    }
                    catch (InvalidOperationException)
                    {
                        value = "half a surrogate";
                    }
                }
                else if (json.TokenType == JsonTokenType.Number)
                {
                    value = Number(json.TryGetInt64(out long integer), integer, json.TryGetDouble(out double number), number);
                }

                tokens.Add($"{json.TokenStartIndex}-{json.BytesConsumed} {json.TokenType} {value}");
            }

            tokens.Add("end");
        }
        catch (JsonException fault)
        {
            int start = 0;
            for (long line = fault.LineNumber!.Value; line > 0; line--)
                start += bytes.AsSpan(start).IndexOf((byte)'\n') + 1;
            tokens.Add($"fault at {start + fault.BytePositionInLine!.Value}");
        }

        return tokens;
    }

    private static string Number(bool isInteger, long integer, bool isNumber, double number) =>
        $"{(isInteger ? integer.ToString(CultureInfo.InvariantCulture) : "none")} {(isNumber ? BitConverter.DoubleToInt64Bits(number).ToString("x", CultureInfo.InvariantCulture) : "none")}";
}
