using System;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;
using Transform = Kinefab.Document.Transform;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Rows of locked angles are 0 at half a turn too: no part of a step may turn a body so far that it comes out the other way round.</summary>
internal sealed class LockedAngleTests
{
    /// <summary>
    /// A sleeve on a shaft that a program swings to and fro, flung out to its stop: in one step it came to the stop of the other side, turned over by half
    /// a turn, without a word, in 4 of 1,650 such motions.
    /// </summary>
    [TestCase(0.007, 22, 3.2)]
    [TestCase(0.0075, 22, 3)]
    [TestCase(0.008, 20, 3.1)]
    [TestCase(0.01, 16, 3.1)]
    public void Step_OnAShaftThatIsSwung_TurnsNothingOver(double dt, double rate, double most)
    {
        // Degrees.
        const double tolerance = 1e-5;

        var joint = new ConfigurableJoint
        {
            ConnectedBody = 0,
            Anchor = new Vector3d(0, -0.025, 0),
            Axis = Vector3d.UnitY,
            SecondaryAxis = Vector3d.UnitZ,
            XMotion = ConfigurableJointMotion.Limited,
            YMotion = ConfigurableJointMotion.Locked,
            ZMotion = ConfigurableJointMotion.Locked,
            AngularYMotion = ConfigurableJointMotion.Locked,
            AngularZMotion = ConfigurableJointMotion.Locked,
            LinearLimit = new SoftJointLimit { Limit = 0.15 },
        };
        var sleeve = new Rigidbody { AngularDamping = 0, InertiaTensor = new Vector3d(9.375e-5, 2.270833e-4, 2.833333e-4) };
        var document = new SceneDocument
        {
            Version = "1.1",
            Physics = new Physics { Gravity = Vector3d.Zero, DefaultMaxAngularSpeed = 1e4 },
            GameObjects = new[]
            {
                new GameObject { Id = "Shaft", Name = "Shaft", Components = new Component[] { new Rigidbody { IsKinematic = true } } },
                new GameObject
                {
                    Id = "Sleeve",
                    Name = "Sleeve",
                    Transform = new Transform { LocalPosition = new Vector3d(0, -0.05, 0), LocalRotation = new Quaterniond(0, 0, 1, 0) },
                    Components = new Component[] { sleeve, joint },
                },
            },
        };
        World world = World.Create(SmallScene.Validate(document), SolverKind.Exact);
        for (int i = 0; i < 60; i++)
        {
            world.Bodies[0].KinematicTarget = new Pose(Vector3d.Zero, Quaterniond.AxisAngle(Vector3d.UnitX, most * Math.Sin(rate * world.Time)));
            world.Step(dt);
            Assert.That(world.Joints[0].Drift.Angle, Is.LessThan(tolerance), $"step {i}");
        }

        Assert.That(world.Stops, Is.Zero);
    }
}
