using System;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Drives of a ball whose body has three moments, by the formulas of schemas/SPEC.md and Runge and Kutta's method in fine steps.</summary>
internal sealed class BallDriveTests
{
    private const double Seconds = 0.5;

    private static readonly Vector3d Moments = new(0.4, 1.1, 1.4);
    private static readonly Vector3d Start = new(1.5, -0.7, 2);

    private static readonly Vector3d[] Units = [Vector3d.UnitX, Vector3d.UnitY, Vector3d.UnitZ];

    // As an acceleration asks the body for another torque in each pose, and as the speed that a slerp drive is asked for turns with its own body.
    [TestCase(RotationDriveMode.Slerp, 60, 0, true)]
    [TestCase(RotationDriveMode.Slerp, 60, 4, true)]
    [TestCase(RotationDriveMode.Slerp, 60, 4, false)]
    [TestCase(RotationDriveMode.Slerp, 0, 3, false)]
    [TestCase(RotationDriveMode.Slerp, 0, 3, true)]
    [TestCase(RotationDriveMode.XYAndZ, 20, 0, true)]
    [TestCase(RotationDriveMode.XYAndZ, 20, 1, true)]
    [TestCase(RotationDriveMode.XYAndZ, 20, 1, false)]
    public void Drives_OfABallWithThreeMoments_MoveItAsTheirFormulaToSecondOrder(RotationDriveMode mode, double spring, double damper, bool isAcceleration)
    {
        var drive = new JointDrive { PositionSpring = spring, PositionDamper = damper, UseAcceleration = isAcceleration };
        var joint = new ConfigurableJoint
        {
            XMotion = ConfigurableJointMotion.Locked, YMotion = ConfigurableJointMotion.Locked, ZMotion = ConfigurableJointMotion.Locked,
            RotationDriveMode = mode, SlerpDrive = drive, AngularXDrive = drive, AngularYZDrive = drive,
            TargetRotation = Quaterniond.AxisAngle(new Vector3d(0.6, -0.48, 0.64), 1.1),
            TargetAngularVelocity = damper > 0 ? new Vector3d(2, -1.5, 1) : Vector3d.Zero,
        };

        Quaterniond truth = Truth(joint, drive);
        double[] errors = Array.ConvertAll([50, 100, 200], steps => 2 * (truth.Conjugate() * After(joint, steps)).Vector.Length);

        Assert.That(errors[2], Is.LessThan(3e-4));
        Assert.That(errors[0] / errors[1], Is.InRange(3.5, 4.5), string.Join(", ", errors));
        Assert.That(errors[1] / errors[2], Is.InRange(3.5, 4.5), string.Join(", ", errors));
    }

    private static Quaterniond After(ConfigurableJoint joint, int steps)
    {
        World world = SmallScene.Create(joint, new Rigidbody { InertiaTensor = Moments, AngularDamping = 0, MaxAngularVelocity = 100 }, solver: SolverKind.Exact);
        world.Bodies[0].AngularVelocity = Start;
        for (int i = 0; i < steps; i++)
        {
            world.Step(Seconds / steps);
        }

        Assert.That(world.Stops, Is.Zero);
        return world.Bodies[0].Pose.Rotation;
    }

    private static Quaterniond Truth(ConfigurableJoint joint, JointDrive drive)
    {
        const int steps = 2000;
        const double h = Seconds / steps;
        Quaterniond q = SmallScene.OwnPose.Rotation;
        Vector3d w = Start;
        for (int i = 0; i < steps; i++)
        {
            (Quaterniond q1, Vector3d w1) = Rates(joint, drive, q, w);
            (Quaterniond q2, Vector3d w2) = Rates(joint, drive, Sum(q, q1, h / 2), w + w1 * (h / 2));
            (Quaterniond q3, Vector3d w3) = Rates(joint, drive, Sum(q, q2, h / 2), w + w2 * (h / 2));
            (Quaterniond q4, Vector3d w4) = Rates(joint, drive, Sum(q, q3, h), w + w3 * h);
            q = Sum(Sum(Sum(Sum(q, q1, h / 6), q2, h / 3), q3, h / 3), q4, h / 6).Normalized();
            w += (w1 + 2 * w2 + 2 * w3 + w4) * (h / 6);
        }

        return q;
    }

    private static (Quaterniond Turn, Vector3d Acceleration) Rates(ConfigurableJoint joint, JointDrive drive, Quaterniond q, Vector3d w)
    {
        Vector3d momentum = q * Vector3d.Scale(Moments, q.InverseRotate(w));
        Vector3d torque = Torque(joint, drive, q, w) - Vector3d.Cross(w, momentum);
        Quaterniond turn = new Quaterniond(w.X / 2, w.Y / 2, w.Z / 2, 0) * q;
        return (turn, Answer(q, torque));
    }

    // c = q^-1 q0, and what is left of it to the target is t^-1 c. Slerp: its vector's rates along the world's axes are the rows (where there is a spring). Else its
    // twist and swings, about the connected frame's axes.
    private static Vector3d Torque(ConfigurableJoint joint, JointDrive drive, Quaterniond q, Vector3d w)
    {
        Quaterniond own = q * joint.TargetRotation, connected = SmallScene.OwnPose.Rotation;
        Quaterniond left = own.Conjugate() * connected;
        Assert.That(left.W, Is.Positive);
        bool isSlerp = joint.RotationDriveMode == RotationDriveMode.Slerp;
        Vector3d swung = left * Vector3d.UnitX;
        Vector3d away = isSlerp ? left.Vector : new Vector3d(2 * left.X, -swung.Z, swung.Y);
        Vector3d target = isSlerp ? -(q * joint.TargetAngularVelocity) : connected * joint.TargetAngularVelocity;
        Vector3d torque = Vector3d.Zero;
        for (int i = 0; i < 3; i++)
        {
            Vector3d row = !isSlerp ? connected * Units[i] : drive.PositionSpring == 0 ? Units[i] : Vector(k => (own.Conjugate() * new Quaterniond(k.X, k.Y, k.Z, 0) * connected).Vector[i] / 2);
            double force = drive.PositionSpring * away[i] + drive.PositionDamper * Vector3d.Dot(row, target - w);
            torque += row * (drive.UseAcceleration ? force / Vector3d.Dot(row, Answer(q, row)) : force);
        }

        return torque;
    }

    private static Vector3d Answer(Quaterniond q, Vector3d torque)
    {
        Vector3d local = q.InverseRotate(torque);
        return q * new Vector3d(local.X / Moments.X, local.Y / Moments.Y, local.Z / Moments.Z);
    }

    private static Vector3d Vector(Func<Vector3d, double> along)
    {
        double[] parts = Units.Select(along).ToArray();
        return new Vector3d(parts[0], parts[1], parts[2]);
    }

    private static Quaterniond Sum(Quaterniond a, Quaterniond b, double share) => new(a.X + share * b.X, a.Y + share * b.Y, a.Z + share * b.Z, a.W + share * b.W);
}
