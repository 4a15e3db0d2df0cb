using System;
using System.Diagnostics;
using System.IO;
using System.IO.Pipes;
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

    // As root a rename would put a file into the place of /dev/null for everybody. A link stands for /dev/stdout.
    [TestCase(false)]
    [TestCase(true)]
    [Platform("Unix")]
    public void Write_Pipe_WritesIntoItAndKeepsIt(bool isLinked)
    {
        string pipe = Path.Combine(_folder, "pipe"), path = isLinked ? Path.Combine(_folder, "link") : pipe;
        using (var made = Process.Start("mkfifo", [pipe]))
            made.WaitForExit();
        if (isLinked)
            File.CreateSymbolicLink(path, pipe);

        Assert.That(TargetFile.Check(path).HasErrors, Is.False);
        using Process reader = Process.Start(new ProcessStartInfo("cat", [pipe]) { RedirectStandardOutput = true })!;
        Assert.That(TargetFile.Write(path, target => target.Write("new"u8)).HasErrors, Is.False);
        bool isRead = reader.WaitForExit(10_000);
        if (!isRead)
            reader.Kill();

        Assert.That(isRead, Is.True);
        Assert.That(reader.StandardOutput.ReadToEnd(), Is.EqualTo("new"));
        Assert.That(new FileInfo(pipe).Length, Is.EqualTo(0));
    }

    [Test]
    public void Write_LinkToAPipeWithoutAName_WritesIntoIt()
    {
        if (!OperatingSystem.IsLinux())
            Assert.Ignore("where other systems keep open files is no link");
        using var server = new AnonymousPipeServerStream(PipeDirection.In);
        string path = $"/proc/self/fd/{server.ClientSafePipeHandle.DangerousGetHandle()}";

        Assert.That(TargetFile.Check(path).HasErrors, Is.False);
        Assert.That(TargetFile.Write(path, target => target.Write("new"u8)).HasErrors, Is.False);

        var read = new byte[3];
        server.ReadExactly(read);
        Assert.That(read, Is.EqualTo("new"u8.ToArray()));
    }

    [Test]
    public void Write_EmptyFile_IsReplaced()
    {
        string path = Path.Combine(_folder, "motion.json");
        File.WriteAllText(path, "");
        Assert.That(TargetFile.Write(path, target => target.Write("new"u8)).HasErrors, Is.False);
        Assert.That(File.ReadAllText(path), Is.EqualTo("new"));
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
