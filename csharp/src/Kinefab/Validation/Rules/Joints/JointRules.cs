using System;
using System.Collections.Generic;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Numerics;

namespace Kinefab.Validation;

/// <summary>What holds for every joint.</summary>
internal static class JointRules
{
    internal static void Numbers(Joint joint, in Place at)
    {
        NumberRules.PositiveOrUnlimited(at, "breakForce", joint.BreakForce);
        NumberRules.PositiveOrUnlimited(at, "breakTorque", joint.BreakTorque);
        NumberRules.Positive(at, "massScale", joint.MassScale);
        NumberRules.Positive(at, "connectedMassScale", joint.ConnectedMassScale);
    }

    internal static void AnchorNumbers(AnchoredJoint joint, in Place at)
    {
        NumberRules.Finite(at, "anchor", joint.Anchor);
        NumberRules.Finite(at, "axis", joint.Axis);
        NumberRules.Finite(at, "connectedAnchor", joint.ConnectedAnchor);
        StatedNumbers(joint.StatedOf(Coordinate.Angle), "", at);
        foreach ((string field, StatedAxis stated) in Axes(joint))
            StatedNumbers(stated, field + "/", at);
    }

    /// <summary>What a source states of a joint and no solver here, nor Unity's, has a place for.</summary>
    internal static void Stated(AnchoredJoint joint, in Place at)
    {
        StatedUnfollowed(joint.StatedOf(Coordinate.Angle), "", at);
        foreach ((string field, StatedAxis stated) in Axes(joint))
            StatedUnfollowed(stated, field + "/", at);
    }

    /// <summary>Unity adds a Rigidbody of its own to a joint without one, with mass 1 and guessed inertia.</summary>
    internal static void OwnBody(Rigidbody? own, in Place at)
    {
        if (own is null)
            at.Report("", DiagnosticCodes.JointWithoutRigidbody);
    }

    /// <summary>The connected GameObject exists, is another one and has a Rigidbody.</summary>
    internal static void ConnectedBody(Joint joint, int gameObject, ReadOnlySpan<GameObject> objects, in Place at)
    {
        if (joint.ConnectedBody is not int connected)
            return;
        if (!NumberRules.Reference(at, "connectedBody", connected, "gameObjects", objects.Length))
            return;
        if (connected == gameObject)
            at.Report("connectedBody", DiagnosticCodes.JointConnectsItself);
        else if (objects[connected].Body is null)
            at.Report("connectedBody", DiagnosticCodes.ConnectedBodyWithoutRigidbody, ("gameObject", Invariant.Text(connected)));
    }

    /// <summary>Nothing that the solver moves hangs on such a joint.</summary>
    internal static void Kinematic(Joint joint, Rigidbody? own, ReadOnlySpan<GameObject> objects, in Place at)
    {
        bool connectedMoves = joint.ConnectedBody is int connected && (uint)connected < (uint)objects.Length && objects[connected].Body is { IsKinematic: false };
        if (own is { IsKinematic: true } && !connectedMoves)
            at.Report("", DiagnosticCodes.JointBetweenKinematic);
    }

    /// <summary>An axis of length zero, as 32-bit floats too, says nothing; Unity silently takes its own X.</summary>
    internal static void Axis(AnchoredJoint joint, in Place at)
    {
        if (NumberRules.Vanishes(joint.Axis))
            at.Report("axis", DiagnosticCodes.JointAxisZero);
    }

    private static IEnumerable<(string Field, StatedAxis Stated)> Axes(AnchoredJoint joint)
    {
        if (joint is not ConfigurableJoint configurable || ReferenceEquals(configurable.Stated, StatedAxes.Default))
            yield break;
        for (Coordinate axis = Coordinate.X; axis <= Coordinate.AngularZ; axis++)
            yield return ("stated/" + CoordinateWords.Table.WordOf(axis), configurable.Stated[axis]);
    }

    private static void StatedNumbers(StatedAxis stated, string prefix, in Place at)
    {
        NumberRules.NotNegativeOrUnlimited(at, prefix + "effort", stated.Effort);
        NumberRules.PositiveOrUnlimited(at, prefix + "speed", stated.Speed);
        NumberRules.NotNegative(at, prefix + "friction", stated.Friction);
        NumberRules.NotNegative(at, prefix + "armature", stated.Armature);
    }

    private static void StatedUnfollowed(StatedAxis stated, string prefix, in Place at)
    {
        if (stated.Effort is >= 0 and < double.PositiveInfinity)
            at.Report(prefix + "effort", DiagnosticCodes.JointStatedUnfollowed, ("field", "effort"));
        if (stated.Speed is > 0 and < double.PositiveInfinity)
            at.Report(prefix + "speed", DiagnosticCodes.JointStatedUnfollowed, ("field", "speed"));
        if (stated.Friction > 0)
            at.Report(prefix + "friction", DiagnosticCodes.JointStatedUnfollowed, ("field", "friction"));
        if (stated.Armature > 0)
            at.Report(prefix + "armature", DiagnosticCodes.JointStatedUnfollowed, ("field", "armature"));
    }
}
