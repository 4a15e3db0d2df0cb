using System;
using System.Linq;
using System.Threading;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics;
using Kinefab.Tests.Dynamics.Rattle;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Kinematics;

/// <summary>What it takes to make a mechanism, which cannot be cancelled: as much for each joint, however many there are.</summary>
public sealed class MechanismCostTests
{
    // A loop's rows depend on all of its bodies: in a grid of 12,800 joints they took more than all the rest.
    [TestCase("star")]
    [TestCase("pair")]
    [TestCase("comb")]
    [TestCase("grid")]
    public void Create_ManyJoints_TakesAsMuchMemoryForEach(string kind)
    {
        Assert.That(BytesPerJoint(kind, 12_800), Is.LessThan(1.2 * BytesPerJoint(kind, 800)));
    }

    [Test]
    public void Solver_OfAMechanismWithLoops_CancelledWhileItsRowsAreFound_Ends()
    {
        Mechanism mechanism = Mechanism.Create(SmallScene.Validate(HubScenes.Grid(3)));
        Assert.That(() => mechanism.Linkage.FindRows(new CancellationToken(true)), Throws.InstanceOf<OperationCanceledException>());
        Assert.That(mechanism.Linkage.FindRows(default), Is.SameAs(mechanism.Rows));
    }

    // Each coupling looked through all joints of the object, and each of its terms through all that the terms before it had found.
    [Test]
    public void Rows_OfACouplingOverManyJointsOfOneObject_AreThoseOfAll()
    {
        SceneDocument pair = HubScenes.Pair(40);
        JointCoordinate Of(int component) => new() { GameObject = 1, Component = component, Coordinate = Coordinate.Angle };
        var coupling = new Coupling { Id = "sum", B = Of(1), Terms = Enumerable.Range(2, 31).Select(i => new CouplingTerm { Coordinate = Of(i), Ratio = 1 }).ToArray() };
        Mechanism mechanism = Mechanism.Create(SmallScene.Validate(pair with { Couplings = [coupling] }));
        Assert.That(mechanism.Couplings.Single().Terms.Append(mechanism.Couplings.Single().Driven).Select(i => mechanism.Coordinates[i].Component), Is.EqualTo(Enumerable.Range(2, 31).Append(1)));
        Assert.That(mechanism.Rows.Couplings.Single().Bodies.Single(), Is.EqualTo(1));
    }

    private static double BytesPerJoint(string kind, int joints)
    {
        ValidScene scene = SmallScene.Validate(HubScenes.Kinds[kind](joints));
        Mechanism.Create(scene);
        long before = GC.GetAllocatedBytesForCurrentThread();
        Mechanism mechanism = Mechanism.Create(scene);
        return (GC.GetAllocatedBytesForCurrentThread() - before) / (double)mechanism.Joints.Length;
    }
}
