using System;
using System.Collections.Generic;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Closed loops that can be met as they stand: polygons of four to six bars on parallel hinges, spatial loops of mixed
/// joints, ladders; with limits, motors, springs and gears in them, on the world or on a kinematic body that moves,
/// joints between their bodies either way round, scaled masses, joints that break.
/// </summary>
internal sealed class RandomLoop
{
    private readonly Random _random;
    private readonly MechanismBuilder _builder = new();
    private readonly List<RevoluteJoint> _motors = new();
    private readonly double[] _lastAngles;

    public RandomLoop(int seed)
    {
        _random = new Random(seed);
        Ground = One(4) ? Kinematic() : JointModel.World;
        switch (seed % 3)
        {
            case 0:
                AddPolygon(_random.Next(4, 7));
                break;
            case 1:
                AddSpatial();
                break;
            default:
                AddLadder();
                break;
        }

        System = _builder.Build();
        for (int i = 0; i < System.Bodies.Count; i++)
        {
            if (!System.Bodies.IsKinematic[i])
            {
                System.Bodies.LinearDampings[i] = One(4) ? 0.2 : 0;
                System.Bodies.AngularDampings[i] = One(2) ? 0.05 : 0;
            }
        }

        _lastAngles = new double[_motors.Count];
        MotorWork();
        Work = 0;
    }

    public MultibodySystem System { get; }

    /// <summary>The body that carries the loop, or the world.</summary>
    public int Ground { get; }

    /// <summary>Whether masses are scaled or the ground moves, so that no balance of energy holds.</summary>
    public bool IsBalanced { get; private set; } = true;

    /// <summary>The most that the motors can have done, J: their torques times the ways of their hinges.</summary>
    public double Work { get; private set; }

    /// <summary>Moves the ground by one step.</summary>
    public void Move(double dt)
    {
        if (Ground != JointModel.World)
        {
            Pose p = System.Bodies.KinematicTargets[Ground];
            System.Bodies.KinematicTargets[Ground] = new Pose(
                p.Position + new Vector3d(0.5 * dt, 0, 0), (Quaterniond.AxisAngle(Vector3d.UnitY, dt) * p.Rotation).Normalized());
        }
    }

    /// <summary>Adds what the motors can have done in the step just taken.</summary>
    public void MotorWork()
    {
        for (int i = 0; i < _motors.Count; i++)
        {
            RevoluteJoint motor = _motors[i];
            double angle = motor.Angle(System.Bodies.PoseOf(motor.Body0), System.Bodies.PoseOf(motor.Body1));
            Work += motor.MotorForceLimit * Math.Abs(Math.IEEERemainder(angle - _lastAngles[i], 2 * Math.PI));
            _lastAngles[i] = angle;
        }
    }

    // Any polygon closes as it stands: 4 bars have one freedom, 5 two, 6 three.
    private void AddPolygon(int corners)
    {
        Quaterniond tilt = Rotation();
        Vector3d axis = tilt * Vector3d.UnitZ;
        var points = new Vector3d[corners];
        for (int i = 0; i < corners; i++)
        {
            double angle = 2 * Math.PI * (i + 0.6 * Number()) / corners;
            points[i] = tilt * (new Vector3d(Math.Cos(angle), Math.Sin(angle), 0) * (0.3 + Number()));
        }

        int last = Ground;
        RevoluteJoint? first = null;
        for (int i = 0; i + 1 < corners; i++)
        {
            int bar = _builder.Bar(points[i], points[i + 1], Mass());
            RevoluteJoint hinge = Hinge(last, bar, points[i], axis);
            first ??= hinge;
            last = bar;
        }

        Hinge(last, Ground, points[^1], axis);
        if (One(3))
        {
            AddGear(first!, last, points[^2], axis);
        }
    }

    // A wheel on a bar of the loop, geared to the loop's first hinge.
    private void AddGear(RevoluteJoint hinge, int bar, Vector3d point, Vector3d axis)
    {
        int wheel = _builder.Body(point + axis * 0.1, Quaterniond.Identity, Mass(), new Vector3d(0.01, 0.012, 0.015));
        var own = new RevoluteJoint();
        _builder.Add(own, bar, wheel, point, axis);
        _builder.Couple(own, (hinge, 4 * Number() - 2));
    }

    // A hinge, joints of two or three angular freedoms, a hinge or a slide: one freedom or more.
    private void AddSpatial()
    {
        var points = new Vector3d[5];
        for (int i = 0; i < points.Length; i++)
        {
            points[i] = Vector(1) + new Vector3d(i, 0, 0);
        }

        int a = _builder.Bar(points[0], points[1], Mass());
        int b = _builder.Bar(points[1], points[2], Mass());
        int c = _builder.Bar(points[2], points[3], Mass());
        Hinge(Ground, a, points[0], Vector(1));
        AddBall(a, b, points[1]);
        AddBall(b, c, points[2]);
        if (One(2))
        {
            Hinge(Ground, c, points[3], Vector(1));
            return;
        }

        int slider = _builder.Body(points[3], Rotation(), Mass(), new Vector3d(0.1, 0.12, 0.15));
        AddBall(c, slider, points[3]);
        _builder.Add(
            new D6Joint
            {
                X = One(2) ? AxisMotion.Limited : AxisMotion.Free, LinearLimit = new LinearLimit { Value = 0.1 + Number(), Response = Response() },
                DriveX = Spring(),
            },
            Ground, slider, points[3], Vector(1));
    }

    private void AddBall(int body0, int body1, Vector3d point)
    {
        bool isCone = One(3);
        var joint = new D6Joint
        {
            Twist = One(3) ? AxisMotion.Limited : AxisMotion.Free,
            Swing1 = isCone ? AxisMotion.Limited : AxisMotion.Free, Swing2 = isCone ? AxisMotion.Limited : AxisMotion.Free,
            TwistLimit = new AngularLimit { Lower = -0.1 - Number(), Upper = 0.1 + Number(), Response = Response() },
            SwingLimit = new ConeLimit { Y = 0.2 + Number(), Z = 0.2 + Number(), Response = Response() },
            DriveSlerp = Spring(),
        };
        Finish(joint);
        Join(joint, body0, body1, point, Vector(1));
    }

    // A rod between two slides, and a second rod hung to its middle.
    private void AddLadder()
    {
        Quaterniond tilt = Rotation();
        Vector3d x = tilt * Vector3d.UnitX, y = tilt * Vector3d.UnitY, z = tilt * Vector3d.UnitZ;
        double angle = 0.3 + Number();
        Vector3d foot = x * Math.Cos(angle), head = y * Math.Sin(angle);
        int rod = _builder.Bar(foot, head, Mass());
        AddSlide(rod, foot, x, y, z);
        AddSlide(rod, head, y, -x, z);
        int hung = _builder.Bar((foot + head) * 0.5, (foot + head) * 0.5 + Vector(1), Mass());
        Hinge(rod, hung, (foot + head) * 0.5, One(2) ? z : Vector(1));
    }

    // The end of the rod slides along x, and the rod turns about z, both in the ground.
    private void AddSlide(int rod, Vector3d point, Vector3d x, Vector3d y, Vector3d z)
    {
        var joint = new D6Joint
        {
            X = One(3) ? AxisMotion.Limited : AxisMotion.Free, Swing2 = AxisMotion.Free,
            LinearLimit = new LinearLimit { Value = 0.1 + Number(), Response = Response() },
        };
        Finish(joint);
        _builder.Add(joint, Ground, rod, new Pose(point, Quaterniond.FromAxes(x, y, z)));
    }

    private RevoluteJoint Hinge(int body0, int body1, Vector3d point, Vector3d axis)
    {
        var joint = new RevoluteJoint
        {
            LimitEnabled = One(4),
            Limit = new AngularLimit { Lower = -0.05 - Number(), Upper = 0.05 + Number(), Response = Response() },
            MotorEnabled = One(6), MotorVelocity = 10 * Number() - 5, MotorForceLimit = 20 * Number(), MotorFreeSpin = One(3),
            Spring = Spring(),
        };
        if (joint.MotorEnabled)
        {
            _motors.Add(joint);
        }

        Finish(joint);
        Join(joint, body0, body1, point, axis);
        return joint;
    }

    private void Finish(JointModel joint)
    {
        joint.BreakForce = One(12) ? 300 * Number() : double.PositiveInfinity;
        joint.BreakTorque = One(12) ? 100 * Number() : double.PositiveInfinity;
        if (One(8))
        {
            joint.InverseMassScale0 = 0.5 + Number();
            joint.InverseInertiaScale1 = 0.5 + Number();
            IsBalanced = false;
        }
    }

    // Which body is body 0 changes a joint's freedoms of more than one angle, and no loop.
    private void Join(JointModel joint, int body0, int body1, Vector3d point, Vector3d axis)
    {
        bool isSwapped = One(3);
        _builder.Add(joint, isSwapped ? body1 : body0, isSwapped ? body0 : body1, point, axis);
    }

    private int Kinematic()
    {
        BodyDefinition d = BodyDefinition.Default;
        d.Pose = new Pose(Vector(1), Rotation());
        d.IsKinematic = true;
        IsBalanced = false;
        return _builder.Body(d);
    }

    // At rest where it starts.
    private DriveModel Spring() => One(3) ? new DriveModel { Stiffness = Power(0, 3), Damping = Power(-1, 1), ForceLimit = double.PositiveInfinity } : default;

    private LimitResponse Response() => One(2)
        ? new LimitResponse { Restitution = One(2) ? Number() : 0, BounceThreshold = 0.2 }
        : new LimitResponse { Stiffness = Power(2, 4), Damping = Power(0, 1) };

    private double Mass() => One(8) ? Power(-3, 3) : Power(-1, 1);

    private Quaterniond Rotation() => new Quaterniond(Number(), Number(), Number(), 1).Normalized();

    private bool One(int of) => _random.Next(of) == 0;

    private double Number() => _random.NextDouble();

    private double Power(double low, double high) => Math.Pow(10, low + (high - low) * Number());

    private Vector3d Vector(double size) => new(size * (2 * Number() - 1), size * (2 * Number() - 1), size * (2 * Number() - 1));
}
