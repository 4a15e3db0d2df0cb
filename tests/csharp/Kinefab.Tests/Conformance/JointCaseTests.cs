using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Conformance;

/// <summary>Unity components that the exporter makes of joints: the ranges read off them must let through the allowed poses alone.</summary>
public class JointCaseTests
{
    private const double Tolerance = 1e-6;

    private static IEnumerable<string> Paths => ConformanceCases.All.Where(entry => entry.Kind == "joints").Select(entry => entry.Path);

    [TestCaseSource(nameof(Paths))]
    public void Component_AtTheSampledPoses_AllowsWhatTheCaseAllows(string path)
    {
        using JsonDocument content = JsonDocument.Parse(File.ReadAllText(Path.Combine(ConformanceCases.Folder, path)));
        JsonElement samples = content.RootElement.GetProperty("samples");
        JsonElement start = samples.EnumerateArray().First(sample => IsStart(sample, content.RootElement));
        ValidScene scene = SceneOf(content.RootElement.GetProperty("component"), start);
        foreach (JsonElement sample in samples.EnumerateArray())
        {
            bool allowed = scene.Freedoms(1, 1).All(freedom => Within(freedom, Value(freedom.Coordinate, scene, sample)));
            Assert.That(allowed, Is.EqualTo(sample.GetProperty("allowed").GetBoolean()), sample.GetProperty("coordinate").GetRawText());
        }
    }

    private static bool IsStart(JsonElement sample, JsonElement content) => sample.GetProperty("coordinate").EnumerateObject().All(coordinate =>
    {
        double value = content.GetProperty("joint").GetProperty("freedoms").TryGetProperty(coordinate.Name, out JsonElement freedom)
            ? freedom.GetProperty("value").GetDouble()
            : 0;
        return coordinate.Value.GetDouble() == value;
    });

    /// <summary>The component between two bodies at their start poses; nothing about it may be worth a warning.</summary>
    private static ValidScene SceneOf(JsonElement component, JsonElement start)
    {
        string connected = start.TryGetProperty("connected", out JsonElement pose) ? Transform(pose) : "{}";
        string joint = component.GetRawText();
        if (pose.ValueKind == JsonValueKind.Object)
            joint = joint.Insert(1, "\"connectedBody\": 0, ");
        string text = $$"""
            {"format": "kinefab.scene", "version": "1.0", "gameObjects": [
              {"id": "connected", "name": "", "transform": {{connected}}, "components": [{"type": "Rigidbody"}]},
              {"id": "own", "name": "", "transform": {{Transform(start.GetProperty("own"))}}, "components": [{"type": "Rigidbody"}, {{joint}}]}]}
            """;
        SceneReading reading = SceneFile.Parse(Encoding.UTF8.GetBytes(text));
        Assert.That(reading.Report.Diagnostics, Is.Empty);
        SceneValidation validation = SceneValidator.Validate(reading.Document!);
        Assert.That(validation.Report.Diagnostics, Is.Empty);
        return validation.Scene!;
    }

    private static string Transform(JsonElement pose) =>
        $$"""{"localPosition": {{pose.GetProperty("position").GetRawText()}}, "localRotation": {{pose.GetProperty("rotation").GetRawText()}}}""";

    private static bool Within(JointFreedom freedom, double value) => value > freedom.Lower - Tolerance && value < freedom.Upper + Tolerance;

    /// <summary>The coordinate's definition: motion of the own body against the connected one since start-up, left-hand rule.</summary>
    private static double Value(Coordinate coordinate, ValidScene scene, JsonElement sample)
    {
        var joint = (AnchoredJoint)scene.Document.GameObjects[1].Components[1];
        Pose own = PoseOf(sample.GetProperty("own"));
        Pose connected = sample.TryGetProperty("connected", out JsonElement pose) ? PoseOf(pose) : Pose.Identity;
        Pose connectedStart = joint.ConnectedBody is null ? Pose.Identity : scene.WorldTransform(0).Pose;
        Pose relativeStart = connectedStart.Inverse() * scene.WorldTransform(1).Pose, relative = connected.Inverse() * own;
        Vector3d axis = AxisOf(coordinate, joint);
        if (coordinate is Coordinate.X or Coordinate.Y or Coordinate.Z)
            return Vector3d.Dot(relative.Point(joint.Anchor) - relativeStart.Point(joint.Anchor), relativeStart.Rotation * axis);
        Quaterniond turn = relativeStart.Rotation.Conjugate() * relative.Rotation;
        double angle = 2 * Math.Atan2(Vector3d.Dot(turn.Vector, axis), turn.W) * 180 / Math.PI;
        return angle > 180 ? angle - 360 : angle < -180 ? angle + 360 : angle;
    }

    private static Vector3d AxisOf(Coordinate coordinate, AnchoredJoint joint)
    {
        Vector3d x = joint.Axis.Normalized();
        Vector3d y = joint is ConfigurableJoint configurable ? configurable.SecondaryAxis.Normalized() : x;
        return coordinate switch
        {
            Coordinate.Y or Coordinate.AngularY => y,
            Coordinate.Z or Coordinate.AngularZ => Vector3d.Cross(x, y),
            _ => x,
        };
    }

    private static Pose PoseOf(JsonElement pose)
    {
        double[] p = Numbers(pose.GetProperty("position")), q = Numbers(pose.GetProperty("rotation"));
        return new Pose(new Vector3d(p[0], p[1], p[2]), new Quaterniond(q[0], q[1], q[2], q[3]));
    }

    private static double[] Numbers(JsonElement array) => array.EnumerateArray().Select(number => number.GetDouble()).ToArray();
}
