using System;
using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Document;

namespace Kinefab.Mechanisms;

/// <summary>What a joint and a body have that an articulation has no field for.</summary>
internal static class LinkLosses
{
    private const string Articulation = "an articulation";

    internal static Diagnostic Dropped(string feature, string field, string pointer) =>
        Diagnostic.Of(DiagnosticCodes.TargetFieldDropped, pointer, ("feature", feature), ("field", field), ("target", Articulation));

    /// <summary>Of a joint that is left out: it only keeps bodies from colliding, or is switched off.</summary>
    internal static Diagnostic Dropped(Joint joint, string owner, string pointer)
    {
        const string Pair = "apart:";
        string name = joint.Id is { Length: > 0 } id ? id : owner;
        if (!joint.Enabled)
            return Diagnostic.Of(DiagnosticCodes.JointDisabledDropped, pointer, ("joint", name), ("target", Articulation));
        return Dropped($"pair {(name.StartsWith(Pair, StringComparison.Ordinal) ? name.Substring(Pair.Length) : name)}", "what does not collide", pointer);
    }

    /// <summary>Tells them.</summary>
    /// <param name="joint">Above the link that stands for the body.</param>
    /// <param name="body">Which becomes the link.</param>
    /// <param name="name">Of the joint.</param>
    /// <param name="pointer">Of the joint.</param>
    /// <param name="owner">Id of the body's object.</param>
    /// <param name="findings">Gets them.</param>
    internal static void Tell(Joint joint, Rigidbody body, string name, string pointer, string owner, List<Diagnostic> findings)
    {
        void Lost(bool isSo, string field)
        {
            if (isSo)
                findings.Add(Dropped($"joint {name}", field, pointer));
        }

        void LostOfBody(bool isSo, string field)
        {
            if (isSo)
                findings.Add(Dropped($"Rigidbody of {owner}", field, pointer));
        }

        Lost(joint.EnableCollision, "enableCollision");
        if (joint is HingeJoint hinge)
        {
            Lost(hinge.UseLimits && hinge.Limits.Bounciness != 0, "the limit's bounciness");
            Lost(hinge.UseMotor && hinge.Motor.FreeSpin, "the motor's freeSpin");
        }

        if (joint is ConfigurableJoint free)
        {
            (bool Limits, SoftJointLimitSpring Spring, double Bounciness)[] limits =
            {
                (IsLimited(free.XMotion) || IsLimited(free.YMotion) || IsLimited(free.ZMotion), free.LinearLimitSpring, free.LinearLimit.Bounciness),
                (IsLimited(free.AngularXMotion), free.AngularXLimitSpring, free.LowAngularXLimit.Bounciness + free.HighAngularXLimit.Bounciness),
                (IsLimited(free.AngularYMotion) || IsLimited(free.AngularZMotion), free.AngularYZLimitSpring, free.AngularYLimit.Bounciness + free.AngularZLimit.Bounciness),
            };
            foreach ((bool isLimited, SoftJointLimitSpring spring, double bounciness) in limits)
            {
                Lost(isLimited && (spring.Spring != 0 || spring.Damper != 0), "the limit's spring");
                Lost(isLimited && bounciness != 0, "the limit's bounciness");
            }

            if (free.RotationDriveMode == RotationDriveMode.Slerp && free.SlerpDrive != JointDrive.Default)
                findings.Add(Diagnostic.Of(DiagnosticCodes.TargetFeatureApproximated, pointer, ("feature", $"joint {name}"), ("target", Articulation), ("detail", "its drive about all three rotations became one about each")));
        }

        LostOfBody(body.MaxAngularVelocity is not null, "maxAngularVelocity");
        LostOfBody(body.SolverIterations is not null, "solverIterations");
        LostOfBody(body.SolverVelocityIterations is not null, "solverVelocityIterations");
        LostOfBody(body.Constraints != RigidbodyConstraints.None, "constraints");
        LostOfBody(body.Interpolation != RigidbodyInterpolation.None, "interpolation");
    }

    private static bool IsLimited(ConfigurableJointMotion motion) => motion == ConfigurableJointMotion.Limited;
}
