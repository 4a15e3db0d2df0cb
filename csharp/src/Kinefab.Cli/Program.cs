using System;
using System.CommandLine;
using System.IO;
using System.Linq;
using Kinefab.Cli.Commands;

namespace Kinefab.Cli;

/// <summary>dotnet kinefab: exit 0 ok, 1 errors found, 2 wrong usage, 3 what it printed could not be written; of several files the greatest.</summary>
internal static class Program
{
    private const int OutputLost = 3;

    internal static int Main(string[] args)
    {
        (TextWriter data, TextWriter findings) = (Console.Out, Console.Error);
        var terminal = new Terminal(data);
        try
        {
            Console.SetOut(terminal);
            Console.SetError(new Terminal(findings));
            int exit = Run(args);
            if (terminal.Fault is null)
                return exit;
            Console.Error.WriteLine($"The output could not be written: {terminal.Fault.Message}");
            return OutputLost;
        }
        finally
        {
            Console.SetOut(data);
            Console.SetError(findings);
        }
    }

    private static int Run(string[] args)
    {
        ParseResult parsed = Commands().Parse(args);
        if (parsed.Errors.Count == 0)
            return parsed.Invoke(new InvocationConfiguration { Output = Console.Out, Error = Console.Error });
        Command command = parsed.CommandResult.Command;
        if (command is RootCommand)
        {
            // Not one sentence for each argument behind a mistyped command.
            Console.Error.WriteLine(Printable.Text(parsed.UnmatchedTokens is [string first, ..]
                ? $"There is no command '{first}'.{NearWords.Among(first, command.Subcommands.Select(one => one.Name))}"
                : "A command is missing."));
            return WrongUsage.Refuse("Run 'dotnet kinefab --help' for the commands.");
        }

        foreach (var error in parsed.Errors)
            Console.Error.WriteLine(Printable.Text(error.Message));
        return WrongUsage.Refuse($"Run 'dotnet kinefab {command.Name} --help' for its arguments and options.");
    }

    /// <summary>Every command that there is.</summary>
    internal static RootCommand Commands() =>
        new("Validates, inspects, simulates and sweeps Kinefab scenes, counts their mobility and advises on stability. Exit status: 0 ok, 1 errors found, 2 wrong usage, 3 what it printed could not be written; of several files the greatest.")
        {
            ValidateCommand.Create(),
            InspectCommand.Create(),
            SimulateCommand.Create(),
            SweepCommand.Create(),
            MobilityCommand.Create(),
            AdviseCommand.Create(),
        };
}
