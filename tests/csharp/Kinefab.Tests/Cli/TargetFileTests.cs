using System.IO;
using System.Linq;
using System.Text;
using Kinefab.Cli.Motion;
using Kinefab.Diagnostics;
using NUnit.Framework;

namespace Kinefab.Tests.Cli;

public sealed class TargetFileTests
{
    private string _folder = "";

    [SetUp]
    public void MakeFolder() => _folder = Directory.CreateTempSubdirectory("kinefab").FullName;

    [TearDown]
    public void RemoveFolder() => Directory.Delete(_folder, recursive: true);

    [Test]
    public void Write_ContentThatFails_KeepsTheOldFileAndNoPart()
    {
        string path = Path.Combine(_folder, "motion.csv");
        File.WriteAllText(path, "old");

        Report report = TargetFile.Write(path, target =>
        {
            target.Write(Encoding.UTF8.GetBytes("half"));
            throw new IOException($"No space left on device : '{((FileStream)target).Name}'.");
        });

        Diagnostic found = report.Diagnostics.Single();
        Assert.That((found.Code, found.Message), Is.EqualTo(("TARGET_UNWRITABLE", $"{path} cannot be written: No space left on device : '{path}'.")));
        Assert.That(found.Remedy, Is.Not.Empty);
        Assert.That(File.ReadAllText(path), Is.EqualTo("old"));
        Assert.That(Directory.GetFiles(_folder), Is.EqualTo(new[] { path }));
    }

    [Test]
    public void Check_WritableTarget_LeavesItAsItWas()
    {
        string path = Path.Combine(_folder, "motion.csv");
        Assert.That(TargetFile.Check(path).HasErrors, Is.False);
        Assert.That(Directory.GetFiles(_folder), Is.Empty);
        File.WriteAllText(path, "old");
        Assert.That(TargetFile.Check(path).HasErrors, Is.False);
        Assert.That(File.ReadAllText(path), Is.EqualTo("old"));
    }

    [Test]
    public void Write_FilesOfTheUsersBeside_StayAsTheyWere()
    {
        string path = Path.Combine(_folder, "motion.json"), other = path + ".part";
        File.WriteAllText(other, "mine");

        Assert.That(TargetFile.Check(path).HasErrors, Is.False);
        Assert.That(TargetFile.Write(path, target => target.Write("new"u8)).HasErrors, Is.False);

        Assert.That((File.ReadAllText(path), File.ReadAllText(other)), Is.EqualTo(("new", "mine")));
        Assert.That(Directory.GetFiles(_folder), Is.EquivalentTo(new[] { path, other }));
    }

    [TestCase("old")]
    [TestCase(null)]
    public void Write_Link_WritesWhereItLeadsAndKeepsIt(string? content)
    {
        string path = Path.Combine(_folder, "motion.json"), folder = Path.Combine(_folder, "runs"), led = Path.Combine(folder, "run 1.json");
        Directory.CreateDirectory(folder);
        if (content is not null)
            File.WriteAllText(led, content);
        File.CreateSymbolicLink(path, Path.Combine("runs", "run 1.json"));

        Assert.That(TargetFile.Write(path, target => target.Write("new"u8)).HasErrors, Is.False);

        Assert.That(new FileInfo(path).LinkTarget, Is.EqualTo(Path.Combine("runs", "run 1.json")));
        Assert.That((File.ReadAllText(path), File.ReadAllText(led)), Is.EqualTo(("new", "new")));
        Assert.That(Directory.GetFileSystemEntries(_folder, "*", SearchOption.AllDirectories), Is.EquivalentTo(new[] { path, folder, led }));
    }

    [Test]
    public void Write_LinkToItself_IsADiagnostic()
    {
        string path = Path.Combine(_folder, "motion.json");
        File.CreateSymbolicLink(path, path);

        Assert.That(TargetFile.Write(path, _ => { }).Diagnostics.Single().Code, Is.EqualTo("TARGET_UNWRITABLE"));
        Assert.That(Directory.GetFileSystemEntries(_folder), Is.EqualTo(new[] { path }));
    }
}
