using System;
using System.Threading;

namespace Kinefab.Reading;

/// <summary>Tells how far the reading of one text is, and ends it when it is cancelled.</summary>
internal readonly struct ReadingProgress
{
    /// <summary>Items of a list between two looks: some 50 microseconds of reading.</summary>
    internal const int ItemsBetweenLooks = 256;

    private readonly IProgress<double>? told;
    private readonly double from;
    private readonly double to;
    private readonly CancellationToken cancellation;

    /// <summary>Of a text whose reading takes a loading from one share to another.</summary>
    internal ReadingProgress(IProgress<double>? told, double from, double to, CancellationToken cancellation)
    {
        this.told = told;
        this.from = from;
        this.to = to;
        this.cancellation = cancellation;
    }

    /// <summary>At an offset of a text of this length, bytes.</summary>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    internal void Look(long offset, int length)
    {
        cancellation.ThrowIfCancellationRequested();
        told?.Report(from + (to - from) * offset / length);
    }
}
