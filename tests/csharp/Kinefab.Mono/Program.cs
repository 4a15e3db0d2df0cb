using System;
using System.Globalization;
using System.IO;
using System.Linq;
using Kinefab.Tests.Portability;

namespace Kinefab.Mono;

/// <summary>Prints every portable run: a line with its name, then the bits of its numbers.</summary>
internal static class Program
{
    private static void Main()
    {
        using var output = new StreamWriter(Console.OpenStandardOutput());
        foreach (PortableRun run in PortableRun.All)
        {
            string numbers = string.Join(" ", run.Numbers().Select(v => BitConverter.DoubleToInt64Bits(v).ToString("x16", CultureInfo.InvariantCulture)));
            output.Write(run.Name + '\t' + numbers + '\n');
        }
    }
}
