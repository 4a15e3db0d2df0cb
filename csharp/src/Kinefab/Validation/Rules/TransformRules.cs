using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>Positions, rotations and scales.</summary>
internal static class TransformRules
{
    internal static void Numbers(Transform transform, in Place at)
    {
        NumberRules.Finite(at, "transform/localPosition", transform.LocalPosition);
        NumberRules.Unit(at, "transform/localRotation", transform.LocalRotation);
        NumberRules.Finite(at, "transform/localScale", transform.LocalScale);
    }

    /// <summary>A scale of zero makes the object vanish and its anchors meaningless.</summary>
    internal static void ScaleZero(Transform transform, in Place at)
    {
        Vector3d scale = transform.LocalScale;
        if (NumberRules.Vanishes(scale.X) || NumberRules.Vanishes(scale.Y) || NumberRules.Vanishes(scale.Z))
            at.Report("transform/localScale", DiagnosticCodes.TransformScaleZero, ("scale", scale.ToString()));
    }

    /// <summary>A turned object under an unevenly scaled one is sheared, which joints and colliders do not follow.</summary>
    internal static void Skew(Transform transform, Vector3d parentScale, in Place at)
    {
        const double tolerance = 1e-6;
        bool uneven = !Near(parentScale.X, parentScale.Y, tolerance) || !Near(parentScale.X, parentScale.Z, tolerance);
        if (uneven && transform.LocalRotation.Vector.LengthSquared > tolerance * tolerance)
            at.Report("transform/localRotation", DiagnosticCodes.TransformSkew, ("scale", parentScale.ToString()));
    }

    private static bool Near(double a, double b, double tolerance) => System.Math.Abs(a - b) <= tolerance * System.Math.Abs(a);
}
