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

    // What both languages' fillers take alike: names in braces, and braces doubled.
    [Test]
    public void Table_Templates_HoldOnlyNamesInBracesAndBracesDoubled() =>
        Assert.That(
            DiagnosticTable.Entries.Values.SelectMany(entry => new[] { entry.Message, entry.Remedy }),
            Is.All.Match(@"^([^{}]|\{\{|\}\}|\{[A-Za-z_]+\})*$"));

    [TestCase("{a} of {b}, {a}", "3 of {x}, 3")]
    [TestCase("Begin with {{\"meta\": ...}}.", "Begin with {\"meta\": ...}.")]
    [TestCase("{{a}} is {a}", "{a} is 3")]
    [TestCase("{c} { } {", "{c} { } {")]
    public void Fill_Template_PutsValuesAndBracesIn(string template, string text) =>
        Assert.That(DiagnosticTable.Fill(template, [("a", "3"), ("b", "{x}")]), Is.EqualTo(text));

    [Test]
    public void Fill_ValueLikeAPlaceholderOfTheTemplate_StaysAsItIs() =>
        Assert.That(DiagnosticTable.Fill("{id} and {first}", [("id", "{first}{{"), ("first", "{id}")]), Is.EqualTo("{first}{{ and {id}"));
}
