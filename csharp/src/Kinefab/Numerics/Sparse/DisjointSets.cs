namespace Kinefab.Numerics;

/// <summary>Sets of elements that are joined one by one. Source: Galler and Fischer 1964.</summary>
internal sealed class DisjointSets
{
    private readonly int[] _parents;

    public DisjointSets(int count)
    {
        _parents = new int[count];
        for (int i = 0; i < count; i++)
        {
            _parents[i] = i;
        }
    }

    /// <summary>The member that stands for an element's set: the least.</summary>
    public int Find(int element)
    {
        while (_parents[element] != element)
        {
            _parents[element] = _parents[_parents[element]];
            element = _parents[element];
        }

        return element;
    }

    /// <summary>Makes two elements' sets one.</summary>
    public void Join(int a, int b)
    {
        a = Find(a);
        b = Find(b);
        if (a < b)
        {
            _parents[b] = a;
        }
        else
        {
            _parents[a] = b;
        }
    }
}
