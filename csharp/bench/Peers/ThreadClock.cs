using System;
using System.Diagnostics;
using System.Runtime.InteropServices;

namespace Kinefab.Bench.Peers;

/// <summary>Processor time of the calling thread: what other programs take of the machine does not count. Wall time where there is no such clock.</summary>
internal static class ThreadClock
{
    private const int ThreadCpuTime = 3;

    private static readonly bool IsLinux = OperatingSystem.IsLinux();

    /// <summary>us since some time or other.</summary>
    public static double Microseconds =>
        IsLinux && GetTime(ThreadCpuTime, out Time time) == 0
            ? time.Seconds * 1e6 + time.Nanoseconds * 1e-3
            : Stopwatch.GetTimestamp() * 1e6 / Stopwatch.Frequency;

    [DllImport("libc", EntryPoint = "clock_gettime")]
    [DefaultDllImportSearchPaths(DllImportSearchPath.SafeDirectories)]
    private static extern int GetTime(int clock, out Time time);

    [StructLayout(LayoutKind.Sequential)]
    private struct Time
    {
        public long Seconds;
        public long Nanoseconds;
    }
}
