using System;
using System.Collections.Generic;

namespace Kinefab.Kinematics;

/// <summary>
/// The motions that rows leave, row after row: an orthonormal basis of the null space of those taken so far. A row has its lengths along
/// the motions that it touches; one Householder reflection of these puts it on one of them, which is lost. As few motions are touched as
/// the rows before have left of the freedoms nearby, so that a grid of thousands of loops costs little more than its freedoms times the
/// longest loop. Source: Golub and Van Loan, Matrix Computations, 5.1.
/// </summary>
internal sealed class RowElimination
{
    // Beside a row's length, nothing but rounding.
    private const double Rounding = 1.0 / (1L << 52);

    private readonly List<Entry>[] _byFreedom;
    private readonly List<int>?[] _byMotion;
    private readonly double[] _row;
    private readonly int[] _slots;
    private readonly List<int> _touched = new();
    private readonly int[] _seen;
    private readonly Predicate<Entry> _isReflected;
    private int _round;

    /// <summary>No rows: each freedom is a motion of its own.</summary>
    public RowElimination(int freedoms)
    {
        _byFreedom = new List<Entry>[freedoms];
        _byMotion = new List<int>[freedoms];
        _row = new double[freedoms];
        _slots = new int[freedoms];
        _seen = new int[freedoms];
        _isReflected = entry => _slots[entry.Motion] > 0;
        for (int i = 0; i < freedoms; i++)
        {
            _byFreedom[i] = new List<Entry> { new(i, 1) };
            _byMotion[i] = new List<int> { i };
        }

        Motions = freedoms;
    }

    /// <summary>Number of motions left.</summary>
    public int Motions { get; private set; }

    /// <summary>What of a row the rows taken before do not say already: the length of its part along the motions left. Takes it, if that is more than a limit.</summary>
    /// <param name="columns">For each entry its freedom.</param>
    /// <param name="entries">The row.</param>
    /// <param name="least">The limit.</param>
    public double Take(ReadOnlySpan<int> columns, ReadOnlySpan<double> entries, double least)
    {
        double length = Project(columns, entries);
        if (length > least)
        {
            Reflect(length);
        }

        Forget();
        return length;
    }

    /// <summary>A row along the motions left, in their order.</summary>
    public double[] Along(ReadOnlySpan<int> columns, ReadOnlySpan<double> entries)
    {
        Project(columns, entries);
        var row = new double[Motions];
        int next = 0;
        for (int motion = 0; motion < _byMotion.Length; motion++)
        {
            if (_byMotion[motion] is not null)
            {
                row[next++] = _row[motion];
            }
        }

        Forget();
        return row;
    }

    /// <summary>The motions left, over all freedoms.</summary>
    public List<double[]> Basis()
    {
        var place = new int[_byMotion.Length];
        var basis = new List<double[]>(Motions);
        for (int motion = 0; motion < _byMotion.Length; motion++)
        {
            if (_byMotion[motion] is not null)
            {
                place[motion] = basis.Count;
                basis.Add(new double[_byFreedom.Length]);
            }
        }

        for (int i = 0; i < _byFreedom.Length; i++)
        {
            foreach (Entry entry in _byFreedom[i])
            {
                basis[place[entry.Motion]][i] = entry.Value;
            }
        }

        return basis;
    }

    private void Forget()
    {
        foreach (int motion in _touched)
        {
            _row[motion] = 0;
        }
    }

    private double Project(ReadOnlySpan<int> columns, ReadOnlySpan<double> entries)
    {
        _touched.Clear();
        _round++;
        for (int e = 0; e < entries.Length; e++)
        {
            if (entries[e] == 0)
            {
                continue;
            }

            foreach (Entry entry in _byFreedom[columns[e]])
            {
                if (_seen[entry.Motion] != _round)
                {
                    _seen[entry.Motion] = _round;
                    _touched.Add(entry.Motion);
                }

                _row[entry.Motion] += entries[e] * entry.Value;
            }
        }

        double sum = 0;
        foreach (int motion in _touched)
        {
            sum += _row[motion] * _row[motion];
        }

        return Math.Sqrt(sum);
    }

    // H = 1 - 2 v v^T / v^T v on the motions touched, v = row +- length on the one that is lost: along the others nothing of the row is left.
    private void Reflect(double length)
    {
        var motions = new List<int>();
        int lost = _touched[0];
        foreach (int motion in _touched)
        {
            if (Math.Abs(_row[motion]) > Rounding * length)
            {
                motions.Add(motion);
                lost = Math.Abs(_row[motion]) > Math.Abs(_row[lost]) ? motion : lost;
            }
        }

        var v = new double[motions.Count];
        double squares = 0;
        for (int k = 0; k < v.Length; k++)
        {
            double entry = _row[motions[k]];
            v[k] = motions[k] != lost ? entry : entry < 0 ? entry - length : entry + length;
            squares += v[k] * v[k];
            _slots[motions[k]] = k + 1;
        }

        var entries = new double[v.Length];
        var isThere = new bool[v.Length];
        foreach (int freedom in FreedomsOf(motions))
        {
            Reflect(_byFreedom[freedom], v, 2 / squares, entries, isThere);
            for (int k = 0; k < v.Length; k++)
            {
                if (motions[k] != lost && (isThere[k] || entries[k] != 0))
                {
                    _byFreedom[freedom].Add(new Entry(motions[k], entries[k]));
                    if (!isThere[k])
                    {
                        _byMotion[motions[k]]!.Add(freedom);
                    }
                }
            }
        }

        foreach (int motion in motions)
        {
            _slots[motion] = 0;
        }

        _byMotion[lost] = null;
        Motions--;
    }

    // Takes a freedom's entries of the motions touched out of its list, reflected.
    private void Reflect(List<Entry> list, double[] v, double scale, double[] entries, bool[] isThere)
    {
        Array.Clear(entries, 0, entries.Length);
        Array.Clear(isThere, 0, isThere.Length);
        double along = 0;
        foreach (Entry entry in list)
        {
            int slot = _slots[entry.Motion] - 1;
            if (slot < 0)
            {
                continue;
            }

            entries[slot] = entry.Value;
            isThere[slot] = true;
            along += entry.Value * v[slot];
        }

        list.RemoveAll(_isReflected);
        for (int k = 0; k < v.Length; k++)
        {
            entries[k] -= scale * along * v[k];
        }
    }

    private List<int> FreedomsOf(List<int> motions)
    {
        _round++;
        var freedoms = new List<int>();
        foreach (int motion in motions)
        {
            foreach (int freedom in _byMotion[motion]!)
            {
                if (_seen[freedom] != _round)
                {
                    _seen[freedom] = _round;
                    freedoms.Add(freedom);
                }
            }
        }

        return freedoms;
    }

    private readonly struct Entry
    {
        public readonly int Motion;
        public readonly double Value;

        public Entry(int motion, double value)
        {
            Motion = motion;
            Value = value;
        }
    }
}
