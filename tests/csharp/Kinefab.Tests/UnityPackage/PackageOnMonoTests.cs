using System;
using System.Diagnostics;
using System.Globalization;
using System.IO;
using System.Linq;
using NUnit.Framework;

namespace Kinefab.Tests.UnityPackage;

/// <summary>The package's runtime under Debian's mono, in whose line Unity's own stands, against the same run here, bit by bit.</summary>
[Category("Mono")]
[NonParallelizable]
public sealed class PackageOnMonoTests
{
    private static readonly string? Mono = (Environment.GetEnvironmentVariable("PATH") ?? "").Split(Path.PathSeparator).Select(folder => Path.Combine(folder, "mono")).FirstOrDefault(File.Exists);

    [Test]
    public void Package_UnderMono_HasTheSameBits()
    {
        if (Mono is null)
            Assert.Ignore("no mono on the PATH (on Debian: apt-get install mono-devel)");
        string[] scenes = [PlayedMechanism.Lever, PlayedMechanism.Full("mechanisms/M48.kinefab"), PlayedMechanism.Full("lever/lever.kinefab")];
        var folder = new DirectoryInfo(AppContext.BaseDirectory);
        string program = Path.Combine(folder.Parent!.Parent!.Parent!.Parent!.FullName, "Kinefab.Mono", "bin", folder.Parent!.Name, "netstandard2.0", "Kinefab.Mono.dll");
        using Process process = Process.Start(new ProcessStartInfo(Mono!, ["-O=float32", program, .. scenes]) { RedirectStandardOutput = true, RedirectStandardError = true })!;
        System.Threading.Tasks.Task<string> errors = process.StandardError.ReadToEndAsync();
        string[] lines = process.StandardOutput.ReadToEnd().Split('\n', StringSplitOptions.RemoveEmptyEntries);
        process.WaitForExit();
        // Of a mono that lacks an assembly (Debian has netstandard.dll in mono-devel) what is missing stands in its output.
        Assert.That(process.ExitCode, Is.Zero, $"{errors.Result}{string.Join(Environment.NewLine, lines.Take(5))}");
        Assert.That(lines, Has.Length.EqualTo(scenes.Length));
        foreach ((string scene, string line) in scenes.Zip(lines))
        {
            double[] here = [.. PackageRun.Numbers(scene)];
            double[] there = [.. line.Split('\t')[1].Split(' ').Select(b => BitConverter.Int64BitsToDouble(long.Parse(b, NumberStyles.HexNumber, CultureInfo.InvariantCulture)))];
            Assert.That(there, Has.Length.EqualTo(here.Length).And.Length.GreaterThan(500));
            int differs = Enumerable.Range(0, here.Length).FirstOrDefault(i => BitConverter.DoubleToInt64Bits(here[i]) != BitConverter.DoubleToInt64Bits(there[i]), -1);
            Assert.That(differs, Is.EqualTo(-1), $"{scene}: the first number that differs");
        }
    }
}
