using System;
using System.Collections.Generic;
using System.CommandLine;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Diagnostics;
using Kinefab.Kinematics;
using Kinefab.Validation;

namespace Kinefab.Cli.Commands;

/// <summary>dotnet kinefab mobility FILES [--json] [--junit FILE].</summary>
internal static class MobilityCommand
{
    internal static Command Create()
    {
        var scenes = new SceneArguments();
        var command = new Command("mobility", "Count what the joints leave free and hold it against the file's own analysis.");
        scenes.AddTo(command);
        command.SetAction(parsed =>
        {
            SceneBatch batch = scenes.Of(parsed);
            return batch.Run(file => Run(file, batch.IsJson));
        });
        return command;
    }

    private static SceneOutcome Run(string file, bool json)
    {
        LoadedScene loaded = LoadedScene.Load(file, strict: false);
        MobilityReport? counted = loaded.Scene is null ? null : Mechanism.Create(loaded.Scene).CountMobility();
        Report report = counted is null ? loaded.Report : loaded.Report.Concat(MobilityCheck.Compare(loaded.Scene!, counted));
        if (!json)
        {
            ReportWriter.WriteLines(file, report, Console.Error);
            if (counted is not null)
                Write(loaded.Scene!, counted, Console.Out);
        }

        return new SceneOutcome(report.HasErrors ? 1 : 0, report, Fields: counted is null ? null : target => Write(counted, target));
    }

    private static void Write(ValidScene scene, MobilityReport counted, TextWriter target)
    {
        foreach (BodyMobility body in counted.Bodies)
            target.WriteLine($"body       {Id(scene, body.GameObject)}: {Counted.Of(body.Translations, "translation", "translations")}, {Counted.Of(body.Rotations, "rotation", "rotations")}");
        foreach (RedundantRows joint in counted.Joints)
            target.WriteLine($"redundant  {Id(scene, joint.GameObject)} components[{joint.Component}]: {joint.Redundant} of {joint.Rows} rows");
        foreach (IdleFreedom idle in counted.Idle)
            target.WriteLine($"idle       {string.Join(", ", idle.GameObjects.Select(o => Id(scene, o)))}: {Counted.Of(idle.Count, "freedom moves", "freedoms move")} nothing else");
        foreach (IslandMobility island in counted.Islands)
            target.WriteLine($"island     {Id(scene, island.GameObjects[0])} and {island.GameObjects.Count - 1} more: mobility {island.Mobility}, {island.Redundant} redundant, {Counted.Of(island.Loops, "loop", "loops")}");
        if (counted.Gap < 100)
            target.WriteLine($"unsure     the rank's gap is only {counted.Gap:F0}");
        string firstOrder = counted.FirstOrder == counted.Mobility ? "" : $" ({counted.FirstOrder} at first order)";
        if (counted.AtGeneralPose > counted.Mobility)
            target.WriteLine($"singular   at every pose: {counted.AtGeneralPose} freedoms at first order in general position too");
        string stated = scene.Document.Analysis is null ? "" : $", {scene.Document.Analysis.Mobility} in the file";
        target.WriteLine($"mobility   {counted.Mobility}{firstOrder}{stated}; {counted.Rows} rows, {counted.Redundant} redundant");
    }

    private static void Write(MobilityReport counted, Utf8JsonWriter json)
    {
        json.WriteStartObject("mobility");
        json.WriteNumber("mobility", counted.Mobility);
        json.WriteNumber("firstOrderMobility", counted.FirstOrder);
        json.WriteNumber("firstOrderAtGeneralPose", counted.AtGeneralPose);
        json.WriteNumber("rows", counted.Rows);
        json.WriteNumber("redundant", counted.Redundant);
        json.WriteStartArray("islands");
        foreach (IslandMobility island in counted.Islands)
        {
            json.WriteStartObject();
            WriteGameObjects(island.GameObjects, json);
            json.WriteNumber("mobility", island.Mobility);
            json.WriteNumber("firstOrderMobility", island.FirstOrder);
            json.WriteNumber("redundant", island.Redundant);
            json.WriteNumber("loops", island.Loops);
            json.WriteEndObject();
        }

        json.WriteEndArray();
        json.WriteStartArray("bodies");
        foreach (BodyMobility body in counted.Bodies)
        {
            json.WriteStartObject();
            json.WriteNumber("gameObject", body.GameObject);
            json.WriteNumber("translations", body.Translations);
            json.WriteNumber("rotations", body.Rotations);
            json.WriteEndObject();
        }

        json.WriteEndArray();
        json.WriteStartArray("idle");
        foreach (IdleFreedom idle in counted.Idle)
        {
            json.WriteStartObject();
            WriteGameObjects(idle.GameObjects, json);
            json.WriteNumber("count", idle.Count);
            json.WriteEndObject();
        }

        json.WriteEndArray();
        json.WriteStartArray("redundantJoints");
        foreach (RedundantRows joint in counted.Joints)
        {
            json.WriteStartObject();
            json.WriteNumber("gameObject", joint.GameObject);
            json.WriteNumber("component", joint.Component);
            json.WriteNumber("rows", joint.Rows);
            json.WriteNumber("redundant", joint.Redundant);
            json.WriteEndObject();
        }

        json.WriteEndArray();
        json.WriteEndObject();
    }

    private static void WriteGameObjects(IReadOnlyList<int> gameObjects, Utf8JsonWriter json)
    {
        json.WriteStartArray("gameObjects");
        foreach (int gameObject in gameObjects)
            json.WriteNumberValue(gameObject);
        json.WriteEndArray();
    }

    private static string Id(ValidScene scene, int gameObject) => Printable.Text(scene.Document.GameObjects[gameObject].Id);
}
