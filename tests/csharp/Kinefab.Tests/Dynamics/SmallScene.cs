using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;
using Quaterniond = Kinefab.Numerics.Quaterniond;

namespace Kinefab.Tests.Dynamics;

/// <summary>Scenes of one jointed body, made in code: own body at a turned pose, held to the world or to a turned kinematic body.</summary>
internal static class SmallScene
{
    public const double Dt = 0.01;

    /// <summary>Start pose of the own body's object; no symmetry anywhere.</summary>
    public static readonly Pose OwnPose = new(new Vector3d(0.3, 1.1, -0.2), Quaterniond.AxisAngle(new Vector3d(1, 2, -2) * (1.0 / 3), 0.7));

    /// <summary>Start pose of the connected body's object.</summary>
    public static readonly Pose ConnectedPose = new(new Vector3d(-0.4, 0.6, 0.5), Quaterniond.AxisAngle(new Vector3d(-2, 1, 2) * (1.0 / 3), 1.9));

    /// <summary>A world without gravity. Its first body carries the joint; with a connected body that is the second, kinematic one.</summary>
    public static World Create(Joint joint, Rigidbody? own = null, bool connected = false, SolverKind solver = SolverKind.Unity) =>
        World.Create(Validate(Document(joint, own ?? new Rigidbody { AngularDamping = 0, MaxAngularVelocity = 100 }, connected)), solver);

    public static SceneDocument Document(Joint joint, Rigidbody own, bool connected)
    {
        var objects = new List<GameObject>
        {
            new() { Id = "own", Name = "own", Transform = At(OwnPose), Components = [own, joint] },
        };
        if (connected)
        {
            objects.Add(new() { Id = "connected", Name = "connected", Transform = At(ConnectedPose), Components = [new Rigidbody { IsKinematic = true }] });
        }

        return new SceneDocument { Physics = new Physics { Gravity = Vector3d.Zero }, GameObjects = objects };
    }

    public static ValidScene Validate(SceneDocument document)
    {
        SceneValidation validation = SceneValidator.Validate(document);
        Assert.That(validation.Scene, Is.Not.Null, validation.Report.ToString());
        return validation.Scene!;
    }

    public static Transform At(Pose pose) => new() { LocalPosition = pose.Position, LocalRotation = pose.Rotation };

    /// <summary>Steps for a time, in seconds.</summary>
    public static void Run(World world, double seconds)
    {
        int steps = (int)System.Math.Round(seconds / Dt);
        for (int i = 0; i < steps; i++)
        {
            world.Step(Dt);
        }
    }

    /// <summary>
    /// Rotation vector of the own body since the start, seen in its own axes: with L = R_B^-1 R_A it is the log of L_0^-1 L, degrees.
    /// </summary>
    public static Vector3d Turn(World world)
    {
        Quaterniond connected = world.Bodies.Count > 1 ? world.Bodies[1].Pose.Rotation : Quaterniond.Identity;
        Quaterniond connectedStart = world.Bodies.Count > 1 ? ConnectedPose.Rotation : Quaterniond.Identity;
        Quaterniond start = connectedStart.Conjugate() * OwnPose.Rotation;
        Quaterniond q = start.Conjugate() * (connected.Conjugate() * world.Bodies[0].Pose.Rotation);
        double s = q.Vector.Length;
        return s > 0 ? q.Vector * (2 * System.Math.Atan2(s, q.W) / s * 180 / System.Math.PI) : Vector3d.Zero;
    }

    /// <summary>Way of the own body's origin since the start, along its own axes at the start, metres.</summary>
    public static Vector3d Way(World world) => OwnPose.Rotation.InverseRotate(world.Bodies[0].Pose.Position - OwnPose.Position);
}
