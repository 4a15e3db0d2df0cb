using System;
using System.Linq;
using System.Runtime.InteropServices;
using System.Threading;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Pgs;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using Kinefab.Tests.Dynamics.Rattle;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics;

public sealed class StepThreadsTests
{
    private static readonly Func<MultibodySystem>[] Scenes =
    [
        () => RandomMechanism.Make(Enumerable.Range(0, 40).ToArray()),
        () => SolverScenes.DoublePendulums(300),
        () => SolverScenes.FourBars(150),
        OnAMovingPlatform,
    ];

    [Test]
    public void Step_ByThreeThreads_HasTheBitsOfOne([Values] SolverKind solver, [Range(0, 3)] int scene)
    {
        (MultibodySystem one, MultibodySystem three) = (Scenes[scene](), Scenes[scene]());
        three.Threads = 3;
        (ISolver ofOne, ISolver ofThree) = (Make(solver, one), Make(solver, three));
        for (int i = 0; i < 20; i++)
        {
            Drive(one, i);
            Drive(three, i);
            ofOne.Step(1.0 / 60);
            ofThree.Step(1.0 / 60);
        }

        Assert.That(Bits(three), Is.EqualTo(Bits(one)).AsCollection);
        Assert.That((three.Stops, three.SubstepWork, three.Unsolved.Count), Is.EqualTo((one.Stops, one.SubstepWork, one.Unsolved.Count)));
    }

    // What breaks leaves its island in two.
    [Test]
    public void Step_WhereJointsBreak_HasTheBitsOfOneThread([Values] SolverKind solver)
    {
        MultibodySystem[] systems = [SolverScenes.DoublePendulums(150), SolverScenes.DoublePendulums(150)];
        systems[1].Threads = 3;
        foreach (MultibodySystem system in systems)
        {
            for (int i = 1; i < system.Joints.Length; i += 6)
                system.Joints[i].BreakForce = 8 + 0.01 * i;
            ISolver solved = Make(solver, system);
            for (int i = 0; i < 60; i++)
                solved.Step(1.0 / 60);
        }

        Assert.That(systems[0].Joints.Count(joint => joint.IsBroken), Is.GreaterThan(10));
        Assert.That(Bits(systems[1]), Is.EqualTo(Bits(systems[0])).AsCollection);
    }

    [Test]
    public void Step_BySeveralThreads_AllocatesNothing([Values] SolverKind solver)
    {
        MultibodySystem system = SolverScenes.DoublePendulums(300);
        system.Threads = 2;
        ISolver solved = Make(solver, system);
        for (int i = 0; i < 5; i++)
            solved.Step(1.0 / 60);
        Assert.That(AllocatedBytes.LeastOf(Run), Is.Zero);

        void Run()
        {
            for (int i = 0; i < 20; i++)
                solved.Step(1.0 / 60);
        }
    }

    [Test]
    public void Threads_OfAWorld_AreOneUnlessSet([Values] SolverKind solver)
    {
        World world = SmallScene.Create(new HingeJoint { UseMotor = true, Motor = new JointMotor { Force = 3, TargetVelocity = 70 } }, solver: solver);
        World other = SmallScene.Create(new HingeJoint { UseMotor = true, Motor = new JointMotor { Force = 3, TargetVelocity = 70 } }, solver: solver);
        Assert.That(world.Threads, Is.EqualTo(1));
        Assert.That(() => world.Threads = 0, Throws.InstanceOf<ArgumentOutOfRangeException>());
        world.Threads = 4;
        world.Step(0.02);
        other.Step(0.02);
        Assert.That((world.Threads, world.StateHash()), Is.EqualTo((4, other.StateHash())));
    }

    [Test]
    public void ForEach_DoesEachPartOnceAndThrowsWhatOneThrew()
    {
        var parts = new Counted(200);
        StepThreads.ForEach(parts, 200, 4);
        Assert.That(parts.Done, Is.All.EqualTo(1));

        parts.Fails = true;
        Assert.That(() => StepThreads.ForEach(parts, 200, 4), Throws.InstanceOf<InvalidTimeZoneException>());
        Assert.That(parts.Done, Is.All.EqualTo(2));

        parts.Fails = false;
        StepThreads.ForEach(parts, 200, 4);
        Assert.That(parts.Done, Is.All.EqualTo(3));
    }

    [Test]
    public void ForEach_WithinAPart_DoesItsPartsByItself()
    {
        var inner = new Counted(100);
        var outer = new Nested(inner);
        StepThreads.ForEach(outer, 64, 3);
        Assert.That((outer.Done, inner.Done.Distinct().Single()), Is.EqualTo((64, 64)));
    }

    // The threads help one world at a time.
    [Test]
    public void ForEach_FromSeveralThreadsAtOnce_DoesAllParts()
    {
        Counted[] parts = Enumerable.Range(0, 6).Select(_ => new Counted(500)).ToArray();
        Thread[] callers = parts.Select(own => new Thread(() => StepThreads.ForEach(own, 500, 3))).ToArray();
        foreach (Thread caller in callers)
            caller.Start();
        foreach (Thread caller in callers)
            caller.Join();
        Assert.That(parts.SelectMany(own => own.Done), Is.All.EqualTo(1));
    }

    private static ISolver Make(SolverKind solver, MultibodySystem system) => solver == SolverKind.Unity ? new PgsSolver(system) : new RattleSolver(system);

    private static long[] Bits(MultibodySystem system)
    {
        double[] numbers =
        [
            .. MemoryMarshal.Cast<Pose, double>(system.Bodies.Poses),
            .. MemoryMarshal.Cast<Vector3d, double>(system.Bodies.LinearVelocities),
            .. MemoryMarshal.Cast<Vector3d, double>(system.Bodies.AngularVelocities),
            .. MemoryMarshal.Cast<JointReaction, double>(system.Reactions),
        ];
        return Array.ConvertAll(numbers, BitConverter.DoubleToInt64Bits);
    }

    // Kinematic bodies, which several islands may share, go up and down.
    private static void Drive(MultibodySystem system, int step)
    {
        for (int i = 0; i < system.Bodies.Count; i++)
        {
            if (system.Bodies.IsKinematic[i])
            {
                Pose pose = system.Bodies.Poses[i];
                system.Bodies.KinematicTargets[i] = new Pose(pose.Position + new Vector3d(0, 0.01 * Math.Cos(step), 0.002), pose.Rotation);
            }
        }
    }

    private static MultibodySystem OnAMovingPlatform()
    {
        var builder = new MechanismBuilder();
        BodyDefinition definition = BodyDefinition.Default;
        definition.Pose = Pose.Identity;
        definition.IsKinematic = true;
        int platform = builder.Body(definition);
        for (int i = 0; i < 200; i++)
        {
            var origin = new Vector3d(0.1 * i, 0, 0);
            int bar = builder.Bar(origin, origin + new Vector3d(0, -1, 0.003 * i), 1);
            builder.Hinge(platform, bar, origin, Vector3d.UnitX);
        }

        return builder.Build();
    }

    private sealed class Nested(Counted inner) : IStepParts
    {
        private int _done;

        public int Done => _done;

        public void Do(int part)
        {
            StepThreads.ForEach(inner, 100, 3);
            Interlocked.Increment(ref _done);
        }
    }

    private sealed class Counted(int count) : IStepParts
    {
        public int[] Done { get; } = new int[count];

        public bool Fails { get; set; }

        public void Do(int part)
        {
            Interlocked.Increment(ref Done[part]);
            if (Fails && part % 50 == 7)
                throw new InvalidTimeZoneException();
        }
    }
}
