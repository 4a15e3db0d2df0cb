using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using System.Text.Json.Nodes;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>
/// A field of the scene format and a scene in which it decides the motion: an own body (object 0) that carries the joint,
/// pushed at the start, and a second one (object 1) that the joint connects unless it is held by the world.
/// </summary>
/// <param name="Path">Component or "physics", and the field: "HingeJoint.limits.max".</param>
/// <param name="Value">What it is set to, JSON; before that it has the value in the scene or its default.</param>
internal sealed record FieldEffect(string Path, string Value)
{
    private const double Dt = 0.02;
    private const int Steps = 60;
    private const string TurnedTransform = "\"localRotation\": [0.19119215, 0.38238429, 0.38238429, 0.81915204]";

    /// <summary>Fields of the joint, JSON without braces.</summary>
    public string Joint { get; init; } = "";

    /// <summary>Fields of the own Rigidbody.</summary>
    public string Own { get; init; } = "";

    /// <summary>Fields of physics; without them there is no gravity.</summary>
    public string Physics { get; init; } = "\"gravity\": [0, 0, 0]";

    public Vector3d Push { get; init; }

    public Vector3d Spin { get; init; }

    /// <summary>Whether the joint holds the own body to object 1 and not to the world.</summary>
    public bool Connected { get; init; }

    /// <summary>Whether the own body starts at a turn of 70 degrees about (1, 2, 2).</summary>
    public bool Turned { get; init; }

    public override string ToString() => Path;

    /// <summary>How far the motions with and without the value part: metres and parts of a quaternion, or 1 when a joint breaks in one alone.</summary>
    public double Measure()
    {
        World without = Make(false);
        World with = Make(true);
        double most = 0;
        for (int i = 0; i < Steps; i++)
        {
            without.Step(Dt);
            with.Step(Dt);
            for (int b = 0; b < with.Bodies.Count; b++)
            {
                Pose p = without.Bodies[b].Pose;
                Pose q = with.Bodies[b].Pose;
                most = Math.Max(most, Math.Max((p.Position - q.Position).Length, (p.Rotation.Conjugate() * q.Rotation).Vector.Length));
            }

            most = with.Joints[0].IsBroken != without.Joints[0].IsBroken ? Math.Max(most, 1) : most;
        }

        return most;
    }

    private World Make(bool changed)
    {
        string type = Path.Split('.')[0];
        bool ofBody = type is "Rigidbody" or "physics";
        string connected = Connected ? "\"connectedBody\": 1" : "";
        var joint = Fields($"\"type\": \"{(ofBody ? "ConfigurableJoint" : type)}\"", connected, Joint);
        var own = Fields("\"type\": \"Rigidbody\"", "\"angularDamping\": 0, \"maxAngularVelocity\": 100", Own);
        var physics = Fields(Physics);
        if (changed)
        {
            Set(type == "physics" ? physics : type == "Rigidbody" ? own : joint, Path.Split('.').Skip(1), JsonNode.Parse(Value)!);
        }

        var scene = new JsonObject
        {
            ["format"] = "kinefab.scene",
            ["version"] = "1.0",
            ["physics"] = physics,
            ["gameObjects"] = new JsonArray(
                new JsonObject { ["id"] = "own", ["name"] = "own", ["transform"] = Fields(Turned ? TurnedTransform : ""), ["components"] = new JsonArray(own, joint) },
                new JsonObject { ["id"] = "other", ["name"] = "other", ["transform"] = Fields("\"localPosition\": [0.3, 0.2, 0]"), ["components"] = new JsonArray(Fields("\"type\": \"Rigidbody\", \"mass\": 3")) }),
        };
        SceneReading reading = SceneFile.Parse(Encoding.UTF8.GetBytes(scene.ToJsonString()));
        Assert.That(reading.Document, Is.Not.Null, reading.Report.ToString());
        SceneValidation validation = SceneValidator.Validate(reading.Document!);
        Assert.That(validation.Scene, Is.Not.Null, string.Join('\n', validation.Report.Diagnostics));
        World world = World.Create(validation.Scene!);
        world.Bodies[0].LinearVelocity = Push;
        world.Bodies[0].AngularVelocity = Spin;
        return world;
    }

    // Later fields replace earlier ones of the same name; null takes one away.
    private static JsonObject Fields(params string[] parts)
    {
        var all = new JsonObject();
        foreach (KeyValuePair<string, JsonNode?> field in parts.SelectMany(p => (JsonObject)JsonNode.Parse("{" + p + "}")!))
        {
            all.Remove(field.Key);
            if (field.Value is { } value)
            {
                all[field.Key] = value.DeepClone();
            }
        }

        return all;
    }

    private static void Set(JsonObject target, IEnumerable<string> path, JsonNode value)
    {
        string[] names = [.. path];
        foreach (string name in names[..^1])
        {
            target[name] ??= new JsonObject();
            target = (JsonObject)target[name]!;
        }

        target[names[^1]] = value;
    }
}
