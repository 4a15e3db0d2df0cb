using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

public sealed class PgsSolverPhysXTests
{
    // Metres and radians. PhysX reckons in single precision, so even equal formulas part by about 1e-6 in two seconds.
    private const double Tolerance = 1e-4;

    private const string Document = "tests/reference/COMPARISON.md";

    [TestCaseSource(typeof(Scenario), nameof(Scenario.Names))]
    public void Step_Scenario_FollowsPhysX(string name)
    {
        Scenario scenario = Scenario.All.Single(s => s.Name == name);
        PhysXComparison difference = PhysXComparison.Run(scenario);

        using (Assert.EnterMultipleScope())
        {
            Assert.That(difference.Position, Is.LessThanOrEqualTo(Tolerance), "metres");
            Assert.That(difference.Angle, Is.LessThanOrEqualTo(Tolerance), "radians");
            Assert.That(difference.Broken, Has.Count.EqualTo(scenario.Broken.Length), "joints broken");
            Assert.That(difference.Broken.Zip(scenario.Broken, (a, b) => Math.Abs(a - b)), Is.All.LessThanOrEqualTo(1), "steps");
        }
    }

    [Test]
    public void Scenarios_Range_EveryBodyMovesFurtherThanTheTolerance()
    {
        string[] still = Scenario.All.Where(s => PhysXComparison.Run(s) is { Range: < 10 * Tolerance, Turn: < 10 * Tolerance }).Select(s => s.Name).ToArray();

        Assert.That(still, Is.Empty);
    }

    [Test]
    public void Document_Table_NamesEveryScenario()
    {
        string path = Path.Combine(Scenario.Folder, "..", "..", Document);
        if (Environment.GetEnvironmentVariable("KINEFAB_WRITE_TABLES") == "1")
            File.WriteAllText(path, Table());

        string[] rows = File.ReadAllLines(path).Where(l => l.StartsWith("| `", StringComparison.Ordinal)).ToArray();

        Assert.That(rows.Select(r => r.Split('`')[1]), Is.EqualTo(Scenario.All.Select(s => s.Name)));
    }

    private static string Table()
    {
        var text = new StringBuilder();
        text.Append("# The `unity` solver against PhysX 4.1.2\n\n");
        text.Append("Generated: `KINEFAB_WRITE_TABLES=1 dotnet test csharp/Kinefab.slnx --filter Name=Document_Table_NamesEveryScenario`.\n");
        text.Append("Largest difference of any body's centre of mass and rotation from PhysX's, over 100 steps (mechanisms 50) of\n");
        text.Append("0.02 s. The test fails above 1e-4 m or 1e-4 rad. PhysX reckons in float32, this solver in double. How the traces\n");
        text.Append("are made: [README](README.md).\n\n");
        text.Append("| scenario | what | m | rad |\n|---|---|---|---|\n");
        foreach (Scenario s in Scenario.All)
        {
            PhysXComparison d = PhysXComparison.Run(s);
            text.Append(CultureInfo.InvariantCulture, $"| `{s.Name}` | {s.About} | {d.Position:0.0e-0} | {d.Angle:0.0e-0} |\n");
        }

        return text.ToString();
    }
}
