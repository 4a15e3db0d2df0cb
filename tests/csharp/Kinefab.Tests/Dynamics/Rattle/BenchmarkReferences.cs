using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using Kinefab.Dynamics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>The reference motions of tests/reference/dynamics, and how far a solver is from them.</summary>
internal static class BenchmarkReferences
{
    /// <summary>The reference values of a benchmark up to a time, by time.</summary>
    private static SortedDictionary<double, Dictionary<string, double>> References(string id, double end)
    {
        var values = new SortedDictionary<double, Dictionary<string, double>>();
        foreach (string line in File.ReadLines(Path.Combine(Root(), "tests", "reference", "dynamics", "benchmarks.csv")))
        {
            string[] cells = line.Split(',');
            if (cells[0] != id)
            {
                continue;
            }

            double t = double.Parse(cells[1], CultureInfo.InvariantCulture);
            if (t > 0 && t <= end)
            {
                if (!values.TryGetValue(t, out Dictionary<string, double>? at))
                {
                    values.Add(t, at = new Dictionary<string, double>());
                }

                at[cells[2]] = double.Parse(cells[3], CultureInfo.InvariantCulture);
            }
        }

        return values;
    }

    /// <summary>Largest deviation from the reference values up to a time.</summary>
    public static double Deviation(BenchmarkMechanism benchmark, ISolver solver, double dt, double end)
    {
        double most = 0;
        int done = 0;
        foreach ((double t, Dictionary<string, double> expected) in References(benchmark.Id, end))
        {
            for (int target = (int)Math.Round(t / dt); done < target; done++)
            {
                benchmark.Drive(benchmark.MultibodySystem);
                solver.Step(dt);
            }

            foreach ((string quantity, double value) in benchmark.Read(benchmark.MultibodySystem))
            {
                double deviation = Math.Abs(value - expected[quantity]);
                most = Math.Max(most, double.IsNaN(deviation) ? double.PositiveInfinity : deviation);
            }
        }

        return most;
    }

    /// <summary>The repository's folder.</summary>
    public static string Root()
    {
        string? directory = AppContext.BaseDirectory;
        while (directory != null && !Directory.Exists(Path.Combine(directory, "tests", "reference")))
        {
            directory = Path.GetDirectoryName(directory);
        }

        return directory ?? throw new DirectoryNotFoundException("tests/reference");
    }
}
