using Kinefab.Json;

namespace Kinefab.Reading;

/// <summary>Where a <see cref="JsonCursor"/> stands among the fields of one object.</summary>
internal struct FieldCursor
{
    internal readonly FieldNames? Names;
    internal readonly long Start;
    internal ulong Seen;

    /// <summary>Which of the names has the field whose value comes next.</summary>
    internal int Index;

    /// <summary>No names: there is no object, so there are no fields.</summary>
    internal FieldCursor(FieldNames? names, long start)
    {
        Names = names;
        Start = start;
        Seen = 0;
        Index = -1;
    }
}
