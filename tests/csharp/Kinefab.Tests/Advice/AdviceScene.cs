using System.IO;
using System.Linq;
using System.Text;
using System.Text.Json.Nodes;
using Kinefab.Document;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Advice;

/// <summary>Scene texts of bars of 0.2 m along +X, each jointed to the one before at its left end; gravity acts along -Y.</summary>
internal sealed class AdviceScene
{
    private const double Length = 0.2;
    private const double Width = 0.02;

    private readonly JsonArray _objects = [];

    /// <summary>The exported lever: its loop is closed by a joint with the least rows.</summary>
    public static string Lever { get; } = Path.GetFullPath(Path.Combine(Dynamics.Scenario.Folder, "..", "..", "fixtures", "lever", "lever.kinefab"));

    /// <summary>Adds a bar on a HingeJoint with these fields.</summary>
    public AdviceScene Hinged(double mass, string settings = "{}") => Add(mass, "HingeJoint", settings);

    /// <summary>A bar tied to nothing.</summary>
    public AdviceScene Loose(double mass)
    {
        Hinged(mass);
        _objects[^1]!["components"]!.AsArray().RemoveAt(1);
        return this;
    }

    /// <summary>As Hinged, by a ConfigurableJoint that leaves the turn about X, which stands along world Z.</summary>
    public AdviceScene Configured(double mass, string settings) => Add(
        mass,
        "ConfigurableJoint",
        settings,
        ("xMotion", "Locked"), ("yMotion", "Locked"), ("zMotion", "Locked"), ("angularYMotion", "Locked"), ("angularZMotion", "Locked"));

    /// <summary>Ties the last bar to the world instead of the bar before.</summary>
    public AdviceScene Apart()
    {
        ((JsonObject)_objects[^1]!["components"]![1]!).Remove("connectedBody");
        return this;
    }

    /// <summary>Changes the last body.</summary>
    public AdviceScene With(string field, params double[] value)
    {
        _objects[^1]!["components"]![0]![field] = value.Length == 1 ? value[0] : new JsonArray([.. value.Select(v => (JsonNode)v)]);
        return this;
    }

    public string Text(string physics = "{}") => new JsonObject
    {
        ["format"] = "kinefab.scene",
        ["version"] = "1.0",
        ["physics"] = JsonNode.Parse(physics),
        ["gameObjects"] = _objects.DeepClone(),
    }.ToJsonString();

    public ValidScene Read(string physics = "{}") => Parse(Text(physics));

    public static ValidScene Parse(string text)
    {
        SceneReading reading = SceneFile.Parse(Encoding.UTF8.GetBytes(text));
        Assert.That(reading.Document, Is.Not.Null, reading.Report.ToString());
        SceneValidation validation = SceneValidator.Validate(reading.Document!);
        Assert.That(validation.Scene, Is.Not.Null, string.Join("\n", validation.Report.Diagnostics));
        return validation.Scene!;
    }

    private AdviceScene Add(double mass, string type, string settings, params (string Name, string Value)[] fields)
    {
        int i = _objects.Count;
        var joint = new JsonObject { ["type"] = type, ["anchor"] = new JsonArray(-Length / 2, 0, 0), ["axis"] = new JsonArray(0, 0, 1) };
        if (i > 0)
            joint["connectedBody"] = i - 1;
        if (type == "ConfigurableJoint")
            joint["secondaryAxis"] = new JsonArray(1, 0, 0);
        foreach ((string name, string value) in fields)
            joint[name] = value;
        foreach ((string name, JsonNode? value) in JsonNode.Parse(settings)!.AsObject())
            joint[name] = value!.DeepClone();
        double thin = mass * Width * Width / 6;
        double across = mass * (Length * Length + Width * Width) / 12;
        _objects.Add(new JsonObject
        {
            ["id"] = "Bar" + i,
            ["name"] = "Bar" + i,
            ["transform"] = new JsonObject { ["localPosition"] = new JsonArray(Length * (i + 0.5), 0, 0) },
            ["components"] = new JsonArray(
                new JsonObject
                {
                    ["type"] = "Rigidbody",
                    ["mass"] = mass,
                    ["maxAngularVelocity"] = 1000,
                    ["angularDamping"] = 0,
                    ["inertiaTensor"] = new JsonArray(thin, across, across),
                },
                joint),
        });
        return this;
    }
}
