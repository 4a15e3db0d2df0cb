using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using Kinefab.Advice;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Packaging;

/// <summary>What a debugger or an assertion prints says in one line what a thing is, with units.</summary>
public sealed class ToStringTests
{
    private static readonly string Lever = Path.Combine(Kinefab.Tests.Dynamics.Scenario.Folder, "..", "..", "csharp", "examples", "LeverTests", "lever.kinefab");

    // Options and doors that hold nothing to print.
    private static readonly Type[] Silent = [typeof(PositionSolver), typeof(Sweep), typeof(AdviceOptions), typeof(SceneLimits), typeof(SceneReadOptions), typeof(SceneFormatException), typeof(MeshData)];

    [Test]
    public void EveryPublicType_HasAToStringOfItsOwn()
    {
        IEnumerable<Type> mute = typeof(SceneDocument).Assembly.GetExportedTypes()
            .Where(type => !type.IsEnum && !type.IsInterface && !(type.IsAbstract && type.IsSealed) && !typeof(Delegate).IsAssignableFrom(type) && !Silent.Contains(type))
            .Where(type => !typeof(DocumentObject).IsAssignableFrom(type) || type == typeof(DocumentObject))
            .Where(type => type.GetMethod(nameof(ToString), BindingFlags.Public | BindingFlags.Instance, [])!.DeclaringType is Type declaring && (declaring == typeof(object) || declaring == typeof(ValueType)));
        Assert.That(mute, Is.Empty);
    }

    [Test]
    public void EveryTypeWithAToString_IsShownByItInTheDebugger() => Assert.That(
        typeof(SceneDocument).Assembly.GetExportedTypes()
            .Where(type => type.GetMethod(nameof(ToString), BindingFlags.Public | BindingFlags.Instance, [])?.DeclaringType?.Assembly == type.Assembly)
            .Where(type => type.GetCustomAttribute<System.Diagnostics.DebuggerDisplayAttribute>()?.Value != "{ToString(),nq}"),
        Is.Empty);

    [Test]
    public void OfALever_AreOneLineWithUnits()
    {
        Mechanism mechanism = Mechanism.Load(Lever);
        World world = World.Load(Lever, SolverKind.Exact);
        var solver = new PositionSolver(mechanism);
        MechanismState state = mechanism.NewState();
        DriveResult drive = solver.Drive(state, "Shaft", 90);
        (object Thing, string[] Words)[] said =
        [
            (mechanism.Scene, ["objects", "bodies", "joints", "no findings"]),
            (mechanism, ["Lever/Crank:1.angle"]),
            (mechanism.Coordinates[0], ["Lever/Crank:1.angle [deg]"]),
            (state, ["Lever/Crank:1.angle 90 deg", " m"]),
            (drive, ["Reached", "m,", "deg"]),
            (new Sweep(solver).Range(mechanism.NewState(), 0).High, ["360 (open)"]),
            (mechanism.CountMobility(), ["mobility 1", "rows", "redundant", "0 idle freedoms, 1 island"]),
            (mechanism.CountMobility().Islands[0], ["mobility 1, 3 redundant rows, 1 loop"]),
            (mechanism.CountMobility().Bodies[0], ["0 translations, 1 rotation"]),
            (world, ["Exact world at 0.1 s"]),
            (world.Bodies[1], ["kg at (", " m, ", "m/s", "rad/s"]),
            (world.Joints[0], ["HingeJoint Lever/Crank:1 \"Shaft\", Angle 0 deg"]),
            (world.Joints[0].Drift, ["m,", "deg"]),
            (world.Run(0.1, record: ["Shaft"]), ["steps to 0.1 s", "Shaft"]),
            (world.Snapshot(), ["state at 0.1 s"]),
            (mechanism.Scene.Document.GameObjects[1], ["\"Lever/", "Rigidbody"]),
            (new HingeJoint { UseLimits = true, Limits = new JointLimits { Min = -10, Max = 80 } }, ["HingeJoint to the world, limits -10 to 80 deg"]),
            (new Rigidbody { Mass = 2.5 }, ["Rigidbody 2.5 kg"]),
            (new Coupling { Kind = CouplingKind.Gear, Id = "g", A = new JointCoordinate(), Ratio = -2.5 }, ["Gear \"g\": ", "-2.5 * "]),
            (new Coupling { Terms = [new CouplingTerm { Ratio = 2 }, new CouplingTerm { Ratio = 3 }] }, [" = 2 * ", " + 3 * "]),
            (new Pose(new Vector3d(1, 2, 3), Quaterniond.AxisAngle(Vector3d.UnitY, Math.PI / 2)), ["(1, 2, 3) m, turned 90 deg about (0, 1, 0)"]),
            (Report.Empty, ["no findings"]),
            (SceneValidator.Validate(new SceneDocument { GameObjects = [new GameObject(), new GameObject()] }), ["not valid; ", "error"]),
        ];
        foreach ((object thing, string[] words) in said)
        {
            string text = thing.ToString()!;
            foreach (string word in words)
                Assert.That(text, Does.Contain(word));
            Assert.That(text, Does.Not.Contain("\n").And.Not.Contain("Kinefab.").And.Not.Match(@"\b1 [a-z]{3,}s\b"));
        }
    }

    [Test]
    public void OfADocument_EveryObject_SaysMoreThanItsNamespace()
    {
        foreach (Type type in typeof(DocumentObject).Assembly.GetExportedTypes().Where(type => !type.IsAbstract && typeof(DocumentObject).IsAssignableFrom(type)))
            Assert.That(Activator.CreateInstance(type)!.ToString(), Is.Not.Empty.And.Not.Contain("Kinefab.").And.Not.Contain("\n"), type.Name);
    }
}
