using System;
using System.Collections.Generic;
using Kinefab.Dynamics;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Puts mechanisms together in world coordinates: bodies where they stand, joints at world points.</summary>
internal sealed class MechanismBuilder
{
    private readonly List<BodyDefinition> _bodies = new();
    private readonly List<JointModel> _joints = new();
    private readonly List<CoordinateCoupling> _couplings = new();

    public Vector3d Gravity { get; set; } = new(0, -9.81, 0);

    /// <summary>A body of given mass and principal moments.</summary>
    public int Body(Vector3d position, Quaterniond rotation, double mass, Vector3d inertia)
    {
        BodyDefinition d = BodyDefinition.Default;
        d.Pose = new Pose(position, rotation);
        d.Mass = mass;
        d.Inertia = inertia;
        return Body(d);
    }

    public int Body(in BodyDefinition definition)
    {
        _bodies.Add(definition);
        return _bodies.Count - 1;
    }

    /// <summary>A uniform bar of square section between two points, its X along them.</summary>
    public int Bar(Vector3d from, Vector3d to, double mass, double section = 0.05)
    {
        Vector3d along = to - from;
        double length = along.Length;
        Vector3d x = along * (1 / length);
        Vector3d y = Vector3d.Perpendicular(x);
        double axial = mass * section * section / 6;
        double across = mass * (length * length + section * section) / 12;
        return Body((from + to) * 0.5, Quaterniond.FromAxes(x, y, Vector3d.Cross(x, y)), mass, new Vector3d(axial, across, across));
    }

    /// <summary>A body's definition, to be changed before Build.</summary>
    public void Change(int body, Func<BodyDefinition, BodyDefinition> change) => _bodies[body] = change(_bodies[body]);

    /// <summary>Adds a joint whose frame 0 and frame 1 coincide with a world frame now.</summary>
    public T Add<T>(T joint, int body0, int body1, Vector3d point, Vector3d axis)
        where T : JointModel
    {
        Vector3d x = axis.Normalized();
        Vector3d y = Vector3d.Perpendicular(x);
        return Add(joint, body0, body1, new Pose(point, Quaterniond.FromAxes(x, y, Vector3d.Cross(x, y))));
    }

    public T Add<T>(T joint, int body0, int body1, Pose frame)
        where T : JointModel
    {
        joint.Body0 = body0;
        joint.Body1 = body1;
        joint.Frame0 = Local(body0, frame);
        joint.Frame1 = Local(body1, frame);
        _joints.Add(joint);
        return joint;
    }

    public RevoluteJoint Hinge(int body0, int body1, Vector3d point, Vector3d axis) => Add(new RevoluteJoint(), body0, body1, point, axis);

    /// <summary>A turn about X of a joint's frames follows those of others, each by its ratio.</summary>
    public void Couple(JointModel driven, params (JointModel Joint, double Ratio)[] terms) =>
        _couplings.Add(new CoordinateCoupling(Turn(driven), Array.ConvertAll(terms, term => (Turn(term.Joint), term.Ratio)), 0));

    private static CoordinateAxisMap Turn(JointModel joint) => new(joint, CoordinateAxis.AngularX, 1);

    public MultibodySystem Build() => new(new Bodies(_bodies.ToArray()), _joints.ToArray(), _couplings.ToArray()) { Gravity = Gravity };

    private Pose Local(int body, Pose frame) => body < 0 ? frame : _bodies[body].Pose.Inverse() * frame;
}
