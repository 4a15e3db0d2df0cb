using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Advice.Changes;

/// <summary>
/// Rows of loop-closing joints that repeat what the rest of the loop holds already: an exact solver needs them only once,
/// an iterative one may stand better with or without them. The mechanism moves alike either way, which is checked.
/// </summary>
internal static class ClosureRows
{
    // Every row freed is a reading of the file and a count of all its joints: joints times rows.
    private const long MostCounts = 10_000;
    private const long MostDrives = 20_000;

    // How far a coordinate is driven to see what moves with it, degrees and lengths of the mechanism; and what counts as moving.
    private const double DriveAngle = 10;
    private const double DriveLength = 0.05;
    private const double StillAngle = 1e-3;
    private const double StillLength = 1e-5;

    private static readonly string[] HingeFields = { "spring", "motor", "limits", "useSpring", "useMotor", "useLimits", "extendedLimits", "useAcceleration" };

    /// <summary>Locks the free rows of loop-closing joints along which nothing ever moves.</summary>
    /// <param name="scene">The scene.</param>
    /// <param name="mechanism">Its mechanism.</param>
    /// <param name="counted">Its freedoms.</param>
    /// <param name="untried">Rows that were not looked at, since there are too many.</param>
    /// <param name="cancellation">Ends the counts early, with an OperationCanceledException.</param>
    public static Change? Whole(ValidScene scene, Mechanism mechanism, MobilityReport counted, out int untried, CancellationToken cancellation)
    {
        List<int> free = FreeRows(mechanism);
        untried = (long)mechanism.Coordinates.Count * free.Count > MostDrives ? free.Count : 0;
        if (free.Count == 0 || untried > 0)
            return null;
        bool[] moves = Moving(mechanism, free, cancellation);
        var parts = new List<ChangePart>();
        foreach (IGrouping<(int GameObject, int Component), MechanismCoordinate> joint in free.Where((_, i) => !moves[i])
            .Select(c => mechanism.Coordinates[c]).GroupBy(c => (c.GameObject, c.Component)))
        {
            parts.Add(new ChangePart(
                joint.Key.GameObject,
                $"{string.Join(", ", joint.Select(c => MotionField.Of(c.Coordinate).Label))} Free -> Locked",
                JointSettings.Place(scene, joint.Key.GameObject, joint.Key.Component),
                joint.Select(c => new SceneEdit($"{EditText.Component(c.GameObject, c.Component)}/{MotionField.Of(c.Coordinate).Name}", "\"Locked\"")).ToArray()));
        }

        return parts.Count > 0 && MovesAlike(scene, counted, parts, cancellation) is not null ? new Change("closing joints whole", parts) : null;
    }

    /// <summary>Frees redundant rows of the joints that have them.</summary>
    /// <param name="scene">The scene.</param>
    /// <param name="joints">How many joints it has.</param>
    /// <param name="counted">Its freedoms.</param>
    /// <param name="untried">Rows that were not looked at, since there are too many.</param>
    /// <param name="cancellation">Ends the counts early, with an OperationCanceledException.</param>
    public static Change? Minimal(ValidScene scene, int joints, MobilityReport counted, out int untried, CancellationToken cancellation)
    {
        int rows = counted.Joints.Sum(j => j.Rows);
        untried = (long)joints * rows > MostCounts ? rows : 0;
        if (untried > 0)
            return null;
        var parts = new List<ChangePart>();
        foreach (RedundantRows joint in counted.Joints)
        {
            if (Freed(scene, counted, joint, parts, cancellation) is ChangePart part)
                parts.Add(part);
        }

        return parts.Count == 0 ? null : new Change("closing joints minimal", parts);
    }

    private static ChangePart? Freed(ValidScene scene, MobilityReport counted, RedundantRows joint, List<ChangePart> before, CancellationToken cancellation)
    {
        if (Locked(scene, joint) is not (MotionField[] locked, JsonTree component))
            return null;
        var freed = new List<MotionField>();
        foreach (MotionField row in locked)
        {
            if (freed.Count == joint.Redundant)
                break;
            freed.Add(row);
            if (MovesAlike(scene, counted, before.Append(Part(freed)), cancellation) is null)
                freed.RemoveAt(freed.Count - 1);
        }

        return freed.Count == 0 ? null : Part(freed);

        ChangePart Part(List<MotionField> rows)
        {
            var changed = component.Clone();
            foreach (MotionField row in rows)
                changed[row.Name] = JsonTree.String("Free");
            string kind = component["type"]!.AsString() == scene.Document.GameObjects[joint.GameObject].Components[joint.Component].GetType().Name
                ? ""
                : "replace by a ConfigurableJoint of the same frame and locks, with ";
            return new ChangePart(
                joint.GameObject,
                $"{kind}{string.Join(", ", rows.Select(r => r.Label))} Free",
                JointSettings.Place(scene, joint.GameObject, joint.Component),
                new SceneEdit(EditText.Component(joint.GameObject, joint.Component), changed.ToString()));
        }
    }

    // The locked rows and the component as a ConfigurableJoint; null for what has drives or limits of a hinge that would be lost.
    private static (MotionField[] Locked, JsonTree Component)? Locked(ValidScene scene, RedundantRows place)
    {
        if (scene.Document.GameObjects[place.GameObject].Components[place.Component] is not Joint joint)
            return null;
        JsonTree component = EditedScene.Component(scene, place.GameObject, place.Component);
        if (joint is ConfigurableJoint configurable)
            return (MotionField.All.Where(f => f.In(configurable) == ConfigurableJointMotion.Locked).ToArray(), component);
        MotionField[] all = MotionField.All;
        if (joint is HingeJoint hinge)
        {
            if (hinge.UseSpring || hinge.UseMotor || hinge.UseLimits)
                return null;
            all = all.Where(f => f.Coordinate != Coordinate.AngularX).ToArray();
            foreach (string field in HingeFields)
                component.Remove(field);
            Vector3d across = Vector3d.Perpendicular(hinge.Axis.Normalized());
            component["secondaryAxis"] = JsonTree.Numbers(across.X, across.Y, across.Z);
        }

        component["type"] = JsonTree.String(nameof(ConfigurableJoint));
        foreach (MotionField row in all)
            component[row.Name] = JsonTree.String("Locked");
        return (all, component);
    }

    private static ValidScene? MovesAlike(ValidScene scene, MobilityReport counted, IEnumerable<ChangePart> parts, CancellationToken cancellation)
    {
        if (EditedScene.Apply(scene, parts.SelectMany(p => p.Edits)) is not ValidScene changed)
            return null;
        MobilityReport then = MobilityAnalysis.Of(Mechanism.Create(changed), null, cancellation);
        return then.Mobility == counted.Mobility && then.FirstOrder == counted.FirstOrder ? changed : null;
    }

    private static List<int> FreeRows(Mechanism mechanism)
    {
        var rows = new List<int>();
        for (int i = 0; i < mechanism.Coordinates.Count; i++)
        {
            MechanismCoordinate c = mechanism.Coordinates[i];
            if (!c.IsLocked && mechanism.Scene.Document.GameObjects[c.GameObject].Components[c.Component] is ConfigurableJoint { Closure: true } joint
                && MotionField.Of(c.Coordinate).In(joint) == ConfigurableJointMotion.Free)
                rows.Add(i);
        }

        return rows;
    }

    // Every other coordinate is driven a little to both sides; rows that then never move may be locked. From a singular pose a drive looks for
    // branches along dozens of mixtures, so none is taken once all rows have moved.
    private static bool[] Moving(Mechanism mechanism, List<int> rows, CancellationToken cancellation)
    {
        var moves = new bool[rows.Count];
        var solver = new PositionSolver(mechanism);
        MechanismState state = mechanism.NewState();
        MechanismState start = mechanism.NewState();
        for (int driver = 0; driver < mechanism.Coordinates.Count; driver++)
        {
            if (mechanism.Coordinates[driver].IsLocked || rows.Contains(driver))
                continue;
            double way = mechanism.Coordinates[driver].IsAngle ? DriveAngle : DriveLength * mechanism.Length;
            foreach (double target in new[] { way, -way })
            {
                if (Array.TrueForAll(moves, moved => moved))
                    return moves;
                state.CopyFrom(start);
                solver.Drive(state, driver, target, cancellation);
                for (int i = 0; i < moves.Length; i++)
                {
                    double still = mechanism.Coordinates[rows[i]].IsAngle ? StillAngle : StillLength * mechanism.Length;
                    moves[i] |= Math.Abs(state.Coordinate(rows[i])) > still;
                }
            }
        }

        return moves;
    }
}
