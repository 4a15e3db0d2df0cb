using System.Globalization;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

public sealed class UnitySolverTests
{
    [Test]
    public void Table()
    {
        foreach (Scenario s in Scenario.All)
        {
            PhysXComparison c = PhysXComparison.Run(s);
            TestContext.Out.WriteLine(string.Format(CultureInfo.InvariantCulture, "{0,-36} {1:0.0e+0} {2:0.0e+0} range {3:0.00} {4}|{5}", s.Name, c.Position, c.Angle, c.Range, string.Join(",", c.Broken), string.Join(",", s.Broken)));
        }
    }
}
