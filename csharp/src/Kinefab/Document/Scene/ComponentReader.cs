using Kinefab.Json;
using Kinefab.Reading;

namespace Kinefab.Document;

/// <summary>Tells components apart by their <c>type</c>, which may stand anywhere in the object.</summary>
internal static class ComponentReader
{
    private static readonly Words<JsonCursor.ReadItem<Component>> Types = new(
        ("MeshFilter", static (ref JsonCursor json) => new MeshFilter(ref json)),
        ("MeshRenderer", static (ref JsonCursor json) => new MeshRenderer(ref json)),
        ("Rigidbody", static (ref JsonCursor json) => new Rigidbody(ref json)),
        ("ArticulationBody", static (ref JsonCursor json) => new ArticulationBody(ref json)),
        ("MeshCollider", static (ref JsonCursor json) => new MeshCollider(ref json)),
        ("HingeJoint", static (ref JsonCursor json) => new HingeJoint(ref json)),
        ("ConfigurableJoint", static (ref JsonCursor json) => new ConfigurableJoint(ref json)),
        ("FixedJoint", static (ref JsonCursor json) => new FixedJoint(ref json)),
        ("BoxCollider", static (ref JsonCursor json) => new BoxCollider(ref json)),
        ("SphereCollider", static (ref JsonCursor json) => new SphereCollider(ref json)),
        ("CapsuleCollider", static (ref JsonCursor json) => new CapsuleCollider(ref json)));

    /// <summary>An unknown component is reported, stepped over and stood in for: a report with errors gives no document.</summary>
    internal static Component Read(ref JsonCursor json)
    {
        if (json.TryBeginTyped(Types, out JsonCursor.ReadItem<Component>? read))
            return read!(ref json);
        return new MeshFilter();
    }
}
