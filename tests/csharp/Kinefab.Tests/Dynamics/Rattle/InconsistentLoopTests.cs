using System;
using System.Collections.Concurrent;
using System.Threading.Tasks;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Loops that cannot be closed as their axes stand: whatever their angles give, no energy comes of it, and they go on.</summary>
internal sealed class InconsistentLoopTests
{
    private const int Seeds = 30;
    private const int Steps = 150;
    private const double MostGain = 1e-3;
    private const double MostGap = 1e-8;

    // Of the way of a body that a step four times shorter may change: the angles are springs of the mechanism, not of the step.
    private const double MostChange = 0.02;

    [Test]
    public void Step_FourBarsWithTiltedAxes_MakeNoEnergyAndGoOn() => AssertSound(seed => FourBar(new Random(seed)));

    [Test]
    public void Step_TwoBallsWithALockedTwist_MakeNoEnergyAndGoOn() => AssertSound(seed => TwoBalls(new Random(seed)));

    [Test]
    public void Step_TiltedAxisInShorterSteps_SameMotion()
    {
        MultibodySystem coarse = SolverScenes.FourBars(1, 1e-2), fine = SolverScenes.FourBars(1, 1e-2);
        RattleSolver one = new(coarse), four = new(fine);
        double way = 0, change = 0;
        Vector3d start = coarse.Bodies.Poses[1].Position;
        for (int i = 0; i < 100; i++)
        {
            one.Step(1.0 / 60);
            for (int part = 0; part < 4; part++)
            {
                four.Step(1.0 / 240);
            }

            way = Math.Max(way, (coarse.Bodies.Poses[1].Position - start).Length);
            change = Math.Max(change, (coarse.Bodies.Poses[1].Position - fine.Bodies.Poses[1].Position).Length);
        }

        Assert.That(change, Is.LessThanOrEqualTo(MostChange * way));
    }

    private static void AssertSound(Func<int, MultibodySystem> make)
    {
        var faults = new ConcurrentDictionary<int, string>();
        Parallel.For(0, Seeds, seed =>
        {
            MultibodySystem m = make(seed);
            Assert.That(LoopConsistencyProbe.Find(m), Is.Not.Empty, $"seed {seed} is no such loop");
            var solver = new RattleSolver(m);
            double dt = new Random(seed).Next(4) switch { 0 => 1 / 240.0, 1 => 1 / 60.0, 2 => 0.02, _ => 1 / 30.0 };
            double start = MechanismMeasures.Energy(m);
            double largest = MechanismMeasures.Kinetic(m) + MechanismMeasures.FallEnergy(m, 2 * dt);
            for (int i = 0; i < Steps && !faults.ContainsKey(seed); i++)
            {
                solver.Step(dt);
                double energy = MechanismMeasures.Energy(m);
                largest = Math.Max(largest, Math.Max(MechanismMeasures.Kinetic(m), start - energy));
                if (m.Stops > 0 || !(energy - start <= MostGain * largest) || !(MechanismMeasures.Drift(m) <= MostGap))
                {
                    faults[seed] = $"{dt} s, step {i}: {m.Stops} stops, {energy - start} J above {largest} J, open by {MechanismMeasures.Drift(m)} m";
                }
            }
        });
        Assert.That(faults, Is.Empty);
    }

    // A quadrangle of bars on the world; one or two of its hinges' axes are off, some have limits.
    private static MultibodySystem FourBar(Random random)
    {
        var b = new MechanismBuilder();
        double scale = Math.Pow(10, Between(-1.5, 0.3));
        var points = new Vector3d[4];
        for (int i = 0; i < 4; i++)
        {
            double angle = Math.PI * (i + Between(-0.3, 0.3)) / 2, radius = scale * Between(0.5, 1);
            points[i] = new Vector3d(radius * Math.Cos(angle), radius * Math.Sin(angle), 0);
        }

        int last = JointModel.World;
        for (int i = 0; i < 4; i++)
        {
            int bar = i == 3 ? JointModel.World : b.Bar(points[i], points[i + 1], Math.Pow(10, Between(-2, 1.5)), scale * Between(0.02, 0.2));
            double tilt = i == 2 || (i > 0 && random.Next(2) == 0) ? Math.Pow(10, Between(-3, -1.4)) : 0;
            RevoluteJoint hinge = b.Hinge(last, bar, points[i], new Vector3d(tilt, tilt * Between(-1, 1), 1));
            hinge.LimitEnabled = random.Next(3) == 0;
            hinge.Limit = new AngularLimit { Lower = -Between(0.05, 3), Upper = Between(0.05, 3) };
            last = bar;
        }

        return b.Build();

        double Between(double least, double most) => least + (most - least) * random.NextDouble();
    }

    // On a hinge, a body that hangs on another by two balls, and could turn about the line through them but for a locked turn nearly across it.
    private static MultibodySystem TwoBalls(Random random)
    {
        var b = new MechanismBuilder();
        Vector3d first = Any(0.5), second = first + Any(0.3), line = (second - first).Normalized();
        int inner = b.Bar(Any(0.5), Any(0.5), Between(0.1, 10));
        int outer = b.Bar(first, second + Any(0.3), Between(0.1, 10));
        b.Hinge(JointModel.World, inner, Any(0.5), Any(1));
        Vector3d axis = Vector3d.Cross(line, Any(1)).Normalized() + line * Math.Pow(10, Between(-3, -1.5));
        b.Add(Ball(AxisMotion.Free), inner, outer, first, axis);
        b.Add(Ball(AxisMotion.Locked), inner, outer, second, axis);
        b.Change(inner, d => { d.AngularVelocity = Any(2); return d; });
        return b.Build();

        double Between(double least, double most) => least + (most - least) * random.NextDouble();
        Vector3d Any(double size) => new(Between(-size, size), Between(-size, size), Between(-size, size));
        static D6Joint Ball(AxisMotion twist) => new() { Twist = twist, Swing1 = AxisMotion.Free, Swing2 = AxisMotion.Free };
    }
}
