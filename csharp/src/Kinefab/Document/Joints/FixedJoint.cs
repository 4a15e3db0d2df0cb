using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>FixedJoint: holds the relative pose that the bodies have at start-up; removes six freedoms.</summary>
public sealed record FixedJoint : Joint
{
    internal static readonly FieldNames Fields = new(
        ["type"],
        [
            .. JointFields,
            "extras",
        ]);

    /// <summary>Unity's defaults.</summary>
    public FixedJoint()
    {
    }

    internal FixedJoint(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
                default:
                    ReadJointField(ref json, fields.Name);
                    break;
            }
        }
    }

    private protected override string Describe() => $"FixedJoint {Ends}";
}
