using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Json;

namespace Kinefab.Validation;

/// <summary>What describes the scene without acting in it: settings, source, constraints, analysis.</summary>
internal static class DescriptionRules
{
    internal static void Physics(Physics physics, in Place at)
    {
        NumberRules.Finite(at, "gravity", physics.Gravity);
        NumberRules.Positive(at, "fixedTimestep", physics.FixedTimestep);
        NumberRules.Between(at, "solverIterations", physics.SolverIterations, 1, 255);
        NumberRules.Between(at, "solverVelocityIterations", physics.SolverVelocityIterations, 1, 255);
        NumberRules.NotNegative(at, "bounceThreshold", physics.BounceThreshold);
        NumberRules.Positive(at, "defaultMaxAngularSpeed", physics.DefaultMaxAngularSpeed);
    }

    internal static void Source(SceneSource source, in Place at)
    {
        if (source.MetersPerUnit is double meters)
            NumberRules.Positive(at, "metersPerUnit", meters);
        if (source.Sha256 is string hash)
            BufferRules.Sha256(hash, "sha256", at);
    }

    internal static void Constraint(Constraint constraint, int gameObjectCount, in Place at)
    {
        NumberRules.Finite(at, "value", constraint.Value);
        for (int i = 0; i < constraint.Features.Count; i++)
        {
            string field = "features/" + Invariant.Text(i);
            Feature feature = constraint.Features[i];
            if (feature.GameObject is int gameObject)
                NumberRules.Reference(at, field + "/gameObject", gameObject, "gameObjects", gameObjectCount);
            NumberRules.NotNegative(at, field + "/radius", feature.Radius);
        }
    }

    internal static void Analysis(Analysis analysis, int gameObjectCount, in Place at)
    {
        NumberRules.AtLeast(at, "mobility", analysis.Mobility, 0);
        NumberRules.AtLeast(at, "firstOrderMobility", analysis.FirstOrderMobility ?? 0, 0);
        NumberRules.AtLeast(at, "redundant", analysis.Redundant ?? 0, 0);
        NumberRules.AtLeast(at, "idle", analysis.Idle ?? 0, 0);
        if (analysis.ClosureGap is ClosureGap gap)
        {
            NumberRules.NotNegative(at, "closureGap/position", gap.Position);
            NumberRules.NotNegative(at, "closureGap/angle", gap.Angle);
        }

        for (int i = 0; i < analysis.Islands.Count; i++)
            Island(analysis.Islands[i], gameObjectCount, "islands/" + Invariant.Text(i), at);
        for (int i = 0; i < analysis.Bodies.Count; i++)
            Body(analysis.Bodies[i], gameObjectCount, "bodies/" + Invariant.Text(i), at);
    }

    private static void Island(AnalysisIsland island, int gameObjectCount, string field, in Place at)
    {
        NumberRules.AtLeast(at, field + "/mobility", island.Mobility, 0);
        NumberRules.AtLeast(at, field + "/redundant", island.Redundant ?? 0, 0);
        NumberRules.AtLeast(at, field + "/loops", island.Loops ?? 0, 0);
        for (int i = 0; i < island.GameObjects.Count; i++)
        {
            if ((uint)island.GameObjects[i] < (uint)gameObjectCount)
                continue;
            NumberRules.Reference(at, field + "/gameObjects/" + Invariant.Text(i), island.GameObjects[i], "gameObjects", gameObjectCount);
        }
    }

    private static void Body(BodyFreedom body, int gameObjectCount, string field, in Place at)
    {
        NumberRules.Reference(at, field + "/gameObject", body.GameObject, "gameObjects", gameObjectCount);
        NumberRules.Between(at, field + "/translations", body.Translations, 0, 3);
        NumberRules.Between(at, field + "/rotations", body.Rotations, 0, 3);
    }
}
