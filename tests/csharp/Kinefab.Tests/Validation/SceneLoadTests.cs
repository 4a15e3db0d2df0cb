using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using System.Threading;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Validation;

/// <summary>Scenes from paths, streams and memory in one call; warnings stay with the scene.</summary>
public sealed class SceneLoadTests
{
    private static readonly string Lever = Path.Combine(Kinefab.Tests.Dynamics.Scenario.Folder, "..", "..", "csharp", "examples", "LeverTests", "lever.kinefab");

    [Test]
    public void Load_StreamOrMemory_GivesTheSameAsThePath()
    {
        string path = ValidScene.Load(Lever).ToString();
        using var stream = new OnceOnly(File.ReadAllBytes(Lever));
        Assert.That(ValidScene.Load(stream, Buffer).ToString(), Is.EqualTo(path));
        Assert.That(ValidScene.Load(new ReadOnlyMemory<byte>(File.ReadAllBytes(Lever)), Buffer).ToString(), Is.EqualTo(path));
        Assert.That(() => ValidScene.Load(new ReadOnlyMemory<byte>(File.ReadAllBytes(Lever))), Throws.InstanceOf<SceneFormatException>(), "no buffers");
        Assert.That(Mechanism.Load(Lever).Scene.ToString(), Is.EqualTo(path));
        Assert.That(World.Load(Lever, SolverKind.Exact).Scene.ToString(), Is.EqualTo(path));
    }

    [Test]
    public void Load_StreamFromItsMiddle_StaysOpen()
    {
        byte[] text = [.. "junk"u8, .. File.ReadAllBytes(Lever)];
        using var stream = new MemoryStream(text) { Position = 4 };
        ValidScene.Load(stream, Buffer);
        Assert.That(stream.CanRead, Is.True);
        Assert.That(stream.Position, Is.EqualTo(stream.Length));
    }

    [Test]
    public void Load_LargerThanTheLimit_SaysSo()
    {
        using var stream = new OnceOnly(File.ReadAllBytes(Lever));
        var options = new SceneReadOptions { Limits = new SceneLimits { MaxFileBytes = 1000 } };
        Assert.That(() => ValidScene.Load(stream, Buffer, options), Throws.InstanceOf<SceneFormatException>().With.Message.Contains("SCENE_TOO_LARGE"));
    }

    [Test]
    public void Load_WarningsOfReadingAndValidating_StayWithTheScene()
    {
        const string text = """
            {"format": "kinefab.scene", "version": "1.0", "later": 1,
             "gameObjects": [{"id": "a", "name": "a", "components": [
               {"type": "Rigidbody"}, {"type": "HingeJoint", "useMotor": true, "useSpring": true, "motor": {"force": 1, "targetVelocity": 3}}]}]}
            """;
        ValidScene scene = ValidScene.Load(new ReadOnlyMemory<byte>(Encoding.UTF8.GetBytes(text)));
        Assert.That(scene.Report.HasErrors, Is.False);
        Assert.That(scene.Report.Diagnostics.Select(d => d.Code), Is.EqualTo(new[] { DiagnosticCodes.FieldUnknown, DiagnosticCodes.HingeMotorOverridesSpring }));
        Assert.That(SceneValidator.Validate(scene.Document).Scene!.Report.Diagnostics, Has.Count.EqualTo(1));
    }

    [Test]
    public void Load_Cancelled_Throws()
    {
        using var cancelled = new CancellationTokenSource();
        cancelled.Cancel();
        Assert.That(() => ValidScene.Load(Lever, null, cancelled.Token), Throws.InstanceOf<OperationCanceledException>());
        using var stream = new OnceOnly(File.ReadAllBytes(Lever));
        Assert.That(() => ValidScene.Load(stream, Buffer, null, cancelled.Token), Throws.InstanceOf<OperationCanceledException>());
        Assert.That(() => ValidScene.Load(new ReadOnlyMemory<byte>("{}"u8.ToArray()), null, null, cancelled.Token), Throws.InstanceOf<OperationCanceledException>());
    }

    [Test]
    public void Load_CancelledWhileTheTextIsRead_EndsThere()
    {
        var text = new StringBuilder("{\"format\":\"kinefab.scene\",\"version\":\"1.0\",\"gameObjects\":[{\"id\":\"0\",\"name\":\"root\"}");
        for (int i = 1; i <= 5_000; i++)
            text.Append(CultureInfo.InvariantCulture, $",{{\"id\":\"{i}\",\"name\":\"part\",\"parent\":0}}");
        text.Append("]}");
        using var cancellation = new CancellationTokenSource();
        var told = new List<double>();
        var options = new SceneReadOptions
        {
            Progress = new Called(share =>
            {
                told.Add(share);
                if (share > 0.4)
                    cancellation.Cancel();
            }),
        };
        Assert.That(() => ValidScene.Load(Encoding.UTF8.GetBytes(text.ToString()), null, options, cancellation.Token), Throws.InstanceOf<OperationCanceledException>());
        Assert.That(told, Is.Ordered.Ascending.And.Unique.And.All.LessThan(0.45));
        Assert.That(told.Count(share => share > 0.4), Is.EqualTo(1), "it goes on after it was cancelled");
    }

    [Test]
    public void Load_Progress_RisesToOne()
    {
        var told = new List<double>();
        ValidScene.Load(Lever, new SceneReadOptions { Progress = new Called(told.Add) });
        Assert.That(told, Is.Ordered.Ascending.And.Unique);
        Assert.That(told[^1], Is.EqualTo(1));
    }

    [Test]
    public void Indices_OutOfRange_AreArgumentOutOfRange()
    {
        ValidScene scene = ValidScene.Load(Lever);
        int objects = scene.Document.GameObjects.Count;
        foreach (int wrong in new[] { -1, objects, int.MaxValue })
        {
            Assert.That(() => scene.WorldTransform(wrong), Throws.InstanceOf<ArgumentOutOfRangeException>());
            Assert.That(() => scene.Body(wrong), Throws.InstanceOf<ArgumentOutOfRangeException>());
            Assert.That(() => scene.BodyOf(wrong), Throws.InstanceOf<ArgumentOutOfRangeException>());
            Assert.That(() => scene.Freedoms(wrong, 0), Throws.InstanceOf<ArgumentOutOfRangeException>());
            Assert.That(() => scene.Freedoms(1, wrong), Throws.InstanceOf<ArgumentOutOfRangeException>());
            Assert.That(() => scene.Joint(new JointCoordinate { GameObject = wrong }), Throws.InstanceOf<ArgumentOutOfRangeException>());
        }

        foreach (int wrong in new[] { -1, scene.Document.Meshes.Count })
            Assert.That(() => scene.Mesh(wrong), Throws.InstanceOf<ArgumentOutOfRangeException>());
        Assert.That(() => scene.Freedoms(1, 0), Throws.InstanceOf<ArgumentOutOfRangeException>().With.Message.Contains("is no joint"), "a Rigidbody");
    }

    [Test]
    public void With_OfADocument_ForgetsTheTextThatItDiffersFrom()
    {
        SceneDocument document = ValidScene.Load(Lever).Document;
        SceneDocument copy = document with { Physics = document.Physics with { FixedTimestep = 0.01 } };
        Assert.That(document.Text.IsEmpty, Is.False);
        Assert.That(copy.Text.IsEmpty, Is.True);
        Assert.That(copy, Is.Not.EqualTo(document));
        Assert.That(copy.Physics.Gravity, Is.EqualTo(document.Physics.Gravity));
        GameObject still = document.GameObjects[1] with { Components = [] };
        Assert.That(still.Body, Is.Null);
    }

    private static ReadOnlyMemory<byte>? Buffer(string uri) => File.ReadAllBytes(Path.Combine(Path.GetDirectoryName(Lever)!, uri));

    private sealed class Called(Action<double> told) : IProgress<double>
    {
        public void Report(double value) => told(value);
    }

    // As a pipe: a few bytes at a time, no length.
    private sealed class OnceOnly(byte[] bytes) : MemoryStream(bytes)
    {
        public override bool CanSeek => false;

        public override long Length => throw new NotSupportedException();

        public override int Read(byte[] buffer, int offset, int count) => base.Read(buffer, offset, Math.Min(count, 1000));
    }
}
