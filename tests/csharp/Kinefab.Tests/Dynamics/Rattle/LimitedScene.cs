using System;
using System.Collections.Generic;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Scenes that have a motion and make it hard to find: all joints hold where the bodies stand, and the motion runs into limits, over half a
/// turn, into cones and against stiff springs, with masses over six decades, needles and grains, couplings, joints that break and
/// bodies that are driven.
/// </summary>
internal sealed class LimitedScene
{
    private const int MostBodies = 6;

    private readonly Draw _draw;
    private readonly MechanismBuilder _builder = new();
    private readonly List<RevoluteJoint> _hinges = new();
    private readonly List<Pose> _poses = new();
    private readonly List<Vector3d> _halves = new();
    private readonly List<bool> _isDriven = new();

    public LimitedScene(int seed)
    {
        _draw = new Draw(seed);
        Step = _draw.Power(-3, -1.5);
        int bodies = _draw.From(1, MostBodies + 1);
        for (int i = 0; i < bodies; i++)
        {
            int parent = _draw.One(4) ? _draw.From(-1, i) : i - 1;
            AddBody(parent, out Vector3d point);
            if (!_isDriven[i])
            {
                AddJoint(parent, i, point);
            }
        }

        if (_draw.One(6) && bodies > 2 && !_isDriven.Contains(true))
        {
            // A loop: as it stands it is closed.
            AddJoint(-1, bodies - 1, _poses[^1].Point(Inside(bodies - 1)));
        }

        if (_hinges.Count > 1 && _draw.One(3))
        {
            AddCoupling();
        }

        System = _builder.Build();
        if (_draw.One(4))
        {
            // Without a start that the joints forbid.
            Array.Clear(System.Bodies.LinearVelocities, 0, bodies);
            Array.Clear(System.Bodies.AngularVelocities, 0, bodies);
        }
    }

    public MultibodySystem System { get; }

    /// <summary>Seconds.</summary>
    public double Step { get; }

    /// <summary>Whether no energy comes in but from gravity and springs that have a potential.</summary>
    public bool IsPassive { get; private set; } = true;

    /// <summary>Moves the targets of the driven bodies; before a step that ends at a time.</summary>
    public void Drive(double time)
    {
        for (int i = 0; i < _poses.Count; i++)
        {
            if (_isDriven[i])
            {
                double way = 0.1 * Math.Sin(5 * time);
                System.Bodies.KinematicTargets[i] = new Pose(
                    _poses[i].Position + new Vector3d(way, 0, 0), (Quaterniond.AxisAngle(Vector3d.UnitZ, way) * _poses[i].Rotation).Normalized());
            }
        }
    }

    /// <summary>Kinetic and gravitational energy and that in springs, J.</summary>
    public double Energy()
    {
        double sum = MechanismMeasures.Energy(System);
        Span<ConstraintRow> rows = stackalloc ConstraintRow[JointModel.MaxRows];
        foreach (JointModel joint in System.Joints)
        {
            if (joint.IsBroken)
            {
                continue;
            }

            int count = joint.PrepareForces(System.Bodies.PoseOf(joint.Body0), System.Bodies.PoseOf(joint.Body1), rows);
            for (int i = 0; i < count; i++)
            {
                double c = rows[i].GeometricError;
                bool isAtWork = rows[i].Has(RowFlags.Spring) && (!rows[i].Has(RowFlags.Limit) || c < 0);
                double most = Math.Min(Math.Abs(c), rows[i].Maximum / Math.Max(rows[i].Stiffness, 1e-200));
                sum += isAtWork ? rows[i].Stiffness * most * (Math.Abs(c) - most / 2) : 0;
            }
        }

        return sum;
    }

    // A box of a material between foam and lead, hung by a point of itself on a point of its parent.
    private void AddBody(int parent, out Vector3d point)
    {
        double mass = _draw.Power(-3, 3);
        double width = _draw.One(4) ? _draw.Power(-2.5, -1) : _draw.Between(0.2, 1);
        double depth = width * _draw.Between(0.5, 1);
        double size = Math.Cbrt(mass / (8 * _draw.Power(2, 4) * width * depth));
        var half = new Vector3d(size, size * width, size * depth);
        _halves.Add(half);
        Vector3d square = Vector3d.Scale(half, half) * (mass / 3);
        point = parent < 0 ? _draw.Vector(1) : _poses[parent].Point(Inside(parent));
        Quaterniond turn = _draw.Turn();
        BodyDefinition d = BodyDefinition.Default;
        d.Pose = new Pose(point - turn * Inside(_halves.Count - 1), turn);
        d.Mass = mass;
        d.Inertia = new Vector3d(square.Y + square.Z, square.X + square.Z, square.X + square.Y);
        d.LinearVelocity = _draw.Vector(_draw.One(8) ? 20 : 2);
        d.AngularVelocity = _draw.Vector(_draw.One(8) ? 100 : 5);
        d.MaxAngularSpeed = 1e4;
        d.AngularDamping = _draw.One(3) ? 0.05 : 0;
        d.IsKinematic = _draw.One(15);
        _isDriven.Add(d.IsKinematic);
        if (d.IsKinematic)
        {
            d.LinearVelocity = Vector3d.Zero;
            d.AngularVelocity = Vector3d.Zero;
            IsPassive = false;
        }

        _poses.Add(d.Pose);
        _builder.Body(d);
    }

    // One in ten anchors is out of the body.
    private Vector3d Inside(int body) => Vector3d.Scale(_draw.Vector(1), _halves[body]) + (_draw.One(10) ? _draw.Vector(0.3) : Vector3d.Zero);

    private void AddJoint(int body0, int body1, Vector3d point)
    {
        Vector3d x = _draw.Vector(1).Normalized();
        Vector3d y = Vector3d.Perpendicular(x);
        JointModel joint = _draw.One(2) ? Hinge() : SixAxes();
        joint.DriveLimitsAreForces = true;
        _builder.Add(joint, body0, body1, new Pose(point, Quaterniond.FromAxes(x, y, Vector3d.Cross(x, y))));
        if (_draw.One(12))
        {
            joint.BreakForce = _draw.Power(0, 4);
            joint.BreakTorque = _draw.Power(-1, 3);
        }
    }

    private void AddCoupling() => _builder.Couple(_hinges[^1], (_hinges[0], _draw.Between(-3, 3)));

    private RevoluteJoint Hinge()
    {
        bool hasMotor = _draw.One(6);
        IsPassive &= !hasMotor;
        var hinge = new RevoluteJoint
        {
            LimitEnabled = !_draw.One(4),
            Limit = Range(),
            MotorEnabled = hasMotor,
            MotorVelocity = _draw.Between(-20, 20),
            MotorForceLimit = _draw.Power(-1, 3),
            Spring = Spring(3),
        };
        _hinges.Add(hinge);
        return hinge;
    }

    // Gears and springs of twist and swing have no potential of their C.
    private D6Joint SixAxes()
    {
        bool isBall = _draw.One(2);
        var joint = new D6Joint
        {
            X = Motion(isBall), Y = Motion(isBall), Z = Motion(isBall),
            Twist = Motion(false), Swing1 = Motion(false), Swing2 = Motion(false),
            LinearLimit = new LinearLimit { Value = _draw.One(4) ? _draw.Power(-5, -2) : _draw.Between(0.01, 0.5), Response = Response() },
            TwistLimit = Range(),
            SwingLimit = new ConeLimit { Y = _draw.Power(-2, 0.4), Z = _draw.Power(-2, 0.4), Response = Response() },
            DriveX = Spring(3),
            DriveY = Spring(6),
            DriveTwist = _draw.One(4) ? Spring(1) : default,
            DriveSlerp = _draw.One(4) ? Spring(1) : default,
        };
        IsPassive &= joint.Layout().IsSlerp ? double.IsInfinity(joint.DriveSlerp.ForceLimit) : joint.DriveTwist.Stiffness == 0;
        IsPassive &= !(joint.Swing1 == AxisMotion.Limited && joint.Swing2 == AxisMotion.Limited && joint.SwingLimit.Response.IsSoft);
        return joint;
    }

    private AxisMotion Motion(bool isLocked)
    {
        int number = _draw.Below(6);
        return isLocked || number < 2 ? AxisMotion.Locked : number < 5 ? AxisMotion.Limited : AxisMotion.Free;
    }

    // With zero, where the joint stands, inside it or at an end.
    private AngularLimit Range()
    {
        double lower = _draw.One(6) ? 0 : _draw.One(6) ? -Math.PI : -_draw.Power(-2, 0.497);
        double upper = _draw.One(6) && lower < 0 ? 0 : _draw.One(6) ? Math.PI : _draw.Power(-2, 0.497);
        return new AngularLimit { Lower = lower, Upper = upper, Response = Response() };
    }

    private LimitResponse Response() =>
        _draw.One(4) ? new LimitResponse { Stiffness = _draw.Power(-3, 9), Damping = _draw.One(2) ? _draw.Power(-3, 5) : 0 }
        : _draw.One(2) ? new LimitResponse { Restitution = _draw.Between(0, 1), BounceThreshold = _draw.Between(0.01, 1) }
        : default;

    private DriveModel Spring(int rarity) => !_draw.One(rarity)
        ? default
        : new DriveModel
        {
            Stiffness = _draw.Power(-3, 9),
            Damping = _draw.One(2) ? _draw.Power(-3, 5) : 0,
            ForceLimit = _draw.One(2) ? double.PositiveInfinity : _draw.Power(-1, 3),
        };
}
