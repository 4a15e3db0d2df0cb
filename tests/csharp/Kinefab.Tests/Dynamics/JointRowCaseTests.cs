using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.Json;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

/// <summary>
/// tests/conformance/joints: the rows of the component that the exporter makes of a CAD joint let through the poses that the CAD joint
/// has, and no others.
/// </summary>
public sealed class JointRowCaseTests
{
    private const double Tolerance = 1e-6;

    private static IEnumerable<string> Paths => ConformanceCases.All.Where(entry => entry.Kind == "joints").Select(entry => entry.Path);

    [TestCaseSource(nameof(Paths))]
    public void Rows_AtTheSampledPoses_AllowWhatTheCaseAllows(string path)
    {
        using JsonDocument content = JsonDocument.Parse(File.ReadAllText(Path.Combine(ConformanceCases.Folder, path)));
        JsonElement[] samples = content.RootElement.GetProperty("samples").EnumerateArray().ToArray();
        World world = Create(content.RootElement.GetProperty("component"), samples.First(s => IsStart(s, content.RootElement)));
        WorldBody own = world.Bodies.Single(b => b.Id == "own");
        WorldBody? connected = world.Bodies.SingleOrDefault(b => b.Id == "connected");
        foreach (JsonElement sample in samples)
        {
            own.Pose = PoseOf(sample.GetProperty("own"));
            if (connected != null && sample.TryGetProperty("connected", out JsonElement pose))
            {
                connected.Pose = PoseOf(pose);
            }

            Assert.That(IsAllowed(world), Is.EqualTo(sample.GetProperty("allowed").GetBoolean()), sample.GetProperty("coordinate").GetRawText());
        }
    }

    private static bool IsAllowed(World world)
    {
        Kinefab.Joints.JointModel joint = world.Joints[0].Solved;
        Pose Of(int body) => body < 0 ? Pose.Identity : world.Bodies[body].Pose;
        var rows = new ConstraintRow[Kinefab.Joints.JointModel.MaxRows];
        // Centres of mass are at the objects' origins here, so objects' poses are bodies' poses.
        int count = joint.Prepare(Of(joint.Body0), Of(joint.Body1), rows);
        return rows.Take(count).All(r =>
            (r.Hint != SolveHint.Equality || Math.Abs(r.GeometricError) < Tolerance) && (!r.Has(RowFlags.Limit) || r.GeometricError > -Tolerance));
    }

    private static bool IsStart(JsonElement sample, JsonElement content)
    {
        JsonElement freedoms = content.GetProperty("joint").GetProperty("freedoms");
        return sample.GetProperty("coordinate").EnumerateObject().All(c =>
            c.Value.GetDouble() == (freedoms.TryGetProperty(c.Name, out JsonElement freedom) ? freedom.GetProperty("value").GetDouble() : 0));
    }

    private static World Create(JsonElement component, JsonElement start)
    {
        bool isHeld = start.TryGetProperty("connected", out JsonElement connected);
        string joint = isHeld ? component.GetRawText().Insert(1, "\"connectedBody\": 1, ") : component.GetRawText();
        string held = isHeld ? $$""", {"id": "connected", "name": "", "transform": {{Transform(connected)}}, "components": [{"type": "Rigidbody"}]}""" : "";
        string text = $$"""
            {"format": "kinefab.scene", "version": "1.0", "gameObjects": [
              {"id": "own", "name": "", "transform": {{Transform(start.GetProperty("own"))}}, "components": [{"type": "Rigidbody"}, {{joint}}]}{{held}}]}
            """;
        SceneDocument? document = SceneFile.Parse(Encoding.UTF8.GetBytes(text)).Document;
        Assert.That(document, Is.Not.Null);
        return World.Create(SmallScene.Validate(document!));
    }

    private static string Transform(JsonElement pose) =>
        $$"""{"localPosition": {{pose.GetProperty("position").GetRawText()}}, "localRotation": {{pose.GetProperty("rotation").GetRawText()}}}""";

    private static Pose PoseOf(JsonElement pose)
    {
        double[] p = pose.GetProperty("position").EnumerateArray().Select(e => e.GetDouble()).ToArray();
        double[] q = pose.GetProperty("rotation").EnumerateArray().Select(e => e.GetDouble()).ToArray();
        return new Pose(new Vector3d(p[0], p[1], p[2]), new Quaterniond(q[0], q[1], q[2], q[3]));
    }
}
