using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using Kinefab.Tests.Document;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>
/// Files that are nearly scenes: each is an object that is driven and handed over without a word in the Console, or an error. <c>KINEFAB_MUTANTS</c>
/// names how many; without it, as many as take a second.
/// </summary>
[NonParallelizable]
public sealed class MutatedSceneTests
{
    [SetUp]
    public void Play() => Unity.Player.Play(true);

    [TearDown]
    public void Stop() => Unity.Player.Play(false);

    [Test]
    public void Instantiate_OfNearlyAScene_IsAnErrorOrAMechanismThatMoves([Values] KinefabPhysics physics)
    {
        int made = 0, count = SceneMutants.Count(600);
        for (int seed = 0; seed < count; seed++)
        {
            byte[] text = Encoding.UTF8.GetBytes(SceneMutants.Text(new Random(seed)));
            var parent = new Unity.GameObject("parent");
            List<KinefabFinding> findings = [];
            Unity.Debug.Errors.Clear();
            Unity.GameObject root = KinefabScene.Instantiate(text, parent.transform, new KinefabSettings { physics = physics }, findings, uri => SceneMutants.Buffers.TryGetValue(uri, out byte[]? bytes) ? bytes : new byte[72]);

            // What no articulation can hold is named, and the file's joints stay.
            bool isFaulty = findings.Any(f => f.severity == KinefabSeverity.Error && f.code != "ARTICULATION_IMPOSSIBLE");
            Assert.That(root == null, Is.EqualTo(isFaulty), $"seed {seed}: {string.Join('\n', findings)}");
            if (root != null)
            {
                Use(root);
                made++;
            }

            Assert.That(Unity.Debug.Errors, Is.Empty, $"seed {seed}");
            Unity.Object.DestroyImmediate(parent);
        }

        Assert.That(made, Is.GreaterThan(count / 20), "some are scenes still");
    }

    private static void Use(Unity.GameObject root)
    {
        Unity.Player.Frame();
        if (root.GetComponent<KinefabMechanism>() is not { } mechanism)
            return;
        foreach (KinefabFreedom freedom in mechanism.Freedoms.Take(2))
            mechanism.Drive(freedom.Name, mechanism.Value(freedom.Name) + 0.01);
        foreach (KinefabMover mover in Enum.GetValues<KinefabMover>())
        {
            mechanism.Mover = mover;
            Unity.Player.Frame();
        }
    }
}
