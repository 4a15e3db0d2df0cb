using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Validation;
using Transform = Kinefab.Document.Transform;

namespace Kinefab.Tests.Kinematics;

/// <summary>Builds scenes for tests from places and axes given in the world; formulas are component by component Unity's.</summary>
internal sealed class MechanismScene
{
    private readonly List<(string Id, Pose Pose, bool IsKinematic, List<Component> Components)> _objects = [];
    private readonly List<Coupling> _couplings = [];

    public Analysis? Analysis { get; set; }

    /// <summary>A body whose own frame is turned and shifted, so that no axis lies along it by chance.</summary>
    public int Body(string id, Vector3d position, bool isKinematic = false)
    {
        double turn = 0.4 + 0.7 * _objects.Count;
        Quaterniond rotation = Quaterniond.AxisAngle(new Vector3d(0.3, -0.5, 0.8).Normalized(), turn);
        _objects.Add((id, new Pose(position + new Vector3d(0.05, -0.02, 0.03), rotation), isKinematic, [new Rigidbody { IsKinematic = isKinematic }]));
        return _objects.Count - 1;
    }

    public JointPlace Hinge(int own, int? connected, Vector3d point, Vector3d axis, double min = 0, double max = 0, bool closure = false)
    {
        return Add(own, new HingeJoint
        {
            ConnectedBody = connected,
            Anchor = Local(own, point),
            Axis = LocalDirection(own, axis),
            UseLimits = min != max,
            Limits = new JointLimits { Min = min, Max = max },
            Closure = closure,
        });
    }

    /// <summary>A ConfigurableJoint: six letters L, F or M (limited) for X, Y, Z, angular X, Y, Z.</summary>
    public JointPlace Configurable(
        int own, int? connected, Vector3d point, Vector3d axis, Vector3d secondary, string motions,
        double linearLimit = 0, double low = 0, double high = 0, double limitY = 0, double limitZ = 0, bool swap = false, bool closure = false, double shift = 0)
    {
        Vector3d connectedPoint = point + shift * axis.Normalized();
        return Add(own, new ConfigurableJoint
        {
            ConnectedBody = connected,
            Anchor = Local(own, point),
            Axis = LocalDirection(own, axis),
            SecondaryAxis = LocalDirection(own, secondary),
            AutoConfigureConnectedAnchor = shift == 0,
            ConnectedAnchor = shift == 0 ? default : connected is int c ? Local(c, connectedPoint) : connectedPoint,
            XMotion = Motion(motions[0]),
            YMotion = Motion(motions[1]),
            ZMotion = Motion(motions[2]),
            AngularXMotion = Motion(motions[3]),
            AngularYMotion = Motion(motions[4]),
            AngularZMotion = Motion(motions[5]),
            LinearLimit = new SoftJointLimit { Limit = linearLimit },
            LowAngularXLimit = new SoftJointLimit { Limit = low },
            HighAngularXLimit = new SoftJointLimit { Limit = high },
            AngularYLimit = new SoftJointLimit { Limit = limitY },
            AngularZLimit = new SoftJointLimit { Limit = limitZ },
            SwapBodies = swap,
            Closure = closure,
        });
    }

    public JointPlace Slide(int own, int? connected, Vector3d point, Vector3d axis) =>
        Configurable(own, connected, point, axis, Vector3d.Perpendicular(axis.Normalized()), "FLLLLL");

    public JointPlace Ball(int own, int? connected, Vector3d point) =>
        Configurable(own, connected, point, Vector3d.UnitX, Vector3d.UnitY, "LLLFFF");

    public JointPlace Fixed(int own, int? connected) => Add(own, new FixedJoint { ConnectedBody = connected });

    public void Couple(JointPlace a, Coordinate coordinateA, JointPlace b, Coordinate coordinateB, double ratio, double offset = 0) =>
        _couplings.Add(new Coupling { A = At(a, coordinateA), B = At(b, coordinateB), Ratio = ratio, Offset = offset });

    public void Couple(JointPlace driven, Coordinate coordinate, double offset, params (JointPlace Joint, Coordinate Coordinate, double Ratio)[] terms) =>
        _couplings.Add(new Coupling
        {
            B = At(driven, coordinate),
            Terms = Array.ConvertAll(terms, term => new CouplingTerm { Coordinate = At(term.Joint, term.Coordinate), Ratio = term.Ratio }),
            Offset = offset,
        });

    private static JointCoordinate At(JointPlace joint, Coordinate coordinate) =>
        new() { GameObject = joint.GameObject, Component = joint.Component, Coordinate = coordinate };

    public SceneDocument Document()
    {
        var objects = new List<GameObject>();
        foreach ((string id, Pose pose, _, List<Component> components) in _objects)
        {
            objects.Add(new GameObject
            {
                Id = id,
                Name = id,
                Transform = new Transform { LocalPosition = pose.Position, LocalRotation = pose.Rotation },
                Components = components.ToArray(),
            });
        }

        return new SceneDocument { GameObjects = objects, Couplings = _couplings.ToArray(), Analysis = Analysis };
    }

    public Mechanism Mechanism() => Kinefab.Kinematics.Mechanism.Create(new ValidScene(Document()));

    /// <summary>A point of the world at the exported pose in a body's frame.</summary>
    public Vector3d Local(int body, Vector3d point) => _objects[body].Pose.InversePoint(point);

    /// <summary>How far a body has turned from its exported pose.</summary>
    public Quaterniond Turn(MechanismState state, int body) => state.Pose(body).Rotation * _objects[body].Pose.Rotation.Conjugate();

    /// <summary>Angle of a body about world z against its exported pose, degrees in (-180, 180].</summary>
    public double TurnAboutZ(MechanismState state, int body)
    {
        Vector3d x = Turn(state, body) * Vector3d.UnitX;
        return Math.Atan2(x.Y, x.X) * (180 / Math.PI);
    }

    private JointPlace Add(int own, Component joint)
    {
        _objects[own].Components.Add(joint);
        return new JointPlace(own, _objects[own].Components.Count - 1);
    }

    private Vector3d LocalDirection(int body, Vector3d direction) => _objects[body].Pose.Rotation.InverseRotate(direction);

    private static ConfigurableJointMotion Motion(char letter) => letter switch
    {
        'L' => ConfigurableJointMotion.Locked,
        'M' => ConfigurableJointMotion.Limited,
        _ => ConfigurableJointMotion.Free,
    };
}

/// <summary>Where a joint component stands.</summary>
internal readonly record struct JointPlace(int GameObject, int Component)
{
    public int In(Mechanism mechanism, Coordinate coordinate) => mechanism.FindCoordinate(GameObject, Component, coordinate);

    public int Angle(Mechanism mechanism) => In(mechanism, Coordinate.Angle);
}
