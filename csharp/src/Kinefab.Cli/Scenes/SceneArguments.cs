using System.Collections.Generic;
using System.CommandLine;
using System.CommandLine.Parsing;
using System.Linq;
using Kinefab.Cli.Commands;

namespace Kinefab.Cli;

/// <summary>The arguments that all commands take, and those that several do.</summary>
internal sealed class SceneArguments
{
    private readonly Argument<string[]> _files = new("files")
    {
        Description = "Scene files, NAME.kinefab; patterns with *, ? and ** stand for files, - for standard input, whose buffers lie in the current folder.",
        Arity = ArgumentArity.OneOrMore,
    };

    private readonly Option<bool> _json = new("--json") { Description = "Print one JSON document on stdout: an object, or of several files an array." };

    private readonly Option<string?> _junit = TypedOptions.File("--junit", "Write the outcome of each file into a JUnit report, .xml.");

    /// <summary>What is mistyped for an option is no file.</summary>
    internal SceneArguments() => _files.Validators.Add(result =>
    {
        if (result.Tokens.Any(token => token.Value.Length == 0))
            result.AddError("A scene file's name is empty.");
        foreach (string name in result.Tokens.Select(token => token.Value).Where(name => name.Length > 1 && name[0] == '-'))
            result.AddError($"Unrecognized option '{name}'.{NearWords.Among(name, Options(result))} A file of this name is given as ./{name}.");
    });

    private static IEnumerable<string> Options(ArgumentResult files) => ((CommandResult)files.Parent!).Command.Options.Select(option => option.Name);

    /// <summary>Adds them to a command, the files first.</summary>
    internal void AddTo(Command command)
    {
        command.Arguments.Add(_files);
        command.Options.Add(_json);
        command.Options.Add(_junit);
    }

    /// <summary>What was asked for.</summary>
    internal SceneBatch Of(ParseResult parsed) =>
        new(parsed.CommandResult.Command.Name, ScenePatterns.Expand(parsed.GetRequiredValue(_files)), parsed.GetValue(_json), parsed.GetValue(_junit));

    internal static Option<bool> Strict() => new("--strict") { Description = "Take unknown fields for errors." };
}
