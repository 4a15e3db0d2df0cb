using System;

namespace Kinefab.Numerics;

/// <summary>
/// Where a function falls through 0, between a place before and one after: the next place to ask, by the inverse parabola through the last
/// three where it is monotone, else the middle. Source: Chandrupatla, Advances in Engineering Software 28, 1997.
/// </summary>
internal struct RootBracket
{
    // Nearest to an end of the bracket that is asked, as a share of it.
    private const double LeastShare = 1e-9;

    private double _last;
    private double _lastValue;
    private double _other;
    private double _otherValue;
    private double _share;

    /// <param name="early">The place before.</param>
    /// <param name="earlyValue">Its value, positive.</param>
    /// <param name="late">The place after.</param>
    /// <param name="lateValue">Its value, negative.</param>
    /// <param name="guess">About where the root is, as a share of the way from the one to the other.</param>
    public RootBracket(double early, double earlyValue, double late, double lateValue, double guess)
    {
        _last = late;
        _lastValue = lateValue;
        _other = early;
        _otherValue = earlyValue;
        _share = guess >= 0 && guess <= 1 ? 1 - guess : 0.5;
    }

    /// <summary>The last place that is known to lie before the root.</summary>
    public readonly double Early => Math.Min(_last, _other);

    /// <summary>The place to ask next.</summary>
    public readonly double Next() => _last + Math.Min(1 - LeastShare, Math.Max(LeastShare, _share)) * (_other - _last);

    /// <summary>Takes what the function is there; infinite: positive, and nothing more is known.</summary>
    public void Add(double place, double value)
    {
        double positive = Math.Max(_lastValue, _otherValue);
        double known = double.IsInfinity(value) ? positive : value;
        bool isSameSide = (known > 0) == (_lastValue > 0);
        double third = isSameSide ? _last : _other;
        double thirdValue = isSameSide ? _lastValue : _otherValue;
        if (!isSameSide)
        {
            _other = _last;
            _otherValue = _lastValue;
        }

        _last = place;
        _lastValue = known;
        double x = (_last - _other) / (third - _other);
        double y = (_lastValue - _otherValue) / (thirdValue - _otherValue);
        bool isTrusted = y * y < x && (1 - y) * (1 - y) < 1 - x;
        _share = isTrusted
            ? _lastValue / (_otherValue - _lastValue) * (thirdValue / (_otherValue - thirdValue))
                + (third - _last) / (_other - _last) * (_lastValue / (thirdValue - _lastValue)) * (_otherValue / (thirdValue - _otherValue))
            : 0.5;
    }
}
