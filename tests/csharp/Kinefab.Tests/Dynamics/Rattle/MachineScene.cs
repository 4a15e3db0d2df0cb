using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Numerics;
using Kinefab.Validation;
using Joint = Kinefab.Document.Joint;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>
/// Machines as users bring them, as scene documents: open chains, trees, plane and spatial loops, hung up, on a body that is led, or floating; from
/// centimetres to metres, of hinges and configurable joints with limits, springs, motors and gears that a step can follow. While they run they are
/// driven, struck and turned over.
/// </summary>
internal sealed class MachineScene
{
    private static readonly double[] StepLengths = { 1.0 / 50, 1.0 / 60, 1.0 / 100, 1.0 / 200 };

    private readonly Draw _draw;
    private readonly List<GameObject> _objects = new();
    private readonly List<Box> _boxes = new();
    private readonly List<(int Body, int Component)> _joints = new();
    private readonly List<Coupling> _couplings = new();
    private readonly bool _isPlane;
    private readonly Quaterniond _plane;
    private readonly double _density;
    private readonly int _led = -1;

    public MachineScene(int seed)
    {
        _draw = new Draw(seed);
        Size = _draw.Power(-1.5, 0.5);
        Step = StepLengths[_draw.Below(StepLengths.Length)];
        _density = _draw.Power(2, 4);
        _isPlane = _draw.One(2);
        _plane = _draw.Turn();
        bool isFloating = _draw.One(6);
        bool isLed = !isFloating && _draw.One(8);
        int bodies = _draw.From(isFloating ? 2 : 1, 7);
        if (isLed)
        {
            _led = 0;
            AddBox(_draw.Vector(Size), true);
            IsPassive = false;
        }

        int first = _objects.Count;
        for (int i = 0; i < bodies; i++)
        {
            int parent = i == 0 ? (isLed ? 0 : -1) : first + (_draw.One(4) ? _draw.Below(i) : i - 1);
            Vector3d point = parent < 0 ? _draw.Vector(Size) : _boxes[parent].Point(_draw.Vector(1));
            int body = AddBox(point, false);
            if (i > 0 || !isFloating)
            {
                AddJoint(body, parent, point, false);
            }
        }

        if (bodies > 2 && _draw.One(2))
        {
            int last = _objects.Count - 1;
            AddJoint(last, isFloating ? first : isLed ? 0 : -1, _boxes[last].Point(_draw.Vector(1)), true);
        }

        AddGear();
        Plan();
    }

    /// <summary>Metres, of its largest parts.</summary>
    public double Size { get; }

    /// <summary>Seconds.</summary>
    public double Step { get; }

    /// <summary>Whether no energy comes in but from gravity and from springs whose potential <see cref="SpringEnergy"/> knows, until something is done to it.</summary>
    public bool IsPassive { get; private set; } = true;

    /// <summary>What is done while it runs, and when, s.</summary>
    public List<(double Time, Action<World> Do)> Acts { get; } = new();

    public World Build()
    {
        var document = new SceneDocument { GameObjects = _objects, Couplings = _couplings };
        ValidScene scene = SceneValidator.Validate(document).Scene ?? throw new InvalidOperationException(SceneValidator.Validate(document).Report.ToString());
        return World.Create(scene, SolverKind.Exact);
    }

    /// <summary>Before a step that ends at a time: leads the body that is led, and does what is due.</summary>
    public void Before(World world, double time, double dt)
    {
        if (_led >= 0)
        {
            double way = 0.2 * (1 - Math.Cos(4 * time));
            Box box = _boxes[_led];
            world.Bodies[_led].KinematicTarget = new Pose(box.Pose.Position + new Vector3d(way * Size, 0, 0), (Quaterniond.AxisAngle(Vector3d.UnitZ, way) * box.Pose.Rotation).Normalized());
        }

        foreach ((double due, Action<World> act) in Acts)
        {
            if (due > time - 1.5 * dt && due <= time - 0.5 * dt)
            {
                act(world);
            }
        }
    }

    /// <summary>Energy in springs and soft limits along single coordinates, J.</summary>
    public static double SpringEnergy(World world)
    {
        double sum = 0;
        foreach (WorldJoint joint in world.Joints)
        {
            if (joint is WorldHingeJoint { Settings: var hinge })
            {
                double angle = joint.Coordinate(Coordinate.Angle);
                sum += hinge.UseSpring ? Half(hinge.Spring.Spring, (angle - hinge.Spring.TargetPosition) * Math.PI / 180) : 0;
            }
            else if (joint is WorldConfigurableJoint { Settings: var six })
            {
                sum += Half(six.XDrive.PositionSpring, joint.Coordinate(Coordinate.X)) + Half(six.YDrive.PositionSpring, joint.Coordinate(Coordinate.Y));
                double way = six.XMotion == ConfigurableJointMotion.Limited ? Math.Abs(joint.Coordinate(Coordinate.X)) - six.LinearLimit.Limit : 0;
                sum += Half(six.LinearLimitSpring.Spring, Math.Max(0, way));
            }
        }

        return sum;

        static double Half(double stiffness, double way) => stiffness * way * way / 2;
    }

    // A box somewhere about a point; of itself a point of its middle, an edge or outside of it.
    private int AddBox(Vector3d point, bool isKinematic)
    {
        Quaterniond turn = _isPlane ? (_plane * Quaterniond.AxisAngle(Vector3d.UnitZ, _draw.Between(-3, 3))).Normalized() : _draw.Turn();
        var half = new Vector3d(Size * _draw.Between(0.3, 1), Size * _draw.Between(0.05, 0.5), Size * _draw.Between(0.05, 0.5));
        Vector3d hung = Vector3d.Scale(_draw.Vector(1), half);
        hung = _isPlane ? new Vector3d(hung.X, hung.Y, 0) : hung;
        double mass = 8 * half.X * half.Y * half.Z * _density * (_draw.One(8) ? 30 : 1);
        Vector3d square = Vector3d.Scale(half, half) * (mass / 3);
        var pose = new Pose(point - turn * hung, turn);
        _boxes.Add(new Box(pose, half));
        _objects.Add(new GameObject
        {
            Id = $"B{_objects.Count}",
            Name = $"B{_objects.Count}",
            Transform = new Transform { LocalPosition = pose.Position, LocalRotation = pose.Rotation },
            Components = new Component[]
            {
                new Rigidbody
                {
                    Mass = mass,
                    InertiaTensor = new Vector3d(square.Y + square.Z, square.X + square.Z, square.X + square.Y),
                    CenterOfMass = _draw.One(4) ? half * 0.3 : Vector3d.Zero,
                    IsKinematic = isKinematic,
                    AngularDamping = _draw.One(3) ? 0.05 : 0,
                    LinearDamping = _draw.One(6) ? 0.1 : 0,
                    MaxAngularVelocity = 1000,
                },
            },
        });
        return _objects.Count - 1;
    }

    private void AddJoint(int body, int connected, Vector3d point, bool closes)
    {
        Box box = _boxes[body];
        Vector3d axis = box.Pose.Rotation.InverseRotate(_isPlane ? _plane * Vector3d.UnitZ : _draw.Vector(1).Normalized());
        Vector3d anchor = box.Pose.InversePoint(point);
        double mass = ((Rigidbody)_objects[body].Components[0]).Mass;
        var gains = new Gains(_draw.Between(2, 40), _draw.One(2) ? _draw.Between(0, 0.7) : 0, mass, Size);
        Joint joint = _isPlane ? PlaneJoint(gains, closes) : closes ? Ball(gains, true) : _draw.Below(4) switch
        {
            0 => Hinge(gains),
            1 => Ball(gains, false),
            2 => Slide(gains, false),
            _ => _draw.One(2) ? Universal() : Cylinder(gains),
        };
        joint = joint switch
        {
            HingeJoint hinge => hinge with { Anchor = anchor, Axis = axis, ConnectedBody = connected < 0 ? null : connected },
            ConfigurableJoint six => six with
            {
                Anchor = anchor,

                // In a plane slides go along it and turn about its normal, which is their Z.
                Axis = _isPlane ? Vector3d.Perpendicular(axis) : axis,
                SecondaryAxis = _isPlane ? Vector3d.Cross(axis, Vector3d.Perpendicular(axis)) : Vector3d.Perpendicular(axis),
                ConnectedBody = connected < 0 ? null : connected,
            },
            _ => throw new InvalidOperationException(),
        };
        var components = new List<Component>(_objects[body].Components) { joint };
        _objects[body] = _objects[body] with { Components = components };
        _joints.Add((body, components.Count - 1));
    }

    private Joint PlaneJoint(in Gains gains, bool closes) => closes || !_draw.One(4) ? Hinge(gains) : Slide(gains, _draw.One(2));

    private HingeJoint Hinge(in Gains gains)
    {
        bool hasMotor = _draw.One(8);
        IsPassive &= !hasMotor;
        return new HingeJoint
        {
            UseLimits = _draw.One(2),
            Limits = new JointLimits { Min = -_draw.Between(2, 100), Max = _draw.Between(2, 120), Bounciness = _draw.One(2) ? _draw.Between(0, 0.9) : 0 },
            UseMotor = hasMotor,
            Motor = new JointMotor { TargetVelocity = _draw.Between(-200, 200), Force = gains.Torque * _draw.Between(0.5, 10), FreeSpin = _draw.One(4) },
            UseSpring = !hasMotor && _draw.One(3),
            Spring = new JointSpring { Spring = gains.AngularSpring, Damper = gains.AngularDamper, TargetPosition = _draw.Between(-40, 40) },
        };
    }

    // Along X; in a plane it may turn as well.
    private ConfigurableJoint Slide(in Gains gains, bool turns)
    {
        ConfigurableJoint locked = Locked();
        return locked with
        {
            XMotion = _draw.One(2) ? ConfigurableJointMotion.Limited : ConfigurableJointMotion.Free,
            AngularZMotion = turns ? ConfigurableJointMotion.Free : ConfigurableJointMotion.Locked,
            LinearLimit = new SoftJointLimit { Limit = Size * _draw.Between(0.1, 1), Bounciness = _draw.One(2) ? _draw.Between(0, 0.9) : 0 },
            LinearLimitSpring = _draw.One(3) ? new SoftJointLimitSpring { Spring = gains.Spring, Damper = gains.Damper } : SoftJointLimitSpring.Default,
            XDrive = _draw.One(3) ? new JointDrive { PositionSpring = gains.Spring, PositionDamper = gains.Damper } : JointDrive.Default,
        };
    }

    private ConfigurableJoint Ball(in Gains gains, bool closes)
    {
        bool isCone = !closes && _draw.One(2);
        bool isSprung = !closes && _draw.One(4);
        IsPassive &= !isSprung;
        ConfigurableJointMotion swing = isCone ? ConfigurableJointMotion.Limited : ConfigurableJointMotion.Free;
        return Locked() with
        {
            AngularXMotion = _draw.One(2) ? ConfigurableJointMotion.Limited : ConfigurableJointMotion.Free,
            AngularYMotion = swing,
            AngularZMotion = swing,
            LowAngularXLimit = new SoftJointLimit { Limit = -_draw.Between(10, 120), Bounciness = _draw.One(2) ? _draw.Between(0, 0.9) : 0 },
            HighAngularXLimit = new SoftJointLimit { Limit = _draw.Between(10, 120) },
            AngularYLimit = new SoftJointLimit { Limit = _draw.Between(10, 100), Bounciness = _draw.One(2) ? _draw.Between(0, 0.9) : 0 },
            AngularZLimit = new SoftJointLimit { Limit = _draw.Between(10, 100) },
            RotationDriveMode = RotationDriveMode.Slerp,
            SlerpDrive = isSprung ? new JointDrive { PositionSpring = gains.AngularSpring, PositionDamper = gains.AngularDamper } : JointDrive.Default,
        };
    }

    private ConfigurableJoint Universal() => Locked() with
    {
        AngularYMotion = _draw.One(2) ? ConfigurableJointMotion.Limited : ConfigurableJointMotion.Free,
        AngularZMotion = _draw.One(2) ? ConfigurableJointMotion.Limited : ConfigurableJointMotion.Free,
        AngularYLimit = new SoftJointLimit { Limit = _draw.Between(5, 80) },
        AngularZLimit = new SoftJointLimit { Limit = _draw.Between(5, 80), Bounciness = _draw.One(2) ? _draw.Between(0, 0.9) : 0 },
    };

    private ConfigurableJoint Cylinder(in Gains gains) => Slide(gains, false) with
    {
        AngularXMotion = _draw.One(2) ? ConfigurableJointMotion.Limited : ConfigurableJointMotion.Free,
        LowAngularXLimit = new SoftJointLimit { Limit = -_draw.Between(5, 170) },
        HighAngularXLimit = new SoftJointLimit { Limit = _draw.Between(5, 170) },
    };

    private static ConfigurableJoint Locked() => new()
    {
        XMotion = ConfigurableJointMotion.Locked,
        YMotion = ConfigurableJointMotion.Locked,
        ZMotion = ConfigurableJointMotion.Locked,
        AngularXMotion = ConfigurableJointMotion.Locked,
        AngularYMotion = ConfigurableJointMotion.Locked,
        AngularZMotion = ConfigurableJointMotion.Locked,
    };

    private void AddGear()
    {
        List<(int Body, int Component)> hinges = _joints.FindAll(at => _objects[at.Body].Components[at.Component] is HingeJoint);
        if (hinges.Count > 1 && _draw.One(4))
        {
            _couplings.Add(new Coupling { Kind = CouplingKind.Gear, A = At(hinges[0]), B = At(hinges[^1]), Ratio = _draw.Between(-3, 3) });
        }

        static JointCoordinate At((int Body, int Component) at) => new() { GameObject = at.Body, Component = at.Component, Coordinate = Coordinate.Angle };
    }

    private void Plan()
    {
        for (int i = _draw.Below(3); i > 0; i--)
        {
            // Between steps, so that steps of any length have it before the same one.
            double time = Step * (_draw.From(2, 60) + 1e-3);
            int body = _draw.Below(_objects.Count);
            int joint = _joints.Count > 0 ? _draw.Below(_joints.Count) : -1;
            double number = _draw.Between(-1, 1);
            Vector3d push = _draw.Vector(1);
            switch (_draw.Below(4))
            {
                case 0 when joint >= 0:
                    Acts.Add((time, world => Drive(world.Joints[joint], number, true)));
                    break;
                case 1 when joint >= 0:
                    Acts.Add((time, world => Drive(world.Joints[joint], number, false)));
                    break;
                case 2:
                    Acts.Add((time, world => world.Gravity = push * 15));
                    break;
                default:
                    Acts.Add((time, world => world.Bodies[body].AngularVelocity += push * (world.Bodies[body].IsKinematic ? 0 : 5)));
                    break;
            }
        }
    }

    private void Drive(WorldJoint joint, double number, bool isTo)
    {
        if (joint.FreeCoordinates.Count == 0)
        {
            return;
        }

        Coordinate coordinate = joint.FreeCoordinates[0];
        bool isAngle = coordinate is not (Coordinate.X or Coordinate.Y or Coordinate.Z);
        double scale = isAngle ? 60 : Size / 2;
        if (isTo)
        {
            joint.DriveTo(coordinate, number * scale);
        }
        else
        {
            joint.DriveAt(coordinate, number * scale);
        }
    }

    /// <summary>Half edges, along the axes of its pose.</summary>
    private readonly record struct Box(Pose Pose, Vector3d Half)
    {
        public Vector3d Point(Vector3d shares) => Pose.Point(Vector3d.Scale(shares, Half));
    }

    /// <summary>Of springs that swing a body of a mass and size at a rate, rad/s, with a share of critical damping.</summary>
    private readonly record struct Gains(double Rate, double Ratio, double Mass, double Size)
    {
        public double Spring => Mass * Rate * Rate;

        public double Damper => 2 * Ratio * Rate * Mass;

        public double AngularSpring => 0.2 * Size * Size * Spring;

        public double AngularDamper => 0.2 * Size * Size * Damper;

        public double Torque => 9.81 * Mass * Size;
    }
}
