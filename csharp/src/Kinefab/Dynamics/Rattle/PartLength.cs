using System;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// How long the next part of a step is: halved where one fails, and the next two as one again after parts that were taken, since what is hard in one place
/// is not so after it.
/// </summary>
internal struct PartLength
{
    /// <summary>Halvings of the shortest part: a scene that 64 times shorter steps can follow is not stopped.</summary>
    public const int MaxHalvings = 18;

    private const int Whole = 1 << MaxHalvings;

    // Parts that are taken, at most, before two are one again, where they were one too early before.
    private const int MostPatience = 16;

    private readonly int _least;

    // Of the step, in its shortest parts.
    private int _done;
    private int _taken;
    private int _patience;
    private bool _isJoined;

    /// <param name="least">Halvings of the step's longest parts.</param>
    /// <param name="halvings">Of its first.</param>
    public PartLength(int least, int halvings)
    {
        _least = least;
        _done = 0;
        _taken = 0;
        _patience = 1;
        _isJoined = false;
        Halvings = halvings;
        Fewest = MaxHalvings;
    }

    /// <summary>Halvings of the next part.</summary>
    public int Halvings { get; private set; }

    /// <summary>The fewest halvings of a part that was taken.</summary>
    public int Fewest { get; private set; }

    /// <summary>Whether the next part is the step's first.</summary>
    public readonly bool IsFirst => _done == 0;

    /// <summary>Whether the step is done.</summary>
    public readonly bool IsDone => _done == Whole;

    /// <summary>The part failed, and half of it comes next.</summary>
    public void Halve()
    {
        // Two that were one too early are one again after twice as many parts.
        _patience = _isJoined ? Math.Min(2 * _patience, MostPatience) : _patience;
        _isJoined = false;
        _taken = 0;
        Halvings++;
    }

    /// <summary>The next part has no more halvings than these, but for those that its place in the step asks for, and grows again after each that is taken.</summary>
    public void Lengthen(int halvings)
    {
        _patience = 1;
        Halvings = Math.Min(Halvings, halvings);
        while (_done % (Whole >> Halvings) != 0)
        {
            Halvings++;
        }
    }

    /// <summary>The part was taken.</summary>
    /// <param name="mayGrow">Whether nothing in it speaks against a longer one.</param>
    public void Take(bool mayGrow)
    {
        _done += Whole >> Halvings;
        Fewest = Math.Min(Fewest, Halvings);
        _patience = _isJoined ? Math.Max(1, _patience / 2) : _patience;
        _isJoined = ++_taken >= _patience && mayGrow && Halvings > _least && !IsDone && _done % (Whole >> (Halvings - 1)) == 0;
        if (_isJoined)
        {
            Halvings--;
            _taken = 0;
        }
    }
}
