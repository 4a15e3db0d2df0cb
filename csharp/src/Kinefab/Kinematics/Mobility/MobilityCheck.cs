using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Validation;

namespace Kinefab.Kinematics;

/// <summary>
/// Holds the mobility counted from a scene's joints against the one in its analysis block, which the exporter counted from
/// the source's constraints: two programs, two representations, one mechanism.
/// </summary>
public static class MobilityCheck
{
    /// <summary>
    /// One error for each number that differs, a warning where the rank of the rows leaves it open which is right, or what the file's joints are
    /// off by; nothing where the file holds no analysis.
    /// </summary>
    /// <param name="scene">Whose file states what the exporter counted.</param>
    /// <param name="counted">What was counted here.</param>
    /// <returns>The differences, with the place of each number in the file; empty where all agree.</returns>
    public static Report Compare(ValidScene scene, MobilityReport counted)
    {
        if (scene is null)
            throw new ArgumentNullException(nameof(scene));
        if (counted is null)
            throw new ArgumentNullException(nameof(counted));
        var found = new List<Diagnostic>();
        if (scene.Document.Analysis is not Analysis stated)
        {
            return Report.Empty;
        }

        Dictionary<int, IslandMobility> islandOf = counted.Islands.SelectMany(i => i.GameObjects, (i, o) => (Island: i, Object: o)).ToDictionary(p => p.Object, p => p.Island);
        Dictionary<int, BodyMobility> bodyOf = counted.Bodies.ToDictionary(b => b.GameObject);
        // Rows that are off by noise leave other velocities at the pose that either program closed; where these are not as many, which is told, the
        // motions among them need not be.
        int inDoubt = counted.InDoubt + (counted.IsNoisy ? Math.Abs(counted.FirstOrder - (stated.FirstOrderMobility ?? counted.FirstOrder)) : 0);
        Expect("/analysis/mobility", "The mechanism's mobility", stated.Mobility, counted.Mobility);
        if (stated.FirstOrderMobility is int firstOrder && firstOrder != counted.FirstOrder)
        {
            Add("/analysis/firstOrderMobility", DiagnosticCodes.MobilityFirstOrderDiffers, ("stated", Text(firstOrder)), ("counted", Text(counted.FirstOrder)));
        }

        if (stated.Idle is int idle)
        {
            Expect("/analysis/idle", "The number of idle freedoms", idle, counted.Idle.Sum(i => i.Count));
        }

        // Of as many bodies and freedoms between them, each velocity more at the exported pose is a row more that repeats others.
        int moreVelocities = Math.Max(0, counted.FirstOrder - (stated.FirstOrderMobility ?? counted.FirstOrder));
        AtMost("/analysis/redundant", "the mechanism", stated.Redundant, counted.Redundant);
        for (int i = 0; i < stated.Islands.Count; i++)
        {
            // The exporter may count a body that fixed joints hold to the ground as an island of its own or as ground.
            AnalysisIsland island = stated.Islands[i];
            string pointer = $"/analysis/islands/{Text(i)}";
            string name = $"the island of {Name(scene, island.GameObjects)}";
            IslandMobility[] same = island.GameObjects.Where(islandOf.ContainsKey).Select(o => islandOf[o]).Distinct().ToArray();
            Expect($"{pointer}/mobility", $"The mobility of {name}", island.Mobility, same.Sum(c => c.Mobility));
            AtMost($"{pointer}/redundant", name, island.Redundant, same.Sum(c => c.Redundant));
            if (island.Loops is int loops)
            {
                Expect($"{pointer}/loops", $"The number of loops of {name}", loops, same.Sum(c => c.Loops));
            }
        }

        // A body's freedoms are its velocities at the exported pose: where these are not the same, which is told, nor are they.
        bool sameVelocities = (stated.FirstOrderMobility ?? counted.FirstOrder) == counted.FirstOrder;
        for (int i = 0; sameVelocities && i < stated.Bodies.Count; i++)
        {
            BodyFreedom body = stated.Bodies[i];
            int? moved = scene.BodyOf(body.GameObject);
            BodyMobility? same = moved is int mover && bodyOf.TryGetValue(mover, out BodyMobility? its) ? its : null;
            string name = scene.Document.GameObjects[body.GameObject].Name;
            bool isInDoubt = same is not null && same.IsInDoubt;
            Expect($"/analysis/bodies/{Text(i)}/translations", $"The number of translations of {name}", body.Translations, same?.Translations ?? 0, isInDoubt);
            Expect($"/analysis/bodies/{Text(i)}/rotations", $"The number of rotations of {name}", body.Rotations, same?.Rotations ?? 0, isInDoubt);
        }

        return new Report(found);

        void Expect(string pointer, string what, int inFile, int fromJoints, bool isInDoubt = false)
        {
            if (inFile != fromJoints)
            {
                string code = isInDoubt || Math.Abs(inFile - fromJoints) <= inDoubt ? DiagnosticCodes.MobilityUnsure : DiagnosticCodes.MobilityDiffers;
                Add(pointer, code, ("what", what), ("stated", Text(inFile)), ("counted", Text(fromJoints)));
            }
        }

        // A joint carries no more rows than its constraints, and a minimal closure leaves out redundant ones: fewer are as it
        // should be, more would be rows that no constraint stands for.
        void AtMost(string pointer, string where, int? inFile, int fromJoints)
        {
            if (inFile is int most && most + moreVelocities < fromJoints)
            {
                Expect(pointer, $"The greatest number of redundant rows of {where}", most, fromJoints);
            }
        }

        void Add(string pointer, string code, params (string Name, string Value)[] values)
        {
            DiagnosticTable.Entry entry = DiagnosticTable.Entries[code];
            found.Add(new Diagnostic(code, entry.Severity, DiagnosticTable.Fill(entry.Message, values), DiagnosticTable.Fill(entry.Remedy, values), pointer, null, null));
        }
    }

    private static string Name(ValidScene scene, IReadOnlyList<int> gameObjects) =>
        gameObjects.Count == 0 ? "nothing" : scene.Document.GameObjects[gameObjects[0]].Name;

    private static string Text(int number) => number.ToString(CultureInfo.InvariantCulture);
}
