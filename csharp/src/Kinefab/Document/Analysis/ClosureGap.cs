using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Worst misfit of the exported pose.</summary>
public sealed record ClosureGap : DocumentObject
{
    internal static readonly FieldNames Fields = new([], "position", "angle", "extras");

    /// <summary>With nothing stated.</summary>
    public ClosureGap()
    {
    }

    internal ClosureGap(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "position":
                    Position = json.Number();
                    break;
                case "angle":
                    Angle = json.Number();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Metres.</summary>
    public double Position { get; init; }

    /// <summary>Degrees.</summary>
    public double Angle { get; init; }
}
