using System;
using System.Collections.Generic;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Unkind scenes: masses over six decades, moments of inertia that no body has, loops, frames that do not meet, limits,
/// motors, springs, couplings, kinematic bodies, frozen axes, degenerate axes, coincident anchors, great speeds.
/// </summary>
internal sealed class RandomScene
{
    // The integral of 2 sin(q / 2) from 0 to half a turn; that of sin(q) is half as much.
    private const double MostOfSine = 4;

    private readonly Random _random;
    private readonly MechanismBuilder _builder = new();
    private readonly List<JointModel> _joints = new();
    private readonly List<bool> _isFixed = new();

    public RandomScene(int seed)
    {
        _random = new Random(seed);
        int bodies = _random.Next(1, 7);
        for (int i = 0; i < bodies; i++)
        {
            AddBody();
        }

        // One in ten is a knot of loops, most of which cannot move; the others are trees.
        bool isKnot = One(10);
        int joints = _random.Next(0, isKnot ? bodies + 3 : bodies + 1);
        for (int j = 0; j < joints; j++)
        {
            AddJoint(_random.Next(-1, isKnot ? bodies : j), isKnot ? _random.Next(-1, bodies) : j);
        }

        if (_joints.Count > 1 && One(4))
        {
            AddCoupling();
        }

        System = _builder.Build();
    }

    public MultibodySystem System { get; }

    /// <summary>Whether nothing feeds energy in but gravity and what springs hold at the start.</summary>
    public bool IsPassive { get; private set; } = true;

    /// <summary>Whether the joints hold as the bodies stand: anchors together, no hard limit passed.</summary>
    public bool IsWhole()
    {
        Span<ConstraintRow> rows = stackalloc ConstraintRow[JointModel.MaxRows];
        foreach (JointModel joint in System.Joints)
        {
            int count = joint.Prepare(System.Bodies.PoseOf(joint.Body0), System.Bodies.PoseOf(joint.Body1), rows);
            for (int i = 0; i < count; i++)
            {
                bool isHardLimit = rows[i].Has(RowFlags.Limit) && !rows[i].Has(RowFlags.Spring);
                if (isHardLimit && rows[i].GeometricError < 0)
                {
                    return false;
                }
            }
        }

        return MechanismMeasures.Drift(System) <= 1e-9;
    }

    /// <summary>Energy that springs hold at the start at most, J.</summary>
    public double Stored()
    {
        double sum = 0;
        Span<ConstraintRow> rows = stackalloc ConstraintRow[JointModel.MaxRows];
        foreach (JointModel joint in System.Joints)
        {
            int count = joint.Prepare(System.Bodies.PoseOf(joint.Body0), System.Bodies.PoseOf(joint.Body1), rows);
            for (int i = 0; i < count; i++)
            {
                double error = rows[i].GeometricError;
                bool isAtWork = rows[i].Has(RowFlags.Spring) && (!rows[i].Has(RowFlags.Limit) || error < 0);
                if (isAtWork)
                {
                    double mass = rows[i].Has(RowFlags.AccelerationSpring) ? 1 / Response(joint, rows[i]) : 1;
                    double most = IsSine(joint, rows[i]) ? MostOfSine : error * error / 2;
                    sum += rows[i].Stiffness * mass * most;
                }
            }
        }

        return sum;
    }

    // C of a twist drive is twice the sine of half its angle, of a swing drive the sine of the whole, while both push along
    // the axis: from behind a right angle they give more than k C^2 / 2.
    private static bool IsSine(JointModel joint, in ConstraintRow row) =>
        joint is D6Joint && !row.Has(RowFlags.Limit) && row.Linear0 == Vector3d.Zero && row.Hint != SolveHint.SlerpSpring;

    private double Response(JointModel joint, in ConstraintRow row) =>
        Response(joint.Body0, row.Linear0, row.Angular0) + Response(joint.Body1, row.Linear1, row.Angular1);

    private double Response(int body, Vector3d linear, Vector3d angular)
    {
        if (body < 0 || System.Bodies.IsKinematic[body])
        {
            return 0;
        }

        Vector3d local = System.Bodies.Poses[body].Rotation.InverseRotate(angular);
        Vector3d inverse = System.Bodies.InverseInertias[body];
        return System.Bodies.InverseMasses[body] * linear.LengthSquared
            + inverse.X * local.X * local.X + inverse.Y * local.Y * local.Y + inverse.Z * local.Z * local.Z;
    }

    private void AddBody()
    {
        double mass = Power(-3, 3);
        double scale = Power(-6, 0) * mass;
        BodyDefinition d = BodyDefinition.Default;
        d.Pose = new Pose(Vector(1), new Quaterniond(Number(), Number(), Number(), 1).Normalized());
        d.Mass = mass;
        d.Inertia = One(6)
            ? new Vector3d(1, 1, 100) * scale
            : new Vector3d(One(12) ? 0 : 1 + Number(), One(12) ? 0 : 1 + Number(), 1 + Number()) * scale;
        d.LinearVelocity = Vector(One(10) ? 1000 : 5);
        d.AngularVelocity = Vector(One(10) ? 1000 : 5);
        d.MaxAngularSpeed = One(2) ? 7 : 1e4;
        d.IsKinematic = One(12);
        _isFixed.Add(d.IsKinematic);
        if (d.IsKinematic)
        {
            d.LinearVelocity = Vector3d.Zero;
            d.AngularVelocity = Vector3d.Zero;
        }

        int body = _builder.Body(d);
        if (One(12) && !d.IsKinematic)
        {
            // As World freezes positions.
            var frozen = new D6Joint { X = Motion(false), Y = Motion(false), Z = Motion(false), Twist = AxisMotion.Free, Swing1 = AxisMotion.Free, Swing2 = AxisMotion.Free };
            _builder.Add(frozen, JointModel.World, body, new Pose(d.Pose.Position, Quaterniond.Identity));
        }
    }

    private void AddJoint(int body0, int body1)
    {
        if (body0 == body1 || (IsFixed(body0) && IsFixed(body1)))
        {
            return;
        }

        Vector3d axis = One(8) ? Vector3d.Zero : Vector(1);
        Vector3d point = One(4) ? Vector3d.Zero : Vector(1);
        Vector3d x = axis.Normalized();
        Vector3d y = Vector3d.Perpendicular(x);
        var frame = new Pose(point, axis == Vector3d.Zero ? Quaterniond.Identity : Quaterniond.FromAxes(x, y, Vector3d.Cross(x, y)));
        JointModel joint = _builder.Add(One(3) ? (JointModel)Hinge() : SixAxes(), body0, body1, frame);
        _joints.Add(joint);
        if (One(6))
        {
            joint.Frame1 = new Pose(joint.Frame1.Position + Vector(0.1), joint.Frame1.Rotation);
            IsPassive = false;
        }
    }

    private void AddCoupling()
    {
        JointModel a = _joints[0];
        JointModel b = _joints[^1];
        if (a is RevoluteJoint && b is RevoluteJoint)
        {
            _builder.Couple(b, (a, 4 * Number() - 2));
        }
    }

    private bool IsFixed(int body) => body < 0 || _isFixed[body];

    private RevoluteJoint Hinge()
    {
        bool hasMotor = One(4);
        IsPassive &= !hasMotor;
        return new RevoluteJoint
        {
            LimitEnabled = One(2),
            Limit = new AngularLimit { Lower = -Number(), Upper = Number() - 0.1, Response = Response() },
            MotorEnabled = hasMotor,
            MotorVelocity = 20 * Number() - 10,
            MotorForceLimit = 100 * Number(),
            Spring = Drive(),
        };
    }

    private D6Joint SixAxes() => new()
    {
        X = Motion(true), Y = Motion(true), Z = Motion(true),
        Twist = Motion(true), Swing1 = Motion(true), Swing2 = Motion(true),
        LinearLimit = new LinearLimit { Value = Number(), Response = Response() },
        TwistLimit = new AngularLimit { Lower = -Number(), Upper = Number(), Response = Response() },
        SwingLimit = new ConeLimit { Y = 0.1 + Number(), Z = 0.1 + Number(), Response = Response() },
        DriveX = Drive(), DriveTwist = Drive(), DriveSwing = Drive(), DriveSlerp = Drive(),
        DrivePose = One(3) ? new Pose(Vector(0.5), new Quaterniond(Number(), 0, Number(), 1).Normalized()) : Pose.Identity,
    };

    private AxisMotion Motion(bool isLimited) => isLimited ? (AxisMotion)_random.Next(3) : One(2) ? AxisMotion.Locked : AxisMotion.Free;

    private LimitResponse Response() => One(2)
        ? new LimitResponse { Restitution = Number(), BounceThreshold = 0.2 }
        : new LimitResponse { Stiffness = Power(0, 6), Damping = Power(0, 3) };

    private DriveModel Drive() => One(2)
        ? default
        : new DriveModel
        {
            Stiffness = Power(0, 6), Damping = Power(0, 4),
            ForceLimit = One(2) ? double.PositiveInfinity : 100 * Number(), IsAcceleration = One(2),
        };

    private bool One(int of) => _random.Next(of) == 0;

    private double Number() => _random.NextDouble();

    private double Power(double low, double high) => Math.Pow(10, low + (high - low) * Number());

    private Vector3d Vector(double size) => new(size * (2 * Number() - 1), size * (2 * Number() - 1), size * (2 * Number() - 1));
}
