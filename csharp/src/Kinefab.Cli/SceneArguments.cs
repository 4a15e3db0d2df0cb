using System.CommandLine;

namespace Kinefab.Cli;

/// <summary>The arguments that several commands take.</summary>
internal static class SceneArguments
{
    internal static Argument<string> File() => new("file") { Description = "Scene file, NAME.kinefab." };

    internal static Option<bool> Json() => new("--json") { Description = "Print one JSON document on stdout." };

    internal static Option<bool> Strict() => new("--strict") { Description = "Take unknown fields for errors." };
}
