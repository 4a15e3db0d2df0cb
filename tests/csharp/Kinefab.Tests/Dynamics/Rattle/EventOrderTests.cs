using System;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>The error of a run falls with the square of the step also through the moments at which limits are reached.</summary>
internal sealed class EventOrderTests
{
    private const double Duration = 1.2;
    private const int Coarsest = 64;
    private const int Halvings = 5;
    private const double LeastOrder = 1.8;

    [Test]
    public void Pendulum_ThatBouncesOffAStop_IsOfSecondOrder() => AssertOrder(() =>
    {
        var b = new MechanismBuilder();
        int bar = b.Bar(Vector3d.Zero, new Vector3d(0.7, 0, 0), 1.3);
        RevoluteJoint hinge = b.Hinge(JointModel.World, bar, Vector3d.Zero, Vector3d.UnitZ);
        Limits(hinge, -1.1, 0.4, new LimitResponse { Restitution = 0.7, BounceThreshold = 0.05 });
        return b.Build();
    });

    /// <summary>A driven arm pulls another by a spring into its stop, where it waits until the arm comes back.</summary>
    [Test]
    public void Follower_ThatDwellsAtItsStop_IsOfSecondOrder() => AssertOrder(() =>
    {
        var b = new MechanismBuilder { Gravity = Vector3d.Zero };
        int arm = b.Bar(Vector3d.Zero, new Vector3d(0.5, 0, 0), 2);
        int follower = b.Bar(new Vector3d(0, 0, 0.1), new Vector3d(0.3, 0, 0.1), 0.2);
        b.Change(arm, d => d with { AngularVelocity = new Vector3d(0, 0, 2), LinearVelocity = new Vector3d(0, 0.5, 0) });
        RevoluteJoint swing = b.Hinge(JointModel.World, arm, Vector3d.Zero, Vector3d.UnitZ);
        swing.Spring = new DriveModel { Stiffness = 6, ForceLimit = double.PositiveInfinity };
        RevoluteJoint stop = b.Hinge(JointModel.World, follower, Vector3d.Zero, Vector3d.UnitZ);
        Limits(stop, -0.25, 0.2, default);
        RevoluteJoint pull = b.Hinge(arm, follower, Vector3d.Zero, Vector3d.UnitZ);
        pull.Spring = new DriveModel { Stiffness = 3, Damping = 0.02, ForceLimit = double.PositiveInfinity };
        return b.Build();
    });

    /// <summary>A bolt on a spring runs against a soft buffer and back against its hard stop.</summary>
    [Test]
    public void Latch_WithASpring_IsOfSecondOrder() => AssertOrder(() =>
    {
        var b = new MechanismBuilder();
        int bolt = b.Bar(Vector3d.Zero, new Vector3d(0.2, 0, 0), 0.3);
        b.Change(bolt, d => d with { AngularVelocity = new Vector3d(0, 0, 4), LinearVelocity = new Vector3d(0, 0.4, 0) });
        RevoluteJoint hinge = b.Hinge(JointModel.World, bolt, Vector3d.Zero, Vector3d.UnitZ);
        Limits(hinge, -0.3, 3, new LimitResponse { Restitution = 0.9, BounceThreshold = 0.01 });
        hinge.Spring = new DriveModel { Stiffness = 0.8, ForceLimit = double.PositiveInfinity };
        RevoluteJoint buffer = b.Hinge(JointModel.World, bolt, Vector3d.Zero, Vector3d.UnitZ);
        Limits(buffer, -3, 0.15, new LimitResponse { Stiffness = 12, Damping = 0.002 });
        return b.Build();
    });

    /// <summary>A loop falls until its rocker's stop throws it back.</summary>
    [Test]
    public void FourBar_WhoseRockerBounces_IsOfSecondOrder() => AssertOrder(() =>
    {
        var b = new MechanismBuilder();
        Vector3d crankEnd = new(0.1, 0.25, 0), rockerEnd = new(0.8, 0.5, 0), rocker = new(0.7, -0.1, 0);
        int crank = b.Bar(Vector3d.Zero, crankEnd, 0.6);
        int coupler = b.Bar(crankEnd, rockerEnd, 1.1);
        int swing = b.Bar(rocker, rockerEnd, 0.8);
        b.Hinge(JointModel.World, crank, Vector3d.Zero, Vector3d.UnitZ);
        b.Hinge(crank, coupler, crankEnd, Vector3d.UnitZ);
        b.Hinge(coupler, swing, rockerEnd, Vector3d.UnitZ);
        RevoluteJoint stop = b.Hinge(JointModel.World, swing, rocker, Vector3d.UnitZ);
        Limits(stop, -0.35, 0.3, new LimitResponse { Restitution = 0.6, BounceThreshold = 0.01 });
        return b.Build();
    });

    /// <summary>A block on a rail, whose far stop throws back a pendulum that hangs on it.</summary>
    [Test]
    public void Slider_ThatRunsAgainstItsEnd_IsOfSecondOrder() => AssertOrder(() =>
    {
        var b = new MechanismBuilder();
        int block = b.Bar(new Vector3d(-0.1, 0, 0), new Vector3d(0.1, 0, 0), 0.9);
        int bob = b.Bar(Vector3d.Zero, new Vector3d(0.2, -0.5, 0), 0.7);
        b.Change(block, d => d with { LinearVelocity = new Vector3d(0.9, 0, 0) });
        b.Change(bob, d => d with { LinearVelocity = new Vector3d(0.9, 0, 0) });
        D6Joint rail = b.Add(new D6Joint { X = AxisMotion.Limited }, JointModel.World, block, Vector3d.Zero, Vector3d.UnitX);
        rail.LinearLimit = new LinearLimit { Value = 0.13, Response = new LimitResponse { Restitution = 0.8, BounceThreshold = 0.01 } };
        b.Hinge(block, bob, Vector3d.Zero, Vector3d.UnitZ);
        return b.Build();
    });

    /// <summary>A ball joint's pendulum swings out of its plane and bounces off its cone.</summary>
    [Test]
    public void Ball_ThatBouncesOffItsCone_IsOfSecondOrder() => AssertOrder(() =>
    {
        var b = new MechanismBuilder();
        int bar = b.Bar(Vector3d.Zero, new Vector3d(0, -0.6, 0), 1.2);
        b.Change(bar, d => d with { LinearVelocity = new Vector3d(0.9, 0, 0.5), AngularVelocity = new Vector3d(-0.5 / 0.3, 0, 0.9 / 0.3) });
        D6Joint ball = b.Add(new D6Joint { Twist = AxisMotion.Free, Swing1 = AxisMotion.Limited, Swing2 = AxisMotion.Limited }, JointModel.World, bar, Vector3d.Zero, -Vector3d.UnitY);
        ball.SwingLimit = new ConeLimit { Y = 0.35, Z = 0.5, Response = new LimitResponse { Restitution = 0.75, BounceThreshold = 0.01 } };
        return b.Build();
    });

    private static void AssertOrder(Func<MultibodySystem> make)
    {
        double[] exact = End(make(), Coarsest << (Halvings + 4));
        var errors = new double[Halvings + 1];
        for (int i = 0; i <= Halvings; i++)
        {
            double[] end = End(make(), Coarsest << i);
            for (int k = 0; k < end.Length; k++)
            {
                errors[i] = Math.Max(errors[i], Math.Abs(end[k] - exact[k]));
            }
        }

        double order = Math.Log2(errors[0] / errors[Halvings]) / Halvings;
        TestContext.Out.WriteLine($"{order:0.00}: {string.Join(' ', Array.ConvertAll(errors, e => e.ToString("0.0e+0", System.Globalization.CultureInfo.InvariantCulture)))}");
        Assert.That(order, Is.GreaterThanOrEqualTo(LeastOrder), string.Join(" ", errors));
    }

    // Where the bodies are and how fast they turn; each of them turns about Z.
    private static double[] End(MultibodySystem m, int steps)
    {
        var solver = new RattleSolver(m);
        for (int i = 0; i < steps; i++)
        {
            solver.Step(Duration / steps);
        }

        Assert.That(m.Stops, Is.Zero);
        var end = new double[2 * m.Bodies.Count];
        for (int i = 0; i < m.Bodies.Count; i++)
        {
            end[2 * i] = m.Bodies.Poses[i].Position.X;
            end[2 * i + 1] = m.Bodies.AngularVelocities[i].Z;
        }

        return end;
    }

    private static void Limits(RevoluteJoint hinge, double lower, double upper, LimitResponse response)
    {
        hinge.LimitEnabled = true;
        hinge.Limit = new AngularLimit { Lower = lower, Upper = upper, Response = response };
    }
}
