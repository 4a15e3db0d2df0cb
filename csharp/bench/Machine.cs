using System;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;
using System.Runtime.Intrinsics.X86;

namespace Kinefab.Bench;

/// <summary>What the figures of a table were measured on.</summary>
internal static class Machine
{
    /// <summary>Processor, cores, instructions and runtime in one line.</summary>
    public static string Description
    {
        get
        {
            string vectors = Avx512F.IsSupported ? "AVX-512" : Avx2.IsSupported ? "AVX2" : "no AVX2";
            return $"{Processor()}, {Environment.ProcessorCount} cores, {vectors}, {RuntimeInformation.FrameworkDescription}";
        }
    }

    private static string Processor()
    {
        const string Info = "/proc/cpuinfo";
        string? line = File.Exists(Info) ? File.ReadLines(Info).FirstOrDefault(l => l.StartsWith("model name", StringComparison.Ordinal)) : null;
        return line == null ? RuntimeInformation.OSArchitecture.ToString() : line[(line.IndexOf(':', StringComparison.Ordinal) + 1)..].Trim();
    }
}
