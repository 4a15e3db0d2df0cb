using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.Json;
using System.Text.RegularExpressions;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using KinefabUnity;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>KinefabMechanism frame by frame on the stand-ins, against the library's own sweep.</summary>
[NonParallelizable]
public sealed class MechanismTests
{
    private const int Frames = 1000;

    // Degrees and metres: the same solver, asked in the same steps.
    private const double Tolerance = 1e-9;

    // Of single precision beside parts of some metres.
    private const double Single = 2e-5;

    [TestCaseSource(typeof(PlayedMechanism), nameof(PlayedMechanism.Scenes))]
    public void Frames_OfEveryFixture_AreTheSweep(string path)
    {
        using var played = new PlayedMechanism(PlayedMechanism.Full(path));
        KinefabMechanism component = played.Component;
        if (component == null || component.Freedoms.Count == 0)
        {
            Assert.That(component?.Problem ?? "none", Is.Not.Empty);
            Assert.That(Mechanism.Create(played.Scene).ChooseFreedoms(), Is.Empty);
            return;
        }

        Mechanism mechanism = Mechanism.Create(played.Scene);
        MechanismCoordinate driven = mechanism.Coordinates[component.Freedoms[0].Coordinate];
        double to = driven.FromCad(component.Freedoms[0].High * 1.1 + 0.01);
        SweepResult sweep = new Sweep(new PositionSolver(mechanism)).Run(mechanism.NewState(), component.Freedoms[0].Coordinate, 0, to, Frames);
        double off = 0, wrong = 0;
        for (int i = 0; i < sweep.States.Count; i++)
        {
            double target = i == Frames ? to : to * i / Frames;
            bool isReached = component.Drive(0, driven.ToCad(target)).Reached;
            if (isReached != (i < sweep.States.Count - 1 || sweep.Stop is null))
                Assert.Fail($"frame {i}: {component.Last}, the sweep: {sweep}");
            for (int c = 0; c < mechanism.Coordinates.Count; c++)
                wrong = Math.Max(wrong, Math.Abs(component.Motion.Value(c) - mechanism.Coordinates[c].ToCad(sweep.States[i].Coordinate(c))));
            off = i % 20 == 0 || i == sweep.States.Count - 1 ? Math.Max(off, played.Off(sweep.States[i])) : off;
        }

        Assert.That((wrong, off), Is.EqualTo((0.0, 0.0)).Using<(double, double)>((a, b) => Math.Abs(a.Item1) < Tolerance && Math.Abs(a.Item2) < Single));
    }

    // Recorded by tests/reference/unity_motion.py; Python names the coordinates of joints with several by tx to rz.
    [TestCaseSource(nameof(Recorded))]
    public void Poses_OfEveryFixture_AreThoseOfPython(string path, JsonElement recorded)
    {
        using var played = new PlayedMechanism(PlayedMechanism.Full(path));
        KinefabMechanism component = played.Component;
        Mechanism mechanism = component.Motion.Mechanism;
        string name = recorded.GetProperty("coordinate").GetString()!;
        name = Regex.Replace(name, @"\.([tr])([xyz])$", m => m.Groups[1].Value == "t" ? $".{m.Groups[2].Value}" : $".angular{m.Groups[2].Value.ToUpperInvariant()}");
        int freedom = Enumerable.Range(0, component.Freedoms.Count).FirstOrDefault(i => component.Freedoms[i].Coordinate == mechanism.CoordinateNamed(name), -1);
        double[] values = [.. Enumerable.Range(0, component.Freedoms.Count).Select(component.Value)];
        double[] asked = [.. recorded.GetProperty("values").EnumerateArray().Select(v => v.GetDouble())];
        // A rod that spins idly between two balls stands where either program leaves it.
        HashSet<int> idle = [.. mechanism.CountMobility().Idle.SelectMany(one => one.GameObjects)];
        double worst = Off(1, 1);
        if (component.Last.Branches > 1)
            Assert.Pass("Branches meet at the exported pose: each program takes a way of its own.");

        // Format 1.0 does not tell in which sense the CAD counts the slides of a joint that leaves more than one freedom.
        MechanismCoordinate driven = mechanism.Coordinates[mechanism.CoordinateNamed(name)];
        bool isAlone = mechanism.Coordinates.Count(c => (c.GameObject, c.Component) == (driven.GameObject, driven.Component)) == 1;
        double sense = isAlone || worst < Tolerance ? 1 : -1;
        for (int frame = 0; frame < asked.Length; frame++)
            Assert.That(Off(frame, sense), Is.LessThan(Tolerance), $"{asked[frame]} of {name}, metres or radians");

        double Off(int frame, double sense)
        {
            if (freedom >= 0)
                values[freedom] = sense * asked[frame];
            Assert.That((freedom >= 0 ? component.Set(values) : component.Drive(name, sense * asked[frame])).Reached, Is.True, $"{frame}: {component.Last}");
            double off = 0;
            foreach (JsonProperty part in recorded.GetProperty("poses").EnumerateObject().Where(part => !idle.Contains(mechanism.GameObjectNamed(part.Name))))
            {
                Pose pose = component.Motion.State.Pose(part.Name);
                double[] there = [.. part.Value[frame].EnumerateArray().Select(v => v.GetDouble())];
                off = Math.Max(off, (pose.Position - new Vector3d(there[0], there[1], there[2])).Length);
                off = Math.Max(off, 2 * (pose.Rotation * new Quaterniond(there[3], there[4], there[5], there[6]).Normalized().Conjugate()).Vector.Length);
            }

            return off;
        }
    }

    private static IEnumerable<TestCaseData> Recorded()
    {
        using JsonDocument all = JsonDocument.Parse(File.ReadAllText(Path.Combine(PlayedMechanism.Fixtures, "..", "tests", "reference", "unity_motion.json")));
        foreach (JsonProperty one in all.RootElement.EnumerateObject())
            yield return new TestCaseData(one.Name, one.Value.Clone()).SetArgDisplayNames(one.Name);
    }

    // The state is stored as Unity stores it and comes back with nothing lost: the last bit of every coordinate.
    [TestCase(KinefabPhysics.None)]
    [TestCase(KinefabPhysics.AsExported)]
    public void Reloads_OnTheWay_ChangeNoBit(KinefabPhysics physics)
    {
        using var straight = new PlayedMechanism(PlayedMechanism.Lever, physics);
        using var reloaded = new PlayedMechanism(PlayedMechanism.Lever, physics);
        for (int i = 1; i <= Frames; i++)
        {
            straight.Component.Drive("Shaft", 1.7 * i);
            reloaded.Component.Drive("Shaft", 1.7 * i);
            straight.Frame();
            reloaded.Frame();
            if (i % 97 == 0)
                Unity.Player.ReloadDomain();
            if (reloaded.Component.Value("Shaft") != straight.Component.Value("Shaft") || reloaded.Component.Value("Slide") != straight.Component.Value("Slide"))
                Assert.Fail($"frame {i}");
        }

        Assert.That(straight.Component.Value("Shaft"), Is.EqualTo(1700).Within(1e-9), "whole turns are kept");
        Assert.That(reloaded.Off(straight.Component.Motion.State), Is.LessThan(Single));
    }

    [Test]
    public void Clone_MadeOnTheWay_GoesOnByItself()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Lever);
        played.Component.Drive("Shaft", 400);
        Unity.GameObject clone = Unity.Object.Instantiate(played.Root);
        KinefabMechanism other = clone.GetComponent<KinefabMechanism>();
        Assert.That(other.Value("Shaft"), Is.EqualTo(played.Component.Value("Shaft")));

        other.Drive("Shaft", 460);
        played.Component.Drive("Shaft", 300);
        Assert.That((other.Value("Shaft"), played.Component.Value("Shaft")), Is.EqualTo((460.0, 300.0)).Within(1e-9));
        Assert.That(other.Part(3), Is.Not.SameAs(played.Component.Part(3)));
        Assert.That(played.Off(played.Component.Motion.State), Is.LessThan(Single));
        Unity.Object.DestroyImmediate(clone);
    }

    [TestCase(KinefabPhysics.None)]
    [TestCase(KinefabPhysics.AsExported)]
    public void Parent_ThatIsTurnedScaledAndMoved_CarriesTheMechanismAlong(KinefabPhysics physics)
    {
        var table = new Unity.GameObject("Table");
        table.transform.position = new Unity.Vector3(3, -2, 5);
        table.transform.rotation = Unity.Quaternion.AngleAxis(70, new Unity.Vector3(1, 2, -1));
        table.transform.localScale = new Unity.Vector3(2.5f, 2.5f, 2.5f);
        using var played = new PlayedMechanism(PlayedMechanism.Lever, physics, table.transform);
        for (int i = 1; i <= 60; i++)
        {
            played.Component.Drive("Shaft", 5 * i);
            table.transform.position += new Unity.Vector3(0.1f, 0, 0);
            played.Frame();
            Assert.That(played.Off(played.Component.Motion.State), Is.LessThan(Single), $"frame {i}");
        }

        // What is dragged is dragged in the world.
        Unity.Transform bar = played.Part("Lever/BarC:1");
        Unity.Vector3 goal = bar.TransformPoint(new Unity.Vector3(0.01f, 0, 0)) + new Unity.Vector3(0.002f, 0.003f, 0);
        played.Component.Drag(bar, new Unity.Vector3(0.01f, 0, 0), goal);
        played.Frame();
        Assert.That(played.Off(played.Component.Motion.State), Is.LessThan(Single));
        Unity.Object.DestroyImmediate(table);
    }

    [Test]
    public void Parts_SwitchedOffDestroyedOrHungElsewhere_StopNothing()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Lever, KinefabPhysics.AsExported);
        using var whole = new PlayedMechanism(PlayedMechanism.Lever);
        var hand = new Unity.GameObject("Hand");
        hand.transform.position = new Unity.Vector3(1, 2, 3);
        played.Part("Lever/BarC:1").gameObject.SetActive(false);
        Unity.Object.DestroyImmediate(played.Part("Lever/SliderD:1").gameObject);
        for (int i = 1; i <= 100; i++)
        {
            if (i == 50)
                played.Part("Lever/Crank:1").SetParent(hand.transform, worldPositionStays: true);
            played.Component.Drive("Shaft", 3 * i);
            whole.Component.Drive("Shaft", 3 * i);
            played.Frame();
            Assert.That(played.Component.Value("Slide"), Is.EqualTo(whole.Component.Value("Slide")));
            Assert.That(played.Off(whole.Component.Motion.State), Is.LessThan(Single), $"frame {i}");
        }

        Unity.Object.DestroyImmediate(hand);
    }

    [Test]
    public void Time_ThatStandsStill_PlacesTheBodiesAtOnce()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Lever, KinefabPhysics.AsExported);
        Unity.Time.timeScale = 0;
        played.Component.Drive("Shaft", 75);
        Unity.Player.Frame();
        Assert.That(played.Off(played.Component.Motion.State), Is.LessThan(Single));
    }

    [Test]
    public void Mechanism_WithoutAFreedom_SaysSo()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Full("mechanisms/M45.kinefab"));
        Assert.That(played.Component.Freedoms, Is.Empty);
        Assert.That(played.Component.Problem, Is.EqualTo("No joint of this scene can move."));
        Assert.That(played.Component.Set(default).Reached, Is.True);
    }

    [Test]
    public void Component_WithoutAScene_SaysSoAndMovesNothing()
    {
        Unity.Player.Play(true);
        var alone = new Unity.GameObject("Alone");
        KinefabMechanism component = alone.AddComponent<KinefabMechanism>();
        Assert.That(component.Drive("Shaft", 3).Stop, Is.EqualTo(KinefabStop.NoMechanism));
        Assert.That(component.Problem, Does.Contain("import"));
        Assert.That(component.Drag(alone.transform, default, default).Reached, Is.False);
        Unity.Object.DestroyImmediate(alone);
        Unity.Player.Play(false);
    }

    [Test]
    public void Names_ThatNoneAnswersTo_ListWhatThereIs()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Lever);
        Assert.That(() => played.Component.Drive("Shift", 3), Throws.ArgumentException.With.Message.Contains("Shaft"));
        Assert.That(() => played.Component.Drive("Shaft", double.NaN), Throws.InstanceOf<ArgumentException>());
        Assert.That(() => played.Component.Set(new double[2]), Throws.ArgumentException);
        Assert.That(() => played.Component.Drag(null, default, default), Throws.ArgumentException);
    }

    [Test]
    public void Events_AreToldOnceForEachStop()
    {
        using var played = new PlayedMechanism(PlayedMechanism.Full("mechanisms/M03.kinefab"));
        var told = new List<string>();
        played.Component.onLimit.AddListener(name => told.Add($"limit of {name}"));
        played.Component.onDeadPoint.AddListener(name => told.Add($"dead point of {name}"));
        KinefabFreedom crank = played.Component.Freedoms[0];
        for (int i = 0; i < 5; i++)
            played.Component.Drive(0, crank.High + 10 + i);
        Assert.That(played.Component.Last.Stop, Is.EqualTo(KinefabStop.DeadPoint));
        played.Component.Drive(0, 0);
        played.Component.Drive(0, crank.High + 10);
        Assert.That(told, Has.Count.EqualTo(2).And.All.EqualTo("dead point of crank"));
    }

    [TestCase(KinefabPhysics.None)]
    [TestCase(KinefabPhysics.AsExported)]
    public void Frames_AfterTheFirst_AllocateNothing(KinefabPhysics physics)
    {
        using var played = new PlayedMechanism(PlayedMechanism.Lever, physics);
        var step = (Action)Delegate.CreateDelegate(typeof(Action), played.Component, "FixedUpdate");
        Unity.Transform bar = played.Part("Lever/BarC:1");
        var point = new Unity.Vector3(0.01f, 0, 0);
        var values = new double[1];
        long allocated = 0;
        for (int round = 0; round < 3; round++)
        {
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int i = 0; i < Frames; i++)
            {
                played.Component.Drive("Shaft", 0.37 * i);
                values[0] = 0.37 * i + 0.1;
                played.Component.Set(values);
                played.Component.Drag(bar, point, bar.TransformPoint(point) + new Unity.Vector3(0.0001f, 0, 0));
                played.Component.Value("Slide");
                step();
            }

            allocated = GC.GetAllocatedBytesForCurrentThread() - before;
        }

        Assert.That(allocated, Is.LessThan(Frames), "bytes in as many frames");
    }
}
