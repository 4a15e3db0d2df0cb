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
            throw new IOException($"No space left on device : '{path}.part'.");
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
}
