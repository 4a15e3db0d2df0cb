using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Document;
using Kinefab.Dynamics.Articulations;
using Kinefab.Joints;
using Kinefab.Mechanisms;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Dynamics;

/// <summary>The joint of an ArticulationBody to the link above it, in a <see cref="World"/>: x along, angularX to angularZ about the axes of its anchor.</summary>
public sealed class WorldLinkJoint : WorldJoint
{
    private readonly WorldConfigurableJoint _joint;
    private readonly ArticulatedBodies _articulated;
    private readonly int _body;
    private ArticulationBody _settings;

    internal WorldLinkJoint(MultibodySystem mechanism, int index, JointPlace place, in JointDefinition definition, ArticulatedBodies articulated)
        : base(mechanism, index, place)
    {
        _joint = new WorldConfigurableJoint(mechanism, index, place, (ConfigurableJoint)definition.Source);
        _articulated = articulated;
        _body = definition.Own;
        _settings = definition.Link!;
        SetTwistGoal();
    }

    /// <summary>
    /// Limits, drives, friction and maxJointVelocity. A new value acts from the next step on; anchors, joint type and which axes are locked stay
    /// as created, mass and dampings are the body's (<see cref="WorldBody.Settings"/>).
    /// </summary>
    /// <exception cref="ArgumentException">A field that is decided at creation differs, or a number is out of its range or none.</exception>
    public ArticulationBody Settings
    {
        get => _settings;
        set
        {
            if (value is null)
                throw new ArgumentNullException(nameof(value));
            if (value.JointType != _settings.JointType || value.AnchorPosition != _settings.AnchorPosition || value.AnchorRotation != _settings.AnchorRotation
                || value.ParentAnchorPosition != _settings.ParentAnchorPosition || value.ParentAnchorRotation != _settings.ParentAnchorRotation
                || Enumerable.Range(0, 3).Any(axis => (LinkJoint.TurnMotion(value, axis) == ConfigurableJointMotion.Locked) != (LinkJoint.TurnMotion(_settings, axis) == ConfigurableJointMotion.Locked)))
            {
                throw new ArgumentException("jointType, the anchors and which axes are locked are decided when the link is created.", nameof(value));
            }

            SettingsCheck.ThrowIfWrong(value);

            // A limited slide of a ConfigurableJoint goes as far to one side as to the other.
            _joint.MoveFrame(LinkJoint.Middle(value) - LinkJoint.Middle(_settings));
            _settings = value;
            _joint.Settings = LinkJoint.Of(value, _joint.Settings.ConnectedBody!.Value);
            ArticulationModel.Apply(value, Link);
            SetTwistGoal();
        }
    }

    /// <inheritdoc/>
    public override IReadOnlyList<Coordinate> FreeCoordinates => _joint.FreeCoordinates;

    private ArticulationTree Tree => _articulated.Solvers[_articulated.ArticulationOf[_body]].Tree;

    private int LinkIndex => _articulated.LinkOf[_body];

    private LinkDefinition Link => Tree.Links[LinkIndex];

    /// <inheritdoc/>
    public override double Coordinate(Coordinate coordinate) => _joint.Coordinate(coordinate);

    /// <summary>Rate of a coordinate, degrees/s or m/s.</summary>
    /// <param name="coordinate">A motion that the joint leaves free.</param>
    /// <returns>Degrees/s or m/s, left-handed sense.</returns>
    /// <exception cref="ArgumentException">The joint has no such coordinate.</exception>
    public double Speed(Coordinate coordinate)
    {
        int freedom = Freedom(coordinate);
        _articulated.Read(_articulated.ArticulationOf[_body]);
        return Tree.Speeds[freedom] * Unit;
    }

    /// <summary>Puts a coordinate at a value: the link and all below it move there, and keep the joints' speeds.</summary>
    /// <param name="coordinate">One that is free or limited.</param>
    /// <param name="value">Degrees or metres.</param>
    /// <exception cref="ArgumentException">The joint has no such coordinate, or the value is no finite number.</exception>
    public void SetPosition(Coordinate coordinate, double value)
    {
        int freedom = Freedom(coordinate);
        Finite.OrThrow(value, nameof(value));
        _articulated.Read(_articulated.ArticulationOf[_body]);
        Tree.Positions[freedom] = value / Unit;
        _articulated.Place(_articulated.ArticulationOf[_body]);
        _joint.Restart(_settings.JointType == ArticulationJointType.Revolute ? value / Unit : 0);
    }

    /// <summary>Gives a coordinate a rate.</summary>
    /// <param name="coordinate">One that is free or limited.</param>
    /// <param name="value">Degrees/s or m/s.</param>
    /// <exception cref="ArgumentException">The joint has no such coordinate, or the value is no finite number.</exception>
    public void SetSpeed(Coordinate coordinate, double value)
    {
        int freedom = Freedom(coordinate);
        Finite.OrThrow(value, nameof(value));
        _articulated.Read(_articulated.ArticulationOf[_body]);
        Tree.Speeds[freedom] = value / Unit;
        _articulated.Place(_articulated.ArticulationOf[_body]);
        MultibodySystem.HasChangedSpeeds = true;
    }

    /// <summary>A force along a coordinate over the next step, N or N m; its reaction acts on the link above.</summary>
    /// <param name="coordinate">A motion that the joint leaves free.</param>
    /// <param name="force">N along a slide, N m about an axis; in the sense of the coordinate.</param>
    /// <exception cref="ArgumentException">The joint has no such coordinate, or the force is no finite number.</exception>
    public void AddForce(Coordinate coordinate, double force)
    {
        int freedom = Freedom(coordinate);
        Finite.OrThrow(force, nameof(force));
        if (_articulated.HeldJoints[Index])
        {
            Tree.Forces[freedom] += force;
            return;
        }

        // As wrenches on both bodies.
        Bodies bodies = MultibodySystem.Bodies;
        Pose frame = bodies.Poses[_body] * Solved.Frame1;
        int axis = Tree.AxisOf[freedom];
        Vector3d along = frame.Rotation * (axis == 0 ? Vector3d.UnitX : axis == 1 ? Vector3d.UnitY : Vector3d.UnitZ) * force;
        int parent = Solved.Body0;
        if (_settings.JointType != ArticulationJointType.Prismatic)
        {
            bodies.Torques[_body] += along;
            bodies.Torques[parent] -= along;
            return;
        }

        bodies.Forces[_body] += along;
        bodies.Torques[_body] += Vector3d.Cross(frame.Position - bodies.Poses[_body].Position, along);
        bodies.Forces[parent] -= along;
        bodies.Torques[parent] -= Vector3d.Cross(frame.Position - bodies.Poses[parent].Position, along);
    }

    /// <inheritdoc/>
    public override void DriveTo(Coordinate coordinate, double target)
    {
        int freedom = Freedom(coordinate);
        _joint.DriveTo(coordinate, target);
        ref LinkAxis axis = ref Tree.AxisOfFreedom(LinkIndex, freedom);
        LinkAxis own = ArticulationModel.Axis(_settings, Tree.AxisOf[freedom]);
        DriveModel drive = PositionDrive(new DriveModel { Stiffness = own.Stiffness, Damping = own.Damping, ForceLimit = own.ForceLimit, IsAcceleration = own.IsAcceleration });
        (axis.Stiffness, axis.Damping, axis.ForceLimit, axis.IsAcceleration) = (drive.Stiffness, drive.Damping, drive.ForceLimit, drive.IsAcceleration);
        axis.Target = target / Unit;
        axis.TargetSpeed = 0;
        SetTwistGoal();
    }

    /// <inheritdoc/>
    public override void DriveAt(Coordinate coordinate, double speed)
    {
        const double damping = 1e9;
        int freedom = Freedom(coordinate);
        _joint.DriveAt(coordinate, speed);
        ref LinkAxis axis = ref Tree.AxisOfFreedom(LinkIndex, freedom);
        (axis.Stiffness, axis.Damping, axis.IsAcceleration) = (0, damping, true);
        axis.ForceLimit = ForceLimit(ArticulationModel.Axis(_settings, Tree.AxisOf[freedom]).ForceLimit);
        axis.TargetSpeed = speed / Unit;
    }

    internal override void NoteSpeeds() => _joint.NoteSpeeds();

    internal override void BeforeStep() => _joint.BeforeStep();

    internal override void AfterStep(double dt, double endShare) => _joint.AfterStep(dt, endShare);

    internal override void Exchange(StateTape tape)
    {
        tape.Value(ref _settings);
        _joint.Exchange(tape);
    }

    // Degrees a radian, or 1.
    private double Unit => _settings.JointType == ArticulationJointType.Prismatic ? 1 : Degrees;

    // Hinges are driven by their angle in either solver.
    private void SetTwistGoal()
    {
        if (_settings.JointType == ArticulationJointType.Revolute)
            ((D6Joint)Solved).DriveTwistAngle = Link.Axes[0].Target;
    }

    private int Freedom(Coordinate coordinate)
    {
        int axis = _settings.JointType == ArticulationJointType.Prismatic
            ? coordinate == Document.Coordinate.X ? 0 : -1
            : coordinate is >= Document.Coordinate.AngularX and <= Document.Coordinate.AngularZ ? coordinate - Document.Coordinate.AngularX : -1;
        ArticulationTree tree = Tree;
        for (int f = tree.FirstFreedom[LinkIndex]; f < tree.FirstFreedom[LinkIndex + 1]; f++)
        {
            if (tree.AxisOf[f] == axis)
                return f;
        }

        throw new ArgumentException($"The link has {(FreeCoordinates.Count == 0 ? "no coordinates" : "the coordinates " + string.Join(", ", FreeCoordinates))}.", nameof(coordinate));
    }
}
