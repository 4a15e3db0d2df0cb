using System;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Numerics;
using static Kinefab.Document.ConfigurableJointMotion;

namespace Kinefab.Validation;

/// <summary>ConfigurableJoints: frame, motions and limits.</summary>
internal static class ConfigurableRules
{
    internal static void Numbers(ConfigurableJoint joint, in Place at)
    {
        NumberRules.Finite(at, "secondaryAxis", joint.SecondaryAxis);
        NumberRules.Finite(at, "targetPosition", joint.TargetPosition);
        NumberRules.Finite(at, "targetVelocity", joint.TargetVelocity);
        NumberRules.Finite(at, "targetAngularVelocity", joint.TargetAngularVelocity);
        NumberRules.Unit(at, "targetRotation", joint.TargetRotation);
        NumberRules.NotNegative(at, "projectionDistance", joint.ProjectionDistance);
        NumberRules.NotNegative(at, "projectionAngle", joint.ProjectionAngle);
        Limit(joint.LinearLimit, "linearLimit", at);
        Limit(joint.LowAngularXLimit, "lowAngularXLimit", at);
        Limit(joint.HighAngularXLimit, "highAngularXLimit", at);
        Limit(joint.AngularYLimit, "angularYLimit", at);
        Limit(joint.AngularZLimit, "angularZLimit", at);
        Spring(joint.LinearLimitSpring, "linearLimitSpring", at);
        Spring(joint.AngularXLimitSpring, "angularXLimitSpring", at);
        Spring(joint.AngularYZLimitSpring, "angularYZLimitSpring", at);
    }

    /// <summary>A secondary axis along the axis leaves the joint's Y to Unity.</summary>
    internal static void SecondaryAxis(ConfigurableJoint joint, in Place at)
    {
        const double sine = 1e-4;
        double area = Vector3d.Cross(joint.Axis, joint.SecondaryAxis).Length;
        if (!NumberRules.Vanishes(joint.Axis) && (NumberRules.Vanishes(joint.SecondaryAxis) || area <= sine * joint.Axis.Length * joint.SecondaryAxis.Length))
            at.Report("secondaryAxis", DiagnosticCodes.JointSecondaryAxisParallel);
    }

    internal static void AngularXLimitsOrder(ConfigurableJoint joint, in Place at)
    {
        double low = joint.LowAngularXLimit.Limit, high = joint.HighAngularXLimit.Limit;
        if (low > high)
            at.Report("lowAngularXLimit", DiagnosticCodes.AngularXLimitsOrder, ("low", Invariant.Text(low)), ("high", Invariant.Text(high)));
    }

    /// <summary>These limits act on both sides of zero.</summary>
    internal static void SymmetricLimits(ConfigurableJoint joint, in Place at)
    {
        Symmetric(joint.LinearLimit, "linearLimit", at);
        Symmetric(joint.AngularYLimit, "angularYLimit", at);
        Symmetric(joint.AngularZLimit, "angularZLimit", at);
    }

    /// <summary>Twist and swing are measured within a half turn each way.</summary>
    internal static void AngularLimitsRange(ConfigurableJoint joint, in Place at)
    {
        HalfTurn(joint.AngularXMotion, joint.LowAngularXLimit, "lowAngularXLimit", at);
        HalfTurn(joint.AngularXMotion, joint.HighAngularXLimit, "highAngularXLimit", at);
        HalfTurn(joint.AngularYMotion, joint.AngularYLimit, "angularYLimit", at);
        HalfTurn(joint.AngularZMotion, joint.AngularZLimit, "angularZLimit", at);
    }

    /// <summary>With the other swing free, PhysX limits the elevation of the joint's X, which ends at a right angle.</summary>
    internal static void SwingLimitBesideFree(ConfigurableJoint joint, in Place at)
    {
        if (joint.AngularYMotion == Limited && joint.AngularZMotion == Free && joint.AngularYLimit.Limit > 90)
            at.Report("angularYLimit/limit", DiagnosticCodes.SwingLimitBeyond90, ("angle", Invariant.Text(joint.AngularYLimit.Limit)));
        if (joint.AngularZMotion == Limited && joint.AngularYMotion == Free && joint.AngularZLimit.Limit > 90)
            at.Report("angularZLimit/limit", DiagnosticCodes.SwingLimitBeyond90, ("angle", Invariant.Text(joint.AngularZLimit.Limit)));
    }

    /// <summary>A Limited freedom whose limit leaves no room cannot move.</summary>
    internal static void LimitWithoutRoom(ConfigurableJoint joint, in Place at)
    {
        bool linear = joint.XMotion == Limited || joint.YMotion == Limited || joint.ZMotion == Limited;
        if (linear && joint.LinearLimit.Limit == 0)
            at.Report("linearLimit", DiagnosticCodes.LimitWithoutRoom);
        if (joint.AngularXMotion == Limited && joint.LowAngularXLimit.Limit == joint.HighAngularXLimit.Limit)
            at.Report("highAngularXLimit", DiagnosticCodes.LimitWithoutRoom);
        if (joint.AngularYMotion == Limited && joint.AngularYLimit.Limit == 0)
            at.Report("angularYLimit", DiagnosticCodes.LimitWithoutRoom);
        if (joint.AngularZMotion == Limited && joint.AngularZLimit.Limit == 0)
            at.Report("angularZLimit", DiagnosticCodes.LimitWithoutRoom);
    }

    /// <summary>A soft limit does not bounce.</summary>
    internal static void BounceOfSoftLimit(ConfigurableJoint joint, in Place at)
    {
        Bounce(joint.LinearLimitSpring, joint.LinearLimit, "linearLimit", at);
        Bounce(joint.AngularXLimitSpring, joint.LowAngularXLimit, "lowAngularXLimit", at);
        Bounce(joint.AngularXLimitSpring, joint.HighAngularXLimit, "highAngularXLimit", at);
        Bounce(joint.AngularYZLimitSpring, joint.AngularYLimit, "angularYLimit", at);
        Bounce(joint.AngularYZLimitSpring, joint.AngularZLimit, "angularZLimit", at);
    }

    /// <summary>PhysX has one bounce and one contact distance for both ends of the twist, the high one's here, and one for both
    /// swings, Y's.</summary>
    internal static void SharedResponse(ConfigurableJoint joint, in Place at)
    {
        if (joint.AngularXMotion == Limited && !IsSoft(joint.AngularXLimitSpring))
            Shared(joint.LowAngularXLimit, "lowAngularXLimit", joint.HighAngularXLimit, "highAngularXLimit", at);
        if (joint.AngularZMotion == Limited && !IsSoft(joint.AngularYZLimitSpring))
            Shared(joint.AngularZLimit, "angularZLimit", joint.AngularYLimit, "angularYLimit", at);
    }

    /// <summary>A damper makes the limit soft; without a spring nothing pushes back.</summary>
    internal static void DamperWithoutSpring(ConfigurableJoint joint, in Place at)
    {
        Damper(joint.LinearLimitSpring, "linearLimitSpring", at);
        Damper(joint.AngularXLimitSpring, "angularXLimitSpring", at);
        Damper(joint.AngularYZLimitSpring, "angularYZLimitSpring", at);
    }

    private static void Limit(SoftJointLimit limit, string field, in Place at)
    {
        if (ReferenceEquals(limit, SoftJointLimit.Default))
            return;
        NumberRules.Finite(at, field + "/limit", limit.Limit);
        NumberRules.Share(at, field + "/bounciness", limit.Bounciness);
        NumberRules.NotNegative(at, field + "/contactDistance", limit.ContactDistance);
    }

    private static void Spring(SoftJointLimitSpring spring, string field, in Place at)
    {
        if (ReferenceEquals(spring, SoftJointLimitSpring.Default))
            return;
        NumberRules.NotNegative(at, field + "/spring", spring.Spring);
        NumberRules.NotNegative(at, field + "/damper", spring.Damper);
    }

    private static void Symmetric(SoftJointLimit limit, string field, in Place at)
    {
        if (limit.Limit < 0)
            at.Report(field + "/limit", DiagnosticCodes.LimitNegative, ("limit", Invariant.Text(limit.Limit)));
    }

    private static void HalfTurn(ConfigurableJointMotion motion, SoftJointLimit limit, string field, in Place at)
    {
        if (motion == Limited && Math.Abs(limit.Limit) > 180)
            at.Report(field + "/limit", DiagnosticCodes.AngularLimitBeyond180, ("angle", Invariant.Text(limit.Limit)));
    }

    private static void Bounce(SoftJointLimitSpring spring, SoftJointLimit limit, string field, in Place at)
    {
        if (IsSoft(spring) && limit.Bounciness > 0)
            at.Report(field + "/bounciness", DiagnosticCodes.LimitBounceIgnored);
    }

    private static void Shared(SoftJointLimit ignored, string field, SoftJointLimit used, string other, in Place at)
    {
        Shared(ignored.Bounciness, used.Bounciness, "bounciness", field, other, at);
        Shared(ignored.ContactDistance, used.ContactDistance, "contactDistance", field, other, at);
    }

    private static void Shared(double ignored, double used, string name, string field, string other, in Place at)
    {
        if (ignored != used)
        {
            at.Report(
                field + "/" + name,
                DiagnosticCodes.LimitResponseShared,
                ("field", name),
                ("ignored", Invariant.Text(ignored)),
                ("used", Invariant.Text(used)),
                ("other", other));
        }
    }

    private static bool IsSoft(SoftJointLimitSpring spring) => spring.Spring > 0 || spring.Damper > 0;

    private static void Damper(SoftJointLimitSpring spring, string field, in Place at)
    {
        if (spring.Damper > 0 && spring.Spring == 0)
            at.Report(field + "/damper", DiagnosticCodes.LimitDamperWithoutSpring);
    }
}
