using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Globalization;
using System.IO;
using System.Linq;
using NUnit.Framework;

namespace Kinefab.Tests.Portability;

/// <summary>
/// Every portable run under Debian's mono, in whose line Unity's own runtime stands, against the same run here, bit by bit. Once as mono
/// computes by default and once with floats widened to doubles, as Unity's Mono did for years.
/// </summary>
[Category("Mono")]
public sealed class MonoTests
{
    private static readonly string? Mono = Find("mono");

    private static readonly Dictionary<string, Lazy<Dictionary<string, long[]>>> Outputs = new[] { "-O=float32", "-O=-float32" }.ToDictionary(
        option => option, option => new Lazy<Dictionary<string, long[]>>(() => Output(option)));

    private static IEnumerable<TestCaseData> Cases()
    {
        if (Mono is null)
        {
            yield return new TestCaseData("", "").SetArgDisplayNames("none").Ignore("no mono on the PATH (on Debian: apt-get install mono-devel)");
            yield break;
        }

        foreach (string option in Outputs.Keys)
        {
            foreach (PortableRun run in PortableRun.All)
                yield return new TestCaseData(option, run.Name).SetArgDisplayNames(option, run.Name);
        }
    }

    [TestCaseSource(nameof(Cases))]
    public void Run_UnderMono_HasTheSameBits(string option, string name)
    {
        long[] here = [.. PortableRun.All.Single(r => r.Name == name).Numbers().Select(BitConverter.DoubleToInt64Bits)];
        long[] there = Outputs[option].Value[name];

        Assert.That(there, Has.Length.EqualTo(here.Length).And.Length.GreaterThan(0));
        int differs = Enumerable.Range(0, here.Length).FirstOrDefault(i => here[i] != there[i], -1);
        Assert.That(differs, Is.EqualTo(-1), "the first number that differs");
    }

    private static Dictionary<string, long[]> Output(string option)
    {
        var folder = new DirectoryInfo(AppContext.BaseDirectory);
        string tests = folder.Parent!.Parent!.Parent!.Parent!.FullName;
        string program = Path.Combine(tests, "Kinefab.Mono", "bin", folder.Parent!.Name, "netstandard2.0", "Kinefab.Mono.dll");
        var start = new ProcessStartInfo(Mono!, [option, program]) { RedirectStandardOutput = true, RedirectStandardError = true };
        using Process process = Process.Start(start)!;
        System.Threading.Tasks.Task<string> errors = process.StandardError.ReadToEndAsync();
        string text = process.StandardOutput.ReadToEnd();
        process.WaitForExit();
        Assert.That(process.ExitCode, Is.Zero, errors.Result);
        return text.Split('\n', StringSplitOptions.RemoveEmptyEntries).Select(line => line.Split('\t')).ToDictionary(l => l[0], l => Numbers(l[1]));
    }

    private static long[] Numbers(string bits) => [.. bits.Split(' ').Select(b => long.Parse(b, NumberStyles.HexNumber, CultureInfo.InvariantCulture))];

    private static string? Find(string program) => (Environment.GetEnvironmentVariable("PATH") ?? "").Split(Path.PathSeparator)
        .Select(folder => Path.Combine(folder, program))
        .FirstOrDefault(File.Exists);
}
