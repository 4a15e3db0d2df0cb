using System;
using System.Diagnostics;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;
using System.Runtime.Intrinsics;
using System.Runtime.Intrinsics.X86;
using Kinefab.Tests.Cli;
using NUnit.Framework;

namespace Kinefab.Tests.Portability;

/// <summary>Runs recorded here are replayed by the tool as it computes on lesser processors: each step has the same bits.</summary>
[NonParallelizable]
public sealed class SameBitsTests
{
    private string _folder = "";

    [SetUp]
    public void MakeFolder() => _folder = Directory.CreateTempSubdirectory("kinefab").FullName;

    [TearDown]
    public void RemoveFolder() => Directory.Delete(_folder, recursive: true);

    [Test]
    public void Replay_WithoutAvx512_IsTheSame()
    {
        if (!Vector512.IsHardwareAccelerated)
            Assert.Ignore("this processor has no AVX-512");
        Replay("DOTNET_EnableAVX512", "0");
    }

    [Test]
    public void Replay_WithoutAvx2_IsTheSame()
    {
        if (!Avx2.IsSupported)
            Assert.Ignore("this processor has no AVX2");
        Replay("DOTNET_EnableAVX2", "0");
    }

    [Test]
    public void Replay_WithoutAnyWideInstruction_IsTheSame() => Replay("DOTNET_EnableHWIntrinsic", "0");

    [Test]
    public void Replay_OnlyRoughlyCompiled_IsTheSame() => Replay("DOTNET_TieredCompilation", "1", "DOTNET_TC_CallCountThreshold", "1000000");

    // glibc has sines with and without fused multiplication, and their last bits differ.
    [Test]
    public void Replay_WithTheSinesOfAnOlderProcessor_IsTheSame()
    {
        if (!RuntimeInformation.IsOSPlatform(OSPlatform.Linux) || RuntimeInformation.ProcessArchitecture != System.Runtime.InteropServices.Architecture.X64)
            Assert.Ignore("only glibc on x64 has two kinds of sines");
        Replay("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4");
    }

    // Each scene by both solvers. Nine equal mechanisms fill a register of eight, and one is left over.
    private void Replay(params string[] environment)
    {
        string nine = Path.Combine(_folder, "nine.kinefab");
        File.WriteAllText(nine, Pendulums(9));
        string fixtures = Path.Combine(Dynamics.Scenario.Folder, "..", "..", "fixtures");
        foreach (string scene in new[] { nine, Path.Combine(fixtures, "lever", "lever.kinefab"), Path.Combine(fixtures, "mechanisms", "M07.kinefab") })
        {
            foreach (string solver in new[] { "unity", "exact" })
            {
                string record = Path.Combine(_folder, $"{Path.GetFileNameWithoutExtension(scene)} {solver}.kfrec");
                CommandLineTests.Run("simulate", scene, "--seconds", "2", "--solver", solver, "--record", record);

                (int exit, string output) = Tool(environment, "simulate", scene, "--replay", record);

                Assert.That((exit, output), Is.EqualTo((0, "")), $"{Path.GetFileName(record)} with {string.Join('=', environment)}");
            }
        }
    }

    private static (int Exit, string Findings) Tool(string[] environment, params string[] arguments)
    {
        var start = new ProcessStartInfo("dotnet", arguments.Prepend(typeof(Kinefab.Cli.Program).Assembly.Location)) { RedirectStandardOutput = true, RedirectStandardError = true };
        for (int i = 0; i < environment.Length; i += 2)
            start.Environment[environment[i]] = environment[i + 1];
        using Process process = Process.Start(start)!;
        System.Threading.Tasks.Task<string> output = process.StandardOutput.ReadToEndAsync();
        string findings = process.StandardError.ReadToEnd();
        process.WaitForExit();
        return (process.ExitCode, findings + (output.Result.Contains("the same as", StringComparison.Ordinal) ? "" : output.Result));
    }

    // A hinge askew, a ball below it that a spring turns about its twist, and a limit that it runs into.
    private static string Pendulums(int count)
    {
        static string Body(int i, string name, string parent, double x, string joint) => FormattableString.Invariant($$"""
            {"id": "{{name}}{{i}}", "name": "{{name}}{{i}}"{{parent}}, "transform": {"localPosition": [{{x}}, {{0.01 * i}}, 0.03]},
             "components": [{"type": "Rigidbody", "mass": {{1 + 0.1 * i}}, "centerOfMass": [0.21, 0.02, 0.01], "inertiaTensor": [0.01, 0.03, 0.02], "inertiaTensorRotation": [0, 0, 0, 1], "angularDamping": 0.05}, {{joint}}]}
            """);
        var objects = Enumerable.Range(0, count).SelectMany(i => new[]
        {
            Body(i, "arm", "", i, """{"type": "HingeJoint", "axis": [0.6, 0, 0.8], "anchor": [0, 0, 0], "useLimits": true, "limits": {"min": -70, "max": 35, "bounciness": 0.3}}"""),
            Body(i, "bob", "", i + 0.4, FormattableString.Invariant($$"""{"type": "ConfigurableJoint", "connectedBody": {{2 * i}}, "anchor": [0, 0, 0], "axis": [1, 0, 0], "xMotion": "Locked", "yMotion": "Locked", "zMotion": "Locked", "angularXMotion": "Free", "angularYMotion": "Limited", "angularZMotion": "Free", "angularYLimit": {"limit": 20}, "angularXDrive": {"positionSpring": 3, "positionDamper": 0.1} }""")),
        });
        return $$"""{"format": "kinefab.scene", "version": "1.0", "gameObjects": [{{string.Join(",\n", objects)}}]}""";
    }
}
