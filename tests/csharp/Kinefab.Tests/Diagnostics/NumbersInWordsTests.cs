using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics;
using NUnit.Framework;
using static Kinefab.NUnit.MechanismConstraints;

namespace Kinefab.Tests.Diagnostics;

/// <summary>What the library says in words has points in its numbers, whatever the machine's language.</summary>
public sealed class NumbersInWordsTests
{
    [Test]
    public void ToString_OnAMachineThatWritesCommas_HasPoints()
    {
        using var culture = new CommaCulture();
        World world = SmallScene.Create(new HingeJoint { Axis = Vector3d.UnitZ }, new Rigidbody { Mass = 2.5 });
        using (Assert.EnterMultipleScope())
        {
            Assert.That(world.Bodies[0].ToString(), Does.Contain(", 2.5 kg at"));
            Assert.That(new JointLimits { Bounciness = 0.5 }.ToString(), Does.Contain("bounciness 0.5"));
            Assert.That(new SoftJointLimit { Bounciness = 0.5 }.ToString(), Does.Contain("bounciness 0.5"));
            Assert.That(new FixedJoint { BreakForce = 2.5, BreakTorque = 3.5 }.ToString(), Does.Contain("breaks at 2.5 N, breaks at 3.5 N m"));
            Assert.That(new Coupling { A = new JointCoordinate(), Ratio = 1.5, Offset = 0.5 }.ToString(), Does.Contain("1.5 * ").And.EndsWith(" + 0.5"));
            Assert.That(Drives("Shaft").Moving("Slide").By(0.05).Within(0.001).Description, Does.EndWith("by 0.05 within 0.001"));
        }
    }
}
