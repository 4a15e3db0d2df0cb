using System;
using System.Collections.Generic;

namespace Kinefab.Dynamics;

/// <summary>
/// Takes down a state and plays it back: whoever has a part of the state passes it, always in the same order, and the tape copies
/// it out or in. So nothing can be saved that is not restored.
/// </summary>
internal sealed class StateTape
{
    private readonly List<object?> _parts = new();
    private int _next;

    /// <summary>Whether the parts passed are overwritten with what was taken down.</summary>
    public bool IsPlaying { get; private set; }

    /// <summary>From now on the parts are overwritten, from the first one on.</summary>
    public void Play()
    {
        IsPlaying = true;
        _next = 0;
    }

    /// <summary>All numbers of an array that keeps its length.</summary>
    public void Array<T>(T[] part)
    {
        if (IsPlaying)
            ((T[])_parts[_next++]!).CopyTo(part, 0);
        else
            _parts.Add((T[])part.Clone());
    }

    /// <summary>The numbers of one lane of an array that keeps its length: number i of it stands at i * width + lane.</summary>
    public void Lane<T>(T[] part, int lane, int width)
    {
        T[] taken = IsPlaying ? (T[])_parts[_next++]! : new T[part.Length / width];
        for (int i = 0; i < taken.Length; i++)
        {
            if (IsPlaying)
                part[i * width + lane] = taken[i];
            else
                taken[i] = part[i * width + lane];
        }

        if (!IsPlaying)
            _parts.Add(taken);
    }

    /// <summary>A value, or a reference to what never changes.</summary>
    public void Value<T>(ref T part)
    {
        if (IsPlaying)
            part = (T)_parts[_next++]!;
        else
            _parts.Add(part);
    }
}
