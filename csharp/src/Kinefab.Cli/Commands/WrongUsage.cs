using System;

namespace Kinefab.Cli.Commands;

/// <summary>A call that says what cannot be done, as opposed to data that is wrong.</summary>
internal static class WrongUsage
{
    internal const int ExitCode = 2;

    /// <summary>Says why on stderr and returns the exit code.</summary>
    internal static int Refuse(string reason)
    {
        Console.Error.WriteLine(Printable.Text(reason));
        return ExitCode;
    }
}
