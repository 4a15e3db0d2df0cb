using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>Rigidbodies.</summary>
internal static class BodyRules
{
    internal static void Numbers(Rigidbody body, in Place at)
    {
        NumberRules.NotNegative(at, "linearDamping", body.LinearDamping);
        NumberRules.NotNegative(at, "angularDamping", body.AngularDamping);
        NumberRules.Finite(at, "centerOfMass", body.CenterOfMass);
        NumberRules.Unit(at, "inertiaTensorRotation", body.InertiaTensorRotation);
        if (body.MaxAngularVelocity is double speed)
            NumberRules.Positive(at, "maxAngularVelocity", speed);
        if (body.SolverIterations is int iterations)
            NumberRules.Between(at, "solverIterations", iterations, 1, 255);
        if (body.SolverVelocityIterations is int velocityIterations)
            NumberRules.Between(at, "solverVelocityIterations", velocityIterations, 1, 255);
    }

    internal static void Mass(Rigidbody body, in Place at)
    {
        if (!(body.Mass > 0 && body.Mass < double.PositiveInfinity))
            at.Report("mass", DiagnosticCodes.BodyMassNotPositive, ("mass", Invariant.Text(body.Mass)));
        else
            NumberRules.NotVanishing(at, "mass", body.Mass);
    }

    /// <summary>Positive principal moments; and no real body has one that exceeds the sum of the others (a + b >= c).</summary>
    internal static void Inertia(Rigidbody body, in Place at)
    {
        Vector3d inertia = body.InertiaTensor;
        double sum = inertia.X + inertia.Y + inertia.Z;
        double largest = System.Math.Max(inertia.X, System.Math.Max(inertia.Y, inertia.Z));
        if (!(inertia.X > 0 && inertia.Y > 0 && inertia.Z > 0 && sum < double.PositiveInfinity))
            at.Report("inertiaTensor", DiagnosticCodes.BodyInertiaNotPositive, ("inertia", inertia.ToString()));
        else if (largest > (sum - largest) * (1 + InertiaTolerance))
            at.Report("inertiaTensor", DiagnosticCodes.BodyInertiaTriangle, ("inertia", inertia.ToString()));
        else
            NumberRules.NotVanishing(at, "inertiaTensor", System.Math.Min(inertia.X, System.Math.Min(inertia.Y, inertia.Z)));
    }

    /// <summary>Flat bodies reach equality; their moments are rounded.</summary>
    private const double InertiaTolerance = 1e-4;
}
