using System;
using System.IO;
using Kinefab.Cli.Simulation;
using NUnit.Framework;

namespace Kinefab.Tests.Cli;

public sealed class ProgressTests
{
    [Test]
    public void Report_OncePerSecond_RenewsOneLine()
    {
        var clock = new Clock();
        using var target = new StringWriter { NewLine = "\n" };
        var progress = new Progress(1000, target, clock);

        for (int i = 1; i <= 1000; i++)
        {
            clock.Milliseconds += 4;
            progress.Report(i);
        }

        progress.End();
        Assert.That(target.ToString(), Is.EqualTo("\r 25 % of 1000 steps\r 50 % of 1000 steps\r 75 % of 1000 steps\r100 % of 1000 steps\n"));
    }

    [Test]
    public void Report_RunShorterThanASecond_IsSilent()
    {
        var clock = new Clock();
        using var target = new StringWriter();
        var progress = new Progress(10, target, clock);
        clock.Milliseconds = 999;
        progress.Report(10);
        progress.End();
        Assert.That(target.ToString(), Is.Empty);
    }

    private sealed class Clock : TimeProvider
    {
        public long Milliseconds { get; set; }

        public override long TimestampFrequency => 1000;

        public override long GetTimestamp() => Milliseconds;
    }
}
