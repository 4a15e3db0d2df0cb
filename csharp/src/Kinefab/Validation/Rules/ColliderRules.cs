using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>Colliders.</summary>
internal static class ColliderRules
{
    internal static void Box(BoxCollider box, in Place at)
    {
        NumberRules.Finite(at, "center", box.Center);
        NumberRules.Finite(at, "size", box.Size);
        Vector3d size = box.Size;
        if (size.X < 0 || size.Y < 0 || size.Z < 0)
            at.Report("size", DiagnosticCodes.ColliderSizeNegative, ("size", size.ToString()));
    }

    internal static void Sphere(SphereCollider sphere, in Place at)
    {
        NumberRules.Finite(at, "center", sphere.Center);
        NumberRules.Positive(at, "radius", sphere.Radius);
    }

    internal static void Capsule(CapsuleCollider capsule, in Place at)
    {
        NumberRules.Finite(at, "center", capsule.Center);
        NumberRules.Positive(at, "radius", capsule.Radius);
        NumberRules.NotNegative(at, "height", capsule.Height);
    }

    internal static void Material(PhysicsMaterial material, in Place at)
    {
        NumberRules.NotNegative(at, "dynamicFriction", material.DynamicFriction);
        NumberRules.NotNegative(at, "staticFriction", material.StaticFriction);
        NumberRules.Share(at, "bounciness", material.Bounciness);
    }

    /// <summary>PhysX has no moving triangle meshes: Unity refuses a concave collider on a body that is not kinematic.</summary>
    internal static void Convexity(MeshCollider mesh, Rigidbody? body, in Place at)
    {
        if (!mesh.Convex && body is { IsKinematic: false })
            at.Report("convex", DiagnosticCodes.MeshColliderNotConvex);
    }
}
