namespace Kinefab.Numerics;

/// <summary>
/// Numbers that look random, each from its place alone, the same on every machine. Source: Steele, Lea and Flood 2014, SplitMix.
/// </summary>
internal static class SplitMix
{
    private const double Last = 1.0 / (1UL << 53);

    /// <summary>All 64 bits of the number at a place.</summary>
    public static ulong Bits(ulong place)
    {
        ulong z = unchecked((place + 1) * 0x9E3779B97F4A7C15);
        z = unchecked((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9);
        z = unchecked((z ^ (z >> 27)) * 0x94D049BB133111EB);
        return z ^ (z >> 31);
    }

    /// <summary>The number at a place, from -1 to below 1.</summary>
    public static double Around0(ulong place) => 2 * ((Bits(place) >> 11) * Last) - 1;
}
