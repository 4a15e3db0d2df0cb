using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>JointSpring of a <see cref="HingeJoint"/>.</summary>
public sealed record JointSpring : DocumentObject
{
    internal static readonly FieldNames Fields = new([], "spring", "damper", "targetPosition", "extras");

    /// <summary>Unity's defaults.</summary>
    public JointSpring()
    {
    }

    internal JointSpring(ref JsonCursor json)
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
                case "targetPosition":
                    TargetPosition = json.Number();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>Unity's defaults.</summary>
    public static JointSpring Default { get; } = new();

    /// <summary>N m/rad.</summary>
    public double Spring { get; init; }

    /// <summary>N m s/rad.</summary>
    public double Damper { get; init; }

    /// <summary>Degrees.</summary>
    public double TargetPosition { get; init; }

    private protected override string Describe() => Line($"spring to {TargetPosition} deg, spring {Spring}, damper {Damper}");
}
