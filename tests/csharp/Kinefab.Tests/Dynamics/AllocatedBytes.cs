using System;

namespace Kinefab.Tests.Dynamics;

/// <summary>What a run allocates on its thread.</summary>
internal static class AllocatedBytes
{
    private const int Runs = 3;

    /// <summary>The least of a few runs: where another thread collects garbage amid one, the runtime counts what was left of the thread's last 8 KB as allocated.</summary>
    public static long LeastOf(Action run)
    {
        long least = long.MaxValue;
        for (int i = 0; i < Runs; i++)
        {
            long before = GC.GetAllocatedBytesForCurrentThread();
            run();
            least = Math.Min(least, GC.GetAllocatedBytesForCurrentThread() - before);
        }

        return least;
    }
}
