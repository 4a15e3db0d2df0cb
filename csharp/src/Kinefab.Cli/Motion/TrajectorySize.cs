namespace Kinefab.Cli.Motion;

/// <summary>
/// How much a motion may hold.  It is kept in memory until its end, since its file lists each body's poses one after the
/// other and is written whole or not at all.
/// </summary>
internal static class TrajectorySize
{
    /// <summary>Most numbers of one motion: 400 MB of memory, and about 1 GB as a file.</summary>
    internal const long MostNumbers = 50_000_000;

    private const int NumbersOfAPose = 7;

    /// <summary>Null when it can be kept, else how much too large it is.</summary>
    internal static string? Fault(int steps, int bodies, int coordinates)
    {
        long numbers = (steps + 1L) * ((long)bodies * NumbersOfAPose + coordinates + 1);
        return numbers <= MostNumbers
            ? null
            : $"{steps} steps of {Counted.Of(bodies, "body", "bodies")} and {Counted.Of(coordinates, "coordinate", "coordinates")} make {numbers} numbers; at most {MostNumbers} are kept.";
    }
}
