using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Tests.Conformance;
using Kinefab.Validation;
using KinefabUnity;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>A scene as the package makes it, and beside it the same in doubles: what its parts have to show.</summary>
internal sealed class PlayedMechanism : IDisposable
{
    public static readonly string Fixtures = Path.Combine(ConformanceCases.Folder, "..", "..", "fixtures");

    public PlayedMechanism(string path, KinefabPhysics physics = KinefabPhysics.None, Unity.Transform? parent = null, bool plays = true)
    {
        Unity.Player.Play(plays);
        Root = KinefabScene.Instantiate(path, parent, new KinefabSettings { physics = physics }, []);
        Component = Root.GetComponent<KinefabMechanism>();
        Scene = ValidScene.Load(path);
    }

    public Unity.GameObject Root { get; }

    public KinefabMechanism Component { get; }

    public ValidScene Scene { get; }

    public static IEnumerable<string> Scenes() =>
        Directory.GetFiles(Fixtures, "*.kinefab", SearchOption.AllDirectories).Select(path => Path.GetRelativePath(Fixtures, path)).Order(StringComparer.Ordinal);

    public static string Full(string path) => Path.Combine(Fixtures, path);

    public static string Lever => Path.Combine(Fixtures, "..", "csharp", "examples", "LeverTests", "lever.kinefab");

    /// <summary>A part by the id in the file.</summary>
    public Unity.Transform Part(string id) => Component.Part(Enumerable.Range(0, Scene.Document.GameObjects.Count).Single(i => Scene.Document.GameObjects[i].Id == id));

    /// <summary>A frame with its physics step.</summary>
    public void Frame()
    {
        Unity.Player.Frame();
        for (int i = 0; i < Scene.Document.GameObjects.Count; i++)
        {
            if (Component.Part(i) is { } part && part != null && part.GetComponent<Unity.Rigidbody>() is { } body)
                body.Arrive();
        }
    }

    /// <summary>Largest distance of a part from where a state has it, metres of the scene, under the root's own place in the world.</summary>
    public double Off(MechanismState state)
    {
        double worst = 0;
        foreach (int i in state.Mechanism.Bodies)
        {
            Unity.Transform part = Component.Part(i);
            if (part == null || part == Root.transform)
                continue;
            Unity.Vector3 at = Root.transform.InverseTransformPoint(part.position);
            worst = Math.Max(worst, (new Vector3d(at.x, at.y, at.z) - state.Pose(i).Position).Length);

            // A point off the body's own, so that its turn counts.
            Vector3d scale = state.Mechanism.Scene.WorldTransform(i).Scale;
            Unity.Vector3 tip = Root.transform.InverseTransformPoint(part.TransformPoint(new Unity.Vector3((float)(0.1 / scale.X), (float)(0.2 / scale.Y), (float)(-0.1 / scale.Z))));
            worst = Math.Max(worst, (new Vector3d(tip.x, tip.y, tip.z) - state.Pose(i).Point(new Vector3d(0.1, 0.2, -0.1))).Length);
        }

        return worst;
    }

    public void Dispose()
    {
        Unity.Object.DestroyImmediate(Root);
        Unity.Time.timeScale = 1;
        Unity.Player.Play(false);
    }
}
