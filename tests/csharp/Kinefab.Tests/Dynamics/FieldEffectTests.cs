using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>Every field of body, joint and physics that the scene format has decides a motion, or stands in the list of those that cannot.</summary>
public sealed class FieldEffectTests
{
    private const string Slide =
        "\"yMotion\": \"Locked\", \"zMotion\": \"Locked\", \"angularXMotion\": \"Locked\", \"angularYMotion\": \"Locked\", \"angularZMotion\": \"Locked\"";

    private const string Pin = "\"xMotion\": \"Locked\", \"yMotion\": \"Locked\", \"zMotion\": \"Locked\"";

    private const string Twist = Pin + ", \"angularYMotion\": \"Locked\", \"angularZMotion\": \"Locked\"";

    /// <summary>Rows in turn, so that few iterations leave a gap.</summary>
    private const string Loose = ", \"enablePreprocessing\": false, \"anchor\": [0.4, 0.3, 0.2]";

    private const string Apart =
        Slide + ", \"xMotion\": \"Locked\", \"autoConfigureConnectedAnchor\": false, \"connectedAnchor\": [1, 0, 0]" + Loose;

    private const string OneIteration = "\"solverIterations\": 1";

    private static readonly Vector3d X = Vector3d.UnitX;
    private static readonly Vector3d Y = Vector3d.UnitY;
    private static readonly Vector3d Z = Vector3d.UnitZ;

    private static readonly string[] Nouns = ["HingeJoint", "ConfigurableJoint", "FixedJoint", "Rigidbody", "physics"];

    /// <summary>Fields that move nothing here, and why.</summary>
    private static readonly Dictionary<string, string> Without = new()
    {
        ["enableCollision"] = "no contacts",
        ["Rigidbody.collisionDetectionMode"] = "no contacts",
        ["Rigidbody.interpolation"] = "what is drawn, not what moves",
        ["physics.bounceThreshold"] = "contacts alone bounce by it",
        ["physics.fixedTimestep"] = "the caller steps",
        ["enabled"] = "a joint that is switched off is none: DisabledJointTests",
        ["id"] = "information",
        ["name"] = "information",
        ["part"] = "information",
        ["connectedPart"] = "information",
        ["effort"] = "information, told by JOINT_STATED_UNFOLLOWED",
        ["speed"] = "as above",
        ["friction"] = "as above",
        ["armature"] = "as above",
        ["ConfigurableJoint.stated"] = "as above, of each coordinate",
        ["because"] = "information",
        ["closure"] = "information",
        ["exact"] = "information",
        ["ConfigurableJoint.lowAngularXLimit.bounciness"] = "PhysX has one response for both ends; the upper end's counts",
        ["ConfigurableJoint.lowAngularXLimit.contactDistance"] = "as above",
        ["ConfigurableJoint.angularZLimit.bounciness"] = "PhysX has one response for the cone; Y's counts",
        ["ConfigurableJoint.angularZLimit.contactDistance"] = "as above",
    };

    private static IEnumerable<FieldEffect> Effects() => Bodies().Concat(Hinges()).Concat(Fixed()).Concat(ConfigurableFrames())
        .Concat(ConfigurableLimits()).Concat(ConfigurableDrives()).Concat(Anchored("HingeJoint")).Concat(Anchored("ConfigurableJoint"));

    private static IEnumerable<FieldEffect> Bodies() =>
    [
        new("physics.gravity", "[0, -3, 0]"),
        new("physics.solverIterations", "30") { Joint = Apart, Physics = OneIteration, Connected = true },
        new("physics.solverVelocityIterations", "30") { Joint = Apart, Physics = OneIteration, Connected = true },
        new("physics.defaultMaxAngularSpeed", "3") { Own = "\"maxAngularVelocity\": null", Spin = 6 * Z },
        new("Rigidbody.mass", "5") { Joint = "\"yDrive\": {\"positionSpring\": 20}, \"targetPosition\": [0, 1, 0]" },
        new("Rigidbody.linearDamping", "2") { Push = X },
        new("Rigidbody.angularDamping", "2") { Spin = Z },
        new("Rigidbody.centerOfMass", "[0.2, 0, 0]") { Spin = Z },
        new("Rigidbody.inertiaTensor", "[2, 2, 3]") { Joint = Pin + ", \"anchor\": [0.5, 0, 0]", Push = Y },
        new("Rigidbody.inertiaTensorRotation", "[0, 0.7071067811865476, 0, 0.7071067811865476]") { Own = "\"inertiaTensor\": [2, 1.2, 1]", Joint = Pin + ", \"anchor\": [0.5, 0, 0]", Push = Y },
        new("Rigidbody.useGravity", "false") { Physics = "" },
        new("Rigidbody.isKinematic", "true") { Physics = "" },
        new("Rigidbody.constraints", "[\"FreezePositionY\"]") { Physics = "" },
        new("Rigidbody.maxAngularVelocity", "3") { Spin = 6 * Z },
        new("Rigidbody.solverIterations", "30") { Joint = Apart, Physics = OneIteration, Connected = true },
        new("Rigidbody.solverVelocityIterations", "30") { Joint = Apart, Physics = OneIteration, Connected = true },
    ];

    /// <summary>What all joints share, shown on each of them.</summary>
    private static IEnumerable<FieldEffect> Shared(string joint, string fields) =>
    [
        new($"{joint}.connectedBody", "1") { Joint = fields, Push = X },
        new($"{joint}.breakForce", "5") { Joint = fields, Push = X, Spin = new(0.3, 0.2, 0.1), Connected = true },
        new($"{joint}.breakTorque", "1") { Joint = fields, Spin = new(3, 2, 1), Connected = true },
        new($"{joint}.enablePreprocessing", "false") { Joint = fields, Push = new(1, 2, 3), Spin = new(3, 2, 1), Connected = true, Physics = "\"gravity\": [0, 0, 0], \"solverIterations\": 1" },
        new($"{joint}.massScale", "3") { Joint = fields, Push = X, Connected = true },
        new($"{joint}.connectedMassScale", "3") { Joint = fields, Push = X, Connected = true },
    ];

    private static IEnumerable<FieldEffect> Anchored(string joint)
    {
        string pin = joint == "HingeJoint" ? "" : Twist;
        string given = Comma(pin) + "\"autoConfigureConnectedAnchor\": false, \"connectedAnchor\": [0.3, 0.2, 0.1]";
        return
        [
            .. Shared(joint, pin),
            new($"{joint}.anchor", "[0.4, 0, 0]") { Joint = Comma(pin) + "\"axis\": [0, 0, 1]", Push = Y },
            new($"{joint}.axis", "[0, 0, 1]") { Joint = pin, Spin = Z },
            new($"{joint}.autoConfigureConnectedAnchor", "true") { Joint = given },
            new($"{joint}.connectedAnchor", "[0, 0.5, 0]") { Joint = given },
        ];
    }

    private static IEnumerable<FieldEffect> Fixed() => Shared("FixedJoint", "");

    private static IEnumerable<FieldEffect> Hinges()
    {
        const string spring = "\"useSpring\": true, \"spring\": {\"spring\": 20, \"damper\": 1, \"targetPosition\": 30}";
        const string motor = "\"useMotor\": true, \"motor\": {\"targetVelocity\": 90, \"force\": 1}";
        const string limits = "\"useLimits\": true, \"limits\": {\"min\": -5, \"max\": 15}";
        return
        [
            new("HingeJoint.useSpring", "false") { Joint = spring },
            new("HingeJoint.spring.spring", "60") { Joint = spring },
            new("HingeJoint.spring.damper", "9") { Joint = spring },
            new("HingeJoint.spring.targetPosition", "-30") { Joint = spring },
            new("HingeJoint.useAcceleration", "true") { Joint = spring, Own = "\"inertiaTensor\": [4, 4, 4]" },
            new("HingeJoint.useMotor", "false") { Joint = motor },
            new("HingeJoint.motor.targetVelocity", "-90") { Joint = motor },
            new("HingeJoint.motor.force", "3") { Joint = motor },
            new("HingeJoint.motor.freeSpin", "true") { Joint = motor, Spin = 5 * X },
            new("HingeJoint.useLimits", "false") { Joint = limits, Spin = X },
            new("HingeJoint.limits.min", "-20") { Joint = limits, Spin = -1 * X },
            new("HingeJoint.limits.max", "40") { Joint = limits, Spin = X },
            new("HingeJoint.limits.bounciness", "0.9") { Joint = limits, Spin = X },
            new("HingeJoint.limits.bounceMinVelocity", "90") { Joint = limits.Replace("15", "15, \"bounciness\": 0.9", StringComparison.Ordinal), Spin = X },
            new("HingeJoint.limits.contactDistance", "0.1") { Joint = limits.Replace("15", "15, \"bounciness\": 0.9", StringComparison.Ordinal), Spin = X },
            new("HingeJoint.extendedLimits", "true") { Joint = "\"useLimits\": true, \"limits\": {\"min\": -5, \"max\": 240}", Spin = 5 * X },
        ];
    }

    private static IEnumerable<FieldEffect> ConfigurableFrames() =>
    [
        new("ConfigurableJoint.secondaryAxis", "[0, 0, 1]") { Joint = "\"yMotion\": \"Locked\"", Push = Y },
        new("ConfigurableJoint.xMotion", "\"Locked\"") { Push = X },
        new("ConfigurableJoint.yMotion", "\"Locked\"") { Push = Y },
        new("ConfigurableJoint.zMotion", "\"Locked\"") { Push = Z },
        new("ConfigurableJoint.angularXMotion", "\"Locked\"") { Spin = X },
        new("ConfigurableJoint.angularYMotion", "\"Locked\"") { Spin = Y },
        new("ConfigurableJoint.angularZMotion", "\"Locked\"") { Spin = Z },
        new("ConfigurableJoint.configuredInWorldSpace", "true") { Joint = "\"axis\": [0, 0, 1], \"xMotion\": \"Locked\"", Push = new(1, 0, 1), Turned = true },
        new("ConfigurableJoint.swapBodies", "true") { Joint = Slide.Replace("\"angularZMotion\": \"Locked\"", "\"angularZMotion\": \"Free\"", StringComparison.Ordinal), Push = X, Spin = 2 * Z },
        new("ConfigurableJoint.projectionMode", "\"PositionAndRotation\"") { Joint = Apart, Physics = OneIteration, Connected = true },
        new("ConfigurableJoint.projectionDistance", "0.001") { Joint = Apart + ", \"projectionMode\": \"PositionAndRotation\", \"projectionDistance\": 10", Physics = OneIteration, Connected = true },
        new("ConfigurableJoint.projectionAngle", "0.1") { Joint = Apart + ", \"projectionMode\": \"PositionAndRotation\", \"projectionDistance\": 10", Physics = OneIteration, Connected = true, Own = "\"inertiaTensor\": [0.1, 0.3, 0.25], \"inertiaTensorRotation\": [0.19119215, 0.38238429, 0.38238429, 0.81915204]", Spin = new(20, 30, 40) },
    ];

    private static IEnumerable<FieldEffect> ConfigurableLimits()
    {
        const string linear = Slide + ", \"xMotion\": \"Limited\", \"linearLimit\": {\"limit\": 0.1}";
        const string twist = Twist + ", \"angularXMotion\": \"Limited\", \"lowAngularXLimit\": {\"limit\": -10}, \"highAngularXLimit\": {\"limit\": 20}";
        const string swing = Pin + ", \"angularXMotion\": \"Locked\", \"angularYMotion\": \"Limited\", \"angularZMotion\": \"Limited\", \"angularYLimit\": {\"limit\": 10}, \"angularZLimit\": {\"limit\": 15}";
        return
        [
            new("ConfigurableJoint.linearLimit.limit", "0.3") { Joint = linear, Push = X },
            .. Response("linearLimit", "linearLimitSpring", linear, X, default, "0.2"),
            new("ConfigurableJoint.highAngularXLimit.limit", "40") { Joint = twist, Spin = -1 * X },
            new("ConfigurableJoint.lowAngularXLimit.limit", "-40") { Joint = twist, Spin = X },
            .. Response("highAngularXLimit", "angularXLimitSpring", twist, default, -1 * X, "15"),
            new("ConfigurableJoint.angularYLimit.limit", "30") { Joint = swing, Spin = Y },
            new("ConfigurableJoint.angularZLimit.limit", "30") { Joint = swing, Spin = Z },
            .. Response("angularYLimit", "angularYZLimitSpring", swing, default, Y, "9"),
        ];
    }

    // A limit's bounce, and its springs; the contact distance shows where the bounce comes a step sooner.
    private static IEnumerable<FieldEffect> Response(string limit, string spring, string fields, Vector3d push, Vector3d spin, string far)
    {
        string path = "ConfigurableJoint." + limit;
        return
        [
            new($"{path}.bounciness", "0.9") { Joint = fields, Push = push, Spin = spin },
            new($"{path}.contactDistance", far) { Joint = Bouncy(fields, limit), Push = push, Spin = spin },
            new($"ConfigurableJoint.{spring}.spring", "30") { Joint = fields, Push = push, Spin = spin },
            new($"ConfigurableJoint.{spring}.damper", "2") { Joint = fields, Push = push, Spin = spin },
        ];
    }

    private static string Bouncy(string fields, string limit)
    {
        int end = fields.IndexOf('}', fields.IndexOf($"\"{limit}\"", StringComparison.Ordinal));
        return fields.Insert(end, ", \"bounciness\": 0.9");
    }

    private static IEnumerable<FieldEffect> ConfigurableDrives()
    {
        const string target = "\"targetPosition\": [0.5, 0.4, 0.3], \"targetRotation\": [0.19866933, 0, 0, 0.98006658]";
        const string swung = "\"targetRotation\": [0, 0.19866933, 0, 0.98006658]";
        return
        [
            new("ConfigurableJoint.targetPosition", "[-0.5, 0.2, 0.1]") { Joint = "\"xDrive\": {\"positionSpring\": 9}, " + target },
            new("ConfigurableJoint.targetVelocity", "[1, 0, 0]") { Joint = "\"xDrive\": {\"positionDamper\": 9}" },
            new("ConfigurableJoint.targetRotation", "[-0.19866933, 0, 0, 0.98006658]") { Joint = "\"angularXDrive\": {\"positionSpring\": 9}, " + target },
            new("ConfigurableJoint.targetAngularVelocity", "[1, 0, 0]") { Joint = "\"angularXDrive\": {\"positionDamper\": 9}" },
            new("ConfigurableJoint.rotationDriveMode", "\"Slerp\"") { Joint = "\"angularXDrive\": {\"positionSpring\": 9}, " + target },
            .. Drive("xDrive", target, X, default),
            .. Drive("yDrive", target, Y, default),
            .. Drive("zDrive", target, Z, default),
            .. Drive("angularXDrive", target, default, X),
            .. Drive("angularYZDrive", swung, default, Y),
            .. Drive("slerpDrive", target + ", \"rotationDriveMode\": \"Slerp\"", default, X),
        ];
    }

    private static IEnumerable<FieldEffect> Drive(string drive, string target, Vector3d push, Vector3d spin)
    {
        string path = "ConfigurableJoint." + drive;
        string fields = $"\"{drive}\": {{\"positionSpring\": 30, \"positionDamper\": 1}}, {target}";
        const string heavy = "\"mass\": 4, \"inertiaTensor\": [4, 4, 4]";
        return
        [
            new($"{path}.positionSpring", "90") { Joint = fields, Own = heavy },
            new($"{path}.positionDamper", "20") { Joint = fields, Own = heavy, Push = push, Spin = spin },
            new($"{path}.maximumForce", "0.5") { Joint = fields, Own = heavy },
            new($"{path}.useAcceleration", "true") { Joint = fields, Own = heavy },
        ];
    }

    [TestCaseSource(nameof(Effects))]
    public void Field_Changed_ChangesTheMotion(object effect) => Assert.That(((FieldEffect)effect).Measure(), Is.GreaterThan(1e-3));

    [Test]
    public void Fields_OfTheSchema_AllHaveACase()
    {
        string schema = Path.Combine(Scenario.Folder, "..", "..", "schemas", "scene.schema.json");
        JsonElement definitions = JsonDocument.Parse(File.ReadAllText(schema)).RootElement.GetProperty("$defs");
        IEnumerable<string> fields = Nouns
            .SelectMany(name => Leaves(definitions, definitions.GetProperty(name), name))
            .Where(field => !Without.ContainsKey(field) && !Without.ContainsKey(field.Split('.')[^1]));

        Assert.That(Effects().Select(e => e.Path), Is.EquivalentTo(fields));
    }

    private static IEnumerable<string> Leaves(JsonElement definitions, JsonElement definition, string path)
    {
        foreach (JsonProperty property in definition.GetProperty("properties").EnumerateObject())
        {
            string field = $"{path}.{property.Name}";
            if (property.Name is "type" or "extras")
            {
                continue;
            }

            if (property.Value.TryGetProperty("$ref", out JsonElement reference)
                && definitions.GetProperty(reference.GetString()!.Split('/')[^1]) is { } noun && noun.TryGetProperty("properties", out _))
            {
                foreach (string leaf in Leaves(definitions, noun, field))
                {
                    yield return leaf;
                }
            }
            else
            {
                yield return field;
            }
        }
    }

    private static string Comma(string fields) => fields.Length > 0 ? fields + ", " : "";
}
