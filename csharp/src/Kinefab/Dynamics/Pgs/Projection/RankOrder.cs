using System;

namespace Kinefab.Dynamics.Pgs;

/// <summary>
/// Sorts by rank, the highest first. Equals end up in the order in which PhysX's own quicksort leaves them, and that order decides
/// which of two bodies projects the other. Source: PsSort.h, PsSortInternals.h.
/// </summary>
internal sealed class RankOrder
{
    // Ranges shorter than this are sorted by selection.
    private const int SmallSort = 6;

    private readonly long[] _ranks;

    /// <param name="ranks">Rank of each element.</param>
    public RankOrder(long[] ranks) => _ranks = ranks;

    public void Sort(Span<int> elements)
    {
        while (elements.Length >= SmallSort)
        {
            int pivot = Partition(elements);
            Span<int> before = elements[..pivot];
            Span<int> after = elements[(pivot + 1)..];
            bool isBeforeShorter = before.Length < after.Length;
            Sort(isBeforeShorter ? before : after);
            elements = isBeforeShorter ? after : before;
        }

        for (int i = 0; i < elements.Length - 1; i++)
        {
            int best = i;
            for (int j = i + 1; j < elements.Length; j++)
            {
                best = Precedes(elements[j], elements[best]) ? j : best;
            }

            Swap(elements, i, best);
        }
    }

    // The median of the first, the middle and the last is the pivot, kept last but one while the scans meet.
    private int Partition(Span<int> elements)
    {
        int last = elements.Length - 1;
        int middle = last / 2;
        SwapIf(elements, 0, middle);
        SwapIf(elements, 0, last);
        SwapIf(elements, middle, last);
        Swap(elements, middle, last - 1);
        int pivot = elements[last - 1];
        int i = 0;
        int j = last - 1;
        while (true)
        {
            do
            {
                i++;
            }
            while (Precedes(elements[i], pivot));

            do
            {
                j--;
            }
            while (Precedes(pivot, elements[j]));

            if (i >= j)
            {
                break;
            }

            Swap(elements, i, j);
        }

        Swap(elements, i, last - 1);
        return i;
    }

    private void SwapIf(Span<int> elements, int low, int high)
    {
        if (Precedes(elements[high], elements[low]))
        {
            Swap(elements, low, high);
        }
    }

    private bool Precedes(int a, int b) => _ranks[a] > _ranks[b];

    private static void Swap(Span<int> elements, int a, int b) => (elements[a], elements[b]) = (elements[b], elements[a]);
}
