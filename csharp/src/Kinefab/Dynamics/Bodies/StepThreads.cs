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
/// finds them helping another does its parts by itself. Nothing is allocated once the threads are there. Each thread begins with the parts
/// that it had in the step before, whose numbers are in its processor's cache, and then takes what others have not come to.
/// </summary>
internal static class StepThreads
{
    // Numbers that several threads write stand a line of memory apart.
    private const int Apart = 16;

    private static readonly object Gate = new();

    // Not a ManualResetEventSlim, which allocates when it first has to wait for long.
    private static readonly SemaphoreSlim AllDone = new(0);
    private static SemaphoreSlim[] _wake = Array.Empty<SemaphoreSlim>();

    // Of each thread, the caller first, the part of its share that is next.
    private static int[] _next = new int[Apart];
    private static IStepParts? _work;
    private static int _count;
    private static int _threads;
    private static int _helping;
    private static Exception? _failure;

    /// <summary>Does all parts, the caller's thread among those that do, and returns when the last is done.</summary>
    /// <param name="work">The parts.</param>
    /// <param name="count">How many.</param>
    /// <param name="threads">How many threads at most.</param>
    public static void ForEach(IStepParts work, int count, int threads)
    {
        int helpers = Math.Min(threads, count) - 1;
        // A part that comes here again on the caller's thread would be let in, and take the numbers of the parts around it.
        if (helpers < 1 || Monitor.IsEntered(Gate) || !Monitor.TryEnter(Gate))
        {
            for (int part = 0; part < count; part++)
            {
                work.Do(part);
            }

            return;
        }

        try
        {
            Hire(helpers);
            _work = work;
            _count = count;
            _threads = helpers + 1;
            for (int thread = 0; thread < _threads; thread++)
            {
                _next[thread * Apart] = First(thread);
            }

            _helping = helpers;
            for (int helper = 0; helper < helpers; helper++)
            {
                _wake[helper].Release();
            }

            DoParts(work, 0);
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

    private static void Hire(int helpers)
    {
        int made = _wake.Length;
        if (made >= helpers)
        {
            return;
        }

        Array.Resize(ref _wake, helpers);
        Array.Resize(ref _next, (helpers + 1) * Apart);
        for (int helper = made; helper < helpers; helper++)
        {
            var wake = new SemaphoreSlim(0);
            int thread = helper + 1;
            _wake[helper] = wake;
            new Thread(() => Help(wake, thread)) { IsBackground = true, Name = "Kinefab step" }.Start();
        }
    }

    private static void Help(SemaphoreSlim wake, int thread)
    {
        while (true)
        {
            wake.Wait();
            DoParts(_work!, thread);
            if (Interlocked.Decrement(ref _helping) == 0)
            {
                AllDone.Release();
            }
        }
    }

    // The first part of a thread's share.
    private static int First(int thread) => (int)((long)thread * _count / _threads);

    private static void DoParts(IStepParts work, int thread)
    {
        for (int i = 0; i < _threads; i++)
        {
            int share = (thread + i) % _threads;
            int end = First(share + 1);
            int part;
            while ((part = Interlocked.Increment(ref _next[share * Apart]) - 1) < end)
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
}
