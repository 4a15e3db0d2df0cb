using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Runs;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Validation;
using Island = Kinefab.Advice.Runs.RunIsland;

namespace Kinefab.Advice.Changes;

/// <summary>Changes of how PhysX treats joints, which leave the mechanism what it is.</summary>
internal static class JointSettings
{
    /// <summary>Preprocessing off everywhere.</summary>
    public static Change? PreprocessingOff(ValidScene scene, World world)
    {
        ChangePart[] parts = world.Joints.Where(j => Of(scene, j)?.EnablePreprocessing == true)
            .Select(j => new ChangePart(j.GameObject, "Enable Preprocessing off", Place(scene, j), new SceneEdit(EditText.Pointer(j) + "/enablePreprocessing", "false")))
            .ToArray();
        return parts.Length == 0 ? null : new Change("enablePreprocessing off", parts);
    }

    /// <summary>Projection of every ConfigurableJoint to a thousandth of a link and a tenth of a degree.</summary>
    public static Change? Projection(ValidScene scene, World world, IEnumerable<RunIsland> islands)
    {
        var parts = new List<ChangePart>();
        foreach (RunIsland island in islands)
        {
            string distance = EditText.Number(0.001 * island.Length);
            foreach (WorldJoint joint in island.Joints.Select(j => world.Joints[j]))
            {
                if (Of(scene, joint) is not ConfigurableJoint { ProjectionMode: JointProjectionMode.None })
                    continue;
                string at = EditText.Pointer(joint);
                parts.Add(new ChangePart(
                    joint.GameObject,
                    $"Projection Mode Position And Rotation with Projection Distance {distance}, Angle 0.1",
                    Place(scene, joint),
                    new SceneEdit(at + "/projectionMode", "\"PositionAndRotation\""),
                    new SceneEdit(at + "/projectionDistance", distance),
                    new SceneEdit(at + "/projectionAngle", "0.1")));
            }
        }

        return parts.Count == 0 ? null : new Change("projection", parts);
    }

    /// <summary>Extended limits of every HingeJoint that turned past its stop and a half turn, where its angle wraps.</summary>
    public static Change? ExtendedLimits(ValidScene scene, World world, SceneRun run)
    {
        ChangePart[] parts = world.Joints.Where(IsPassed)
            .Select(j => new ChangePart(j.GameObject, "Use Extended Limits", Place(scene, j), new SceneEdit(EditText.Pointer(j) + "/extendedLimits", "true")))
            .ToArray();
        return parts.Length == 0 ? null : new Change("extendedLimits", parts);

        bool IsPassed(WorldJoint joint) =>
            Of(scene, joint) is HingeJoint { UseLimits: true, ExtendedLimits: false }
            && run.Joints[joint.Index].Overshoot(Coordinate.Angle) > 0
            && run.Joints[joint.Index].Coordinates[0].Any(angle => Math.Abs(angle) > 180);
    }

    /// <summary>Its component; null for a link's joint, which is part of an ArticulationBody and has none of a joint's settings.</summary>
    public static Joint? Of(ValidScene scene, WorldJoint joint) =>
        scene.Document.GameObjects[joint.GameObject].Components[joint.Component] as Joint;

    /// <summary>A joint as a user finds it: its type and the two objects.</summary>
    public static string Place(ValidScene scene, WorldJoint joint) => Place(scene, joint.GameObject, joint.Component);

    public static string Place(ValidScene scene, int gameObject, int component)
    {
        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        Joint joint = scene.Joint(new JointCoordinate { GameObject = gameObject, Component = component });
        string other = joint.ConnectedBody is int body ? objects[body].Id : "world";
        return $"{objects[gameObject].Components[component].GetType().Name} {objects[gameObject].Id} - {other}";
    }
}
