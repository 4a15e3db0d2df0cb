using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Joints;

namespace Kinefab.Dynamics;

/// <summary>
/// Names the steps that the exact solver could not solve and the poses that it closed: each joint once, and no more than
/// <see cref="Most"/> of either.
/// </summary>
internal sealed class ExactStepFindings
{
    /// <summary>Findings of a code in a run; more of them say no more.</summary>
    public const int Most = 10;

    // More is no gap of a machine but a search that came apart, m or rad.
    private const double MostOpen = 1e6;

    private readonly HashSet<(string Code, string Place)> _places = new();

    /// <summary>Which findings were said already.</summary>
    public void Exchange(StateTape tape)
    {
        var places = new HashSet<(string Code, string Place)>(_places);
        tape.Value(ref places);
        _places.Clear();
        _places.UnionWith(places);
    }

    /// <summary>What there is to say of the last step that was not said yet.</summary>
    /// <param name="mechanism">After the step.</param>
    /// <param name="bodies">The world's.</param>
    /// <param name="joints">The world's.</param>
    /// <param name="time">At the start of the step, s.</param>
    public List<Diagnostic> Of(MultibodySystem mechanism, IReadOnlyList<WorldBody> bodies, IReadOnlyList<WorldJoint> joints, double time)
    {
        var found = new List<Diagnostic>();
        foreach (ClosedPose pose in mechanism.Closed)
        {
            if (IsNew(DiagnosticCodes.StartClosed, mechanism, bodies, joints, pose.Joint, pose.Body, out (string Id, string Pointer) at))
                Add(found, DiagnosticCodes.StartClosed, at.Pointer, ("object", at.Id), ("gap", Length(pose.Error, pose.IsAngular)), ("distance", Length(pose.Distance, false)), ("turn", Length(pose.Angle, true)), ("time", Text(time)));
        }

        foreach (ForbiddenSpeed one in mechanism.ForbiddenSpeeds)
        {
            if (IsNew(DiagnosticCodes.StartSpeedForbidden, mechanism, bodies, joints, one.Joint, one.Body, out (string Id, string Pointer) at))
                Add(found, DiagnosticCodes.StartSpeedForbidden, at.Pointer, ("object", at.Id), ("speed", Speed(one)), ("time", Text(time)));
        }

        foreach (UnsolvedStep step in mechanism.Unsolved)
        {
            if (IsNew(DiagnosticCodes.StepUnsolved, mechanism, bodies, joints, step.Joint, step.Body, out (string Id, string Pointer) at))
                Add(found, DiagnosticCodes.StepUnsolved, at.Pointer, ("object", at.Id), ("reason", Reason(step)), ("time", Text(time)), ("advice", Advice(step)));
        }

        for (int i = 0; i < mechanism.HeldLimits.Count; i++)
        {
            HeldLimit first = mechanism.HeldLimits[i];
            bool isFirst = i == 0 || mechanism.HeldLimits[i - 1].Body != first.Body;
            if (isFirst && IsNew(DiagnosticCodes.LimitsContradict, mechanism, bodies, joints, first.Joint, first.Body, out (string Id, string Pointer) at))
            {
                int body = first.Body;
                string names = string.Join(", ", mechanism.HeldLimits.Where(one => one.Body == body).Select(one => Named(mechanism, bodies, joints, one)).Distinct());
                Add(found, DiagnosticCodes.LimitsContradict, at.Pointer, ("joints", names), ("time", Text(time)));
            }
        }

        for (int i = 0; i < mechanism.StalledJoints.Count; i++)
        {
            StalledJoint first = mechanism.StalledJoints[i];
            if ((i > 0 && mechanism.StalledJoints[i - 1].Body == first.Body) || !HasRoom(DiagnosticCodes.DriveStalled))
            {
                continue;
            }

            int body = first.Body;
            List<StalledJoint> all = mechanism.StalledJoints.FindAll(one => one.Body == body);
            if (IsNew(DiagnosticCodes.DriveStalled, mechanism, bodies, joints, all.Find(one => one.IsDrive).Joint, body, out (string Id, string Pointer) at))
            {
                string names = string.Join(", ", all.Select(one => $"{NameOf(mechanism, bodies, joints, one.Joint, one.Body)} ({(one.IsDrive ? "drive" : "limit")})").Distinct());
                Add(found, DiagnosticCodes.DriveStalled, at.Pointer, ("joints", names), ("time", Text(time)));
            }
        }

        return found;
    }

    private static string Named(MultibodySystem mechanism, IReadOnlyList<WorldBody> bodies, IReadOnlyList<WorldJoint> joints, in HeldLimit limit) =>
        $"{NameOf(mechanism, bodies, joints, limit.Joint, limit.Body)} (by {Length(limit.Error, limit.IsAngular)})";

    private static string NameOf(MultibodySystem mechanism, IReadOnlyList<WorldBody> bodies, IReadOnlyList<WorldJoint> joints, JointModel of, int body)
    {
        int joint = Array.IndexOf(mechanism.Joints, of);
        return joint >= 0 && joint < joints.Count ? joints[joint].NameInCad ?? joints[joint].Name : bodies[body].Id;
    }

    // Behind the scene's joints stand those that freeze positions: there the body is what can be named.
    private static (string Id, string Pointer) Place(MultibodySystem mechanism, IReadOnlyList<WorldBody> bodies, IReadOnlyList<WorldJoint> joints, JointModel? of, int body)
    {
        int joint = of == null ? -1 : Array.IndexOf(mechanism.Joints, of);
        return joint >= 0 && joint < joints.Count
            ? (joints[joint].Id, joints[joint].Pointer)
            : (bodies[body].Id, $"/gameObjects/{Text(bodies[body].GameObject)}");
    }

    private static string Reason(in UnsolvedStep step) =>
        step.Joint == null ? "its energy would grow from nothing"
        : step.Error > MostOpen ? "it comes apart beyond all numbers"
        : FormattableString.Invariant($"it stays open by {step.Error:0.0e+0} {(step.IsAngular ? "rad" : "m")}");

    // Only what is the case.
    private static string Advice(in UnsolvedStep step)
    {
        var causes = new List<string>();
        if (step.Troubles.HasFlag(StepTroubles.Open))
        {
            causes.Add("Close the joint in the pose that the step began from.");
        }

        if (step.Troubles.HasFlag(StepTroubles.Limit))
        {
            causes.Add("Widen the limits that the mechanism stands at, if they oppose each other.");
        }

        if (step.Troubles.HasFlag(StepTroubles.EndlessDrive))
        {
            causes.Add("Limit the force of the motors and drives that have no limit.");
        }

        causes.Add(causes.Count > 0 ? "Else take a shorter step." : "Take a shorter step.");
        return string.Join(" ", causes);
    }

    // Before a finding is put into words: what is the case in every step is told in one.
    private bool IsNew(
        string code, MultibodySystem mechanism, IReadOnlyList<WorldBody> bodies, IReadOnlyList<WorldJoint> joints, JointModel? joint, int body, out (string Id, string Pointer) at)
    {
        at = default;
        if (!HasRoom(code))
        {
            return false;
        }

        at = Place(mechanism, bodies, joints, joint, body);
        return _places.Add((code, at.Pointer));
    }

    private bool HasRoom(string code)
    {
        int said = 0;
        foreach ((string Code, string Place) place in _places)
        {
            said += place.Code == code ? 1 : 0;
        }

        return said < Most;
    }

    private static void Add(List<Diagnostic> found, string code, string pointer, params (string Name, string Value)[] values) =>
        found.Add(Diagnostic.Of(code, pointer, values));

    private static string Length(double value, bool isAngle) =>
        isAngle ? FormattableString.Invariant($"{value * 180 / Math.PI:0.###} degrees") : FormattableString.Invariant($"{value:0.0e+0} m");

    private static string Speed(in ForbiddenSpeed one) => Length(one.Speed, one.IsAngular) + "/s";

    private static string Text(double time) => time.ToString("0.######", CultureInfo.InvariantCulture);

    private static string Text(int number) => number.ToString(CultureInfo.InvariantCulture);
}
