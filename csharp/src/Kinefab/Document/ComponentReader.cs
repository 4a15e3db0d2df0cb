using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Document;

/// <summary>Tells components apart by their <c>type</c>, which may stand anywhere in the object.</summary>
internal static class ComponentReader
{
    /// <summary>An unknown component is reported, stepped over and stood in for: a report with errors gives no document.</summary>
    internal static Component Read(ref JsonCursor json)
    {
        if (!json.IsObject)
        {
            json.Mismatch("an object");
            return new MeshFilter();
        }

        string? type = json.Peek("type"u8);
        switch (type)
        {
            case nameof(MeshFilter):
                return new MeshFilter(ref json);
            case nameof(MeshRenderer):
                return new MeshRenderer(ref json);
            case nameof(Rigidbody):
                return new Rigidbody(ref json);
            case nameof(BoxCollider):
                return new BoxCollider(ref json);
            case nameof(SphereCollider):
                return new SphereCollider(ref json);
            case nameof(CapsuleCollider):
                return new CapsuleCollider(ref json);
            case nameof(MeshCollider):
                return new MeshCollider(ref json);
            case nameof(HingeJoint):
                return new HingeJoint(ref json);
            case nameof(ConfigurableJoint):
                return new ConfigurableJoint(ref json);
            case nameof(FixedJoint):
                return new FixedJoint(ref json);
            case null:
                json.Report(DiagnosticCodes.FieldMissing, ("field", "type"));
                break;
            default:
                json.Report(DiagnosticCodes.ComponentTypeUnknown, ("type", type));
                break;
        }

        json.Skip();
        return new MeshFilter();
    }
}
