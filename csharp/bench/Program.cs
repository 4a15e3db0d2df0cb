using System;

namespace Kinefab.Bench;

/// <summary>dotnet run -c Release --project csharp/bench -- load | drive | solver</summary>
internal static class Program
{
    private static int Main(string[] args)
    {
        switch (args.Length == 0 ? "" : args[0])
        {
            case "load":
                LoadBench.Run();
                return 0;
            case "drive":
                DriveBench.Run();
                return 0;
            case "solver":
                SolverBenchmark.Run();
                return 0;
            default:
                Console.Error.WriteLine("Name a benchmark: load, drive, solver");
                return 2;
        }
    }
}
