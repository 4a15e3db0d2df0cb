using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Tests.Conformance;
using NUnit.Framework;

namespace Kinefab.Tests.Diagnostics;

public class DiagnosticCodesTests
{
    private static readonly string[] OwnStages = ["structure", "value", "limit"];

    [Test]
    public void Constants_AgainstTheTable_AreAllInIt() =>
        Assert.That(OwnCodes.All, Is.Unique.And.SubsetOf(DiagnosticTable.Entries.Keys));

    [Test]
    public void Table_StagesOfTheReader_AreAllConstants()
    {
        var codes = DiagnosticTable.Entries.Where(entry => OwnStages.Contains(entry.Value.Stage)).Select(entry => entry.Key);
        Assert.That(codes, Is.SubsetOf(OwnCodes.All));
    }

    [Test]
    public void Fill_TwoPlaceholders_PutsBothValuesIn() =>
        Assert.That(DiagnosticTable.Fill("{a} of {b}, {a}", [("a", "3"), ("b", "{x}")]), Is.EqualTo("3 of {x}, 3"));
}
