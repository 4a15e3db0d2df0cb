using System;
using System.CommandLine;
using Kinefab.Cli.Commands;

namespace Kinefab.Cli;

/// <summary>dotnet kinefab: exit 0 ok, 1 errors found, 2 wrong usage.</summary>
internal static class Program
{
    internal static int Main(string[] args)
    {
        ParseResult parsed = Commands().Parse(args);
        if (parsed.Errors.Count == 0)
            return parsed.Invoke();
        foreach (var error in parsed.Errors)
            Console.Error.WriteLine(error.Message);
        return WrongUsage.Refuse("Run 'dotnet kinefab --help' for the commands and their options.");
    }

    /// <summary>Every command that there is.</summary>
    internal static RootCommand Commands() =>
        new("Validates, inspects, simulates and sweeps Kinefab scenes, counts their mobility and advises on stability.")
        {
            ValidateCommand.Create(),
            InspectCommand.Create(),
            SimulateCommand.Create(),
            SweepCommand.Create(),
            MobilityCommand.Create(),
            AdviseCommand.Create(),
        };
}
