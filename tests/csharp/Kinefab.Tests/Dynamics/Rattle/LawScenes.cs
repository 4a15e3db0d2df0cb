using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>A wheel on a hinge, a body on a slide, and their run.</summary>
internal static class LawScenes
{
    internal const double Dt = 1.0 / 100;

    // A wheel of I = 2 kg m^2 about Z on a hinge whose actor 1 it is: angle and speed are those of the wheel.
    internal static MultibodySystem Wheel(Action<RevoluteJoint> set, double speed = 0)
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int wheel = b.Body(new Vector3d(1, 2, 3), Quaterniond.Identity, 3, new Vector3d(1.1, 1.3, 2));
        b.Change(wheel, d =>
        {
            d.AngularVelocity = new Vector3d(0, 0, speed);
            return d;
        });
        RevoluteJoint hinge = b.Hinge(JointModel.World, wheel, new Vector3d(1, 2, 3), Vector3d.UnitZ);
        set(hinge);
        return b.Build();
    }

    internal static double Speed(MultibodySystem m) => m.Bodies.AngularVelocities[0].Z;

    internal static double Angle(MultibodySystem m) => ((RevoluteJoint)m.Joints[0]).Angle(Pose.Identity, m.Bodies.Poses[0]);

    internal static void Run(MultibodySystem m, double seconds, double dt = Dt, Action? before = null)
    {
        var solver = new RattleSolver(m);
        int steps = (int)Math.Round(seconds / dt);
        for (int i = 0; i < steps; i++)
        {
            before?.Invoke();
            solver.Step(dt);
        }
    }

    internal static MultibodySystem Slider(Action<D6Joint> set, double mass)
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int body = b.Body(Vector3d.Zero, Quaterniond.Identity, mass, new Vector3d(1, 1, 1));
        var joint = new D6Joint { X = AxisMotion.Free };
        set(joint);
        b.Add(joint, JointModel.World, body, Pose.Identity);
        return b.Build();
    }

    internal static void Motor(RevoluteJoint hinge, double speed, double torque, bool freeSpin)
    {
        hinge.MotorEnabled = true;
        hinge.MotorVelocity = speed;
        hinge.MotorForceLimit = torque;
        hinge.MotorFreeSpin = freeSpin;
    }

    internal static void Limits(RevoluteJoint hinge, double lower, double upper, LimitResponse response)
    {
        hinge.LimitEnabled = true;
        hinge.Limit = new AngularLimit { Lower = lower * Math.PI / 180, Upper = upper * Math.PI / 180, Response = response };
    }
}
