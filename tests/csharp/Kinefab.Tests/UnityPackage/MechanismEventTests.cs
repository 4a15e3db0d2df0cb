using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>What a mechanism tells, what Undo gives back, and a pull while physics runs.</summary>
[NonParallelizable]
public sealed class MechanismEventTests
{
    private static readonly string Samples = Path.Combine(PlayedMechanism.Fixtures, "..", "csharp", "unity", "com.kinefab", "Samples~");
    private static readonly string Gripper = Path.Combine(Samples, "Gripper", "Gripper.kinefab");

    [Test]
    public void Limit_IsToldOnceForEachTimeThatItIsMet()
    {
        using var played = new PlayedMechanism(Gripper);
        List<string> told = Listen(played.Component);
        for (int i = 0; i < 4; i++)
            played.Component.Drive("Spindle", 370 + i);
        bool isUpper = played.Component.Last.IsUpper;
        Assert.That(played.Component.Last.Stop, Is.EqualTo(KinefabStop.Limit));
        Assert.That(played.Component.Value("Spindle"), Is.EqualTo(360).Within(1e-9));
        played.Component.Drive("Spindle", 0);
        played.Component.Drive("Spindle", -730);
        Assert.That(played.Component.Last.IsUpper, Is.Not.EqualTo(isUpper));
        Assert.That(told, Has.Count.EqualTo(2).And.All.EqualTo("limit of Left jaw"), "the nut's");
    }

    // Of a flat parallelogram two ways lead on: it stays one, or crosses.
    [Test]
    public void Branch_IsToldWithTheDrivenCoordinate()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Full("mechanisms/M05.kinefab"));
        List<string> told = Listen(played.Component);
        string driven = played.Component.Freedoms[0].Name;
        played.Component.Drive(0, played.Component.Value(0) + 10);
        Assert.That(played.Component.Last.Branches, Is.GreaterThan(1));
        Assert.That(told, Is.EqualTo(new[] { $"branch of {driven}" }));
        played.Component.Drive(0, played.Component.Value(0) + 10);
        Assert.That(told, Has.Count.EqualTo(1), "away from there only one way leads on");
    }

    // Unity stores the component before a change that Undo records, and reads the stored one back.
    [Test]
    public void Undo_InEditMode_GivesTheMechanismBackItsPose()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Lever, plays: false);
        played.Component.Drive("Shaft", 30);
        string before = Stored(played.Component);
        double slide = played.Component.Value("Slide");
        played.Component.Drive("Shaft", 470);
        Assert.That(Stored(played.Component), Is.Not.EqualTo(before));
        Field.SetValue(played.Component, before);
        ((Unity.ISerializationCallbackReceiver)played.Component).OnAfterDeserialize();
        Unity.Calls.Of(played.Component, "OnValidate");
        Assert.That((played.Component.Value("Shaft"), played.Component.Value("Slide")), Is.EqualTo((30.0, slide)).Within(1e-12));
    }

    [Test]
    public void Pull_WhilePhysicsRuns_HoldsThePartsAndHandsThemOver()
    {
        using var played = new PlayedMechanism(Path.Combine(Samples, "FourBar", "FourBar.kinefab"), KinefabPhysics.AsExported);
        played.Component.Mover = KinefabMover.Physics;
        Unity.Rigidbody crank = played.Component.MovingParts().Single(part => part.name == "Crank").GetComponent<Unity.Rigidbody>();
        Assert.That(crank.isKinematic, Is.False);
        var eye = new Unity.GameObject("Eye");
        eye.transform.position = crank.GetComponentsInChildren<Unity.MeshRenderer>()[0].bounds.center - new Unity.Vector3(0, 0, 1);
        KinefabDragger dragger = eye.AddComponent<KinefabDragger>();
        dragger.view = eye.AddComponent<Unity.Camera>();
        try
        {
            (Unity.Input.mousePosition, Unity.Input.IsDown) = (Unity.Vector3.zero, true);
            played.Frame();
            Assert.That((played.Component.Mover, crank.isKinematic), Is.EqualTo((KinefabMover.Exact, true)));
            (Unity.Input.WasDown, double motor) = (true, played.Component.Value("Motor"));
            for (int i = 1; i <= 5; i++)
            {
                Unity.Input.mousePosition = new Unity.Vector3(0.004f * i, 0, 0);
                played.Frame();
            }

            Assert.That(Math.Abs(played.Component.Value("Motor") - motor), Is.GreaterThan(5));
            played.Frame(); // the bodies arrive a physics step later
            Assert.That(played.Off(played.Component.Motion.State), Is.LessThan(2e-3));

            // Destroyed in the middle of it: the pull ends, nothing else does.
            Unity.Object.DestroyImmediate(dragger.Part.gameObject);
            played.Frame();
            Assert.That(dragger.Part == null, Is.True);
            Assert.That(played.Component.Mover, Is.EqualTo(KinefabMover.Physics));
        }
        finally
        {
            Unity.Input.IsDown = Unity.Input.WasDown = false;
            Unity.Object.DestroyImmediate(eye);
        }
    }

    private static FieldInfo Field => typeof(KinefabMechanism).GetField("pose", BindingFlags.Instance | BindingFlags.NonPublic)!;

    private static string Stored(KinefabMechanism component)
    {
        ((Unity.ISerializationCallbackReceiver)component).OnBeforeSerialize();
        return (string)Field.GetValue(component)!;
    }

    private static List<string> Listen(KinefabMechanism component)
    {
        List<string> told = [];
        component.onLimit.AddListener(name => told.Add($"limit of {name}"));
        component.onDeadPoint.AddListener(name => told.Add($"dead point of {name}"));
        component.onBranch.AddListener(name => told.Add($"branch of {name}"));
        return told;
    }
}
