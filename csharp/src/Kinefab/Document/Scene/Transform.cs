using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Transform, local to the parent.</summary>
public sealed record Transform : DocumentObject
{
    internal static readonly FieldNames Fields = new([], "localPosition", "localRotation", "localScale", "extras");

    /// <summary>Unity's defaults.</summary>
    public Transform()
    {
    }

    internal Transform(ref JsonCursor json)
    {
        FieldCursor fields = json.BeginObject(Fields);
        while (json.NextField(ref fields))
        {
            switch (fields.Name)
            {
                case "localPosition":
                    LocalPosition = json.Vector3();
                    break;
                case "localRotation":
                    LocalRotation = json.Quaternion();
                    break;
                case "localScale":
                    LocalScale = json.Vector3();
                    break;
                case "extras":
                    ExtrasJson = json.Extras();
                    break;
            }
        }
    }

    /// <summary>At the parent's origin, unturned, unscaled.</summary>
    public static Transform Default { get; } = new();

    /// <summary>Metres, in the parent's frame.</summary>
    public Vector3d LocalPosition { get; init; }

    /// <summary>Parent's frame from own frame.</summary>
    public Quaterniond LocalRotation { get; init; } = Quaterniond.Identity;

    /// <summary>Along the own axes.</summary>
    public Vector3d LocalScale { get; init; } = new(1, 1, 1);

    private protected override string Describe() => Line($"at {LocalPosition} m, rotation {LocalRotation}, scale {LocalScale}");
}
