using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>SoftJointLimitSpring; both 0 makes the limit hard.</summary>
public sealed record SoftJointLimitSpring : DocumentObject
{
    internal static readonly FieldNames Fields = new([], "spring", "damper", "extras");

    /// <summary>Unity's defaults.</summary>
    public SoftJointLimitSpring()
    {
    }

    internal SoftJointLimitSpring(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "spring":
                    Spring = json.Number();
                    break;
                case "damper":
                    Damper = json.Number();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Unity's defaults.</summary>
    public static SoftJointLimitSpring Default { get; } = new();

    /// <summary>N/m or N m/rad.</summary>
    public double Spring { get; init; }

    /// <summary>N s/m or N m s/rad.</summary>
    public double Damper { get; init; }

    private protected override string Describe() => Line($"limit spring {Spring}, damper {Damper}");
}
