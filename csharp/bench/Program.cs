using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Bench.Peers;

namespace Kinefab.Bench;

/// <summary>dotnet run -c Release --project csharp/bench -- drive|load|start|mobility|solver|articulation|hub|package|threads|rows|peers|all [--write]</summary>
internal static class Program
{
    private static readonly Dictionary<string, Func<string>> Benchmarks = new()
    {
        ["drive"] = Tables.Drive,
        ["load"] = Tables.Load,
        ["start"] = Tables.Start,
        ["mobility"] = Tables.Mobility,
        ["solver"] = Tables.Solver,
        ["articulation"] = Tables.Articulation,
        ["hub"] = Tables.Hub,
        ["package"] = Tables.Package,
        ["threads"] = Tables.Threads,
        ["rows"] = Tables.Rows,
        ["peers"] = Tables.Peers,
    };

    // Their tables are half empty without the other engines, and the README tells what they say of these.
    private static readonly string[] NeedPeers = ["peers", "articulation", "all"];

    private static int Main(string[] args)
    {
        bool writes = args.Contains("--write");
        string[] names = args.Where(a => a != "--write").ToArray();
        if (names.Length != 1 || (names[0] != "all" && !Benchmarks.ContainsKey(names[0])))
        {
            Console.Error.WriteLine($"Name a benchmark: {string.Join(", ", Benchmarks.Keys)}, all; --write puts its table into RESULTS.md");
            return 2;
        }

        string[] missing = PeerList.Missing().ToArray();
        if (writes && missing.Length > 0 && NeedPeers.Contains(names[0]))
        {
            Console.Error.WriteLine($"RESULTS.md is left as it is: {string.Join(", ", missing)} not found. Build the engines (csharp/bench/Peers/build.sh says how), or leave --write out.");
            return 2;
        }

        foreach ((string name, Func<string> run) in Benchmarks.Where(b => names[0] == "all" || names[0] == b.Key))
        {
            string table = run();
            Console.WriteLine(table);
            if (writes)
                Results.Write(name, table);
        }

        return 0;
    }
}
