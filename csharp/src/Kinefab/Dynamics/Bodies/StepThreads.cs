using System;
using System.Runtime.ExceptionServices;
using System.Threading;

namespace Kinefab.Dynamics;

/// <summary>Work in parts that have nothing to do with each other, so that it is all the same which thread does which, and when.</summary>
internal interface IStepParts
{
    /// <summary>Does the part with an index.</summary>
    void Do(int part);
}

/// <summary>
/// Threads that help with the parts of a step. All worlds share them: they are made when first asked for and wait from then on. A world that
/// finds them helping another does its parts by itself. Nothing is allocated once the threads are there.
/// </summary>
internal static class StepThreads
{
    private static readonly object Gate = new();
    private static readonly SemaphoreSlim Wake = new(0);
    private static readonly ManualResetEventSlim AllDone = new();
    private static int _made;
    private static IStepParts? _work;
    private static int _count;
    private static int _next;
    private static int _helping;
    private static Exception? _failure;

    /// <summary>Does all parts, the caller's thread among those that do, and returns when the last is done.</summary>
    /// <param name="work">The parts.</param>
    /// <param name="count">How many.</param>
    /// <param name="threads">How many threads at most.</param>
    public static void ForEach(IStepParts work, int count, int threads)
    {
        int helpers = Math.Min(threads, count) - 1;
        if (helpers < 1 || !Monitor.TryEnter(Gate))
        {
            for (int part = 0; part < count; part++)
            {
                work.Do(part);
            }

            return;
        }

        try
        {
            for (; _made < helpers; _made++)
            {
                new Thread(Help) { IsBackground = true, Name = "Kinefab step" }.Start();
            }

            _work = work;
            _count = count;
            _next = 0;
            _helping = helpers;
            AllDone.Reset();
            Wake.Release(helpers);
            DoParts(work);
            AllDone.Wait();
            _work = null;
            Exception? failure = _failure;
            _failure = null;
            if (failure != null)
            {
                ExceptionDispatchInfo.Capture(failure).Throw();
            }
        }
        finally
        {
            Monitor.Exit(Gate);
        }
    }

    private static void Help()
    {
        while (true)
        {
            Wake.Wait();
            DoParts(_work!);
            if (Interlocked.Decrement(ref _helping) == 0)
            {
                AllDone.Set();
            }
        }
    }

    private static void DoParts(IStepParts work)
    {
        int part;
        while ((part = Interlocked.Increment(ref _next) - 1) < _count)
        {
            try
            {
                work.Do(part);
            }
            catch (Exception failure)
            {
                // The caller's to throw, when all are done.
                Interlocked.CompareExchange(ref _failure, failure, null);
            }
        }
    }
}
