using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>SoftJointLimit of a <see cref="ConfigurableJoint"/>.</summary>
public sealed record SoftJointLimit : DocumentObject
{
    internal static readonly FieldNames Fields = new([], "limit", "bounciness", "contactDistance", "extras");

    /// <summary>Unity's defaults.</summary>
    public SoftJointLimit()
    {
    }

    internal SoftJointLimit(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "limit":
                    Limit = json.Number();
                    break;
                case "bounciness":
                    Bounciness = json.Number();
                    break;
                case "contactDistance":
                    ContactDistance = json.Number();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Unity's defaults.</summary>
    public static SoftJointLimit Default { get; } = new();

    /// <summary>Metres or degrees.</summary>
    public double Limit { get; init; }

    /// <summary>Share of the speed kept at the limit, 0 to 1.</summary>
    public double Bounciness { get; init; }

    /// <summary>Distance from the limit within which it is looked at, metres or degrees; 0: PhysX's choice.</summary>
    public double ContactDistance { get; init; }

    private protected override string Describe() => Line($"limit {Limit} m or deg{(Bounciness > 0 ? $", bounciness {Bounciness}" : "")}");
}
