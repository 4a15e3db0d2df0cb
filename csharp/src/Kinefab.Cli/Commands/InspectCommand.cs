using System.CommandLine;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab inspect FILE [--json].</summary>
internal static class InspectCommand
{
    internal static Command Create()
    {
        Argument<string> file = SceneArguments.File();
        Option<bool> json = SceneArguments.Json();
        var command = new Command("inspect", "Say what is in a scene and what became of the source's features.") { file, json };
        command.SetAction(_ => 0);
        return command;
    }
}
