using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using Kinefab.Tests.Portability;

namespace Kinefab.Mono;

/// <summary>Prints every portable run: a line with its name, then the bits of its numbers. With paths of scenes: the Unity package's run of each.</summary>
internal static class Program
{
    private static void Main(string[] paths)
    {
        using var output = new StreamWriter(Console.OpenStandardOutput());
        foreach (string path in paths)
            output.Write(Path.GetFileName(path) + '\t' + Bits(Tests.UnityPackage.PackageRun.Numbers(path)) + '\n');
        if (paths.Length > 0)
            return;
        foreach (PortableRun run in PortableRun.All)
        {
            output.Write(run.Name + '\t' + Bits(run.Numbers()) + '\n');
        }
    }

    private static string Bits(IEnumerable<double> numbers) =>
        string.Join(" ", numbers.Select(v => BitConverter.DoubleToInt64Bits(v).ToString("x16", CultureInfo.InvariantCulture)));
}
