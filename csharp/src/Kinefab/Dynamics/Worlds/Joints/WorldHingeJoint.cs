using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Mechanisms;
using Kinefab.Numerics;

namespace Kinefab.Dynamics;

/// <summary>A HingeJoint in a <see cref="World"/>.</summary>
public sealed class WorldHingeJoint : WorldJoint
{
    private HingeJoint _settings;
    private double _unwrapped;
    private double _speed;

    // Of DriveTo, radians; NaN without.
    private double _goal = double.NaN;

    internal WorldHingeJoint(MultibodySystem mechanism, int index, JointPlace place, HingeJoint settings)
        : base(mechanism, index, place)
    {
        _settings = settings;
        _speed = Velocity / Degrees;
    }

    /// <summary>Limits, motor, spring, break limits and mass scales. A new value acts from the next step on; the frames stay as created.</summary>
    /// <exception cref="ArgumentException">A number is out of its range or none; the message names the field.</exception>
    /// <example><code>
    /// hinge.Settings = hinge.Settings with { UseLimits = false };   // all other fields stay
    /// </code></example>
    public HingeJoint Settings
    {
        get => _settings;
        set
        {
            if (value is null)
            {
                throw new ArgumentNullException(nameof(value));
            }

            SettingsCheck.ThrowIfWrong(value);
            _settings = value;
            Given?.Invoke(this, value);
            _goal = double.NaN;
            UnityJoints.Apply(value, (RevoluteJoint)Solved);
        }
    }

    /// <inheritdoc/>
    public override IReadOnlyList<Coordinate> FreeCoordinates { get; } = new[] { Document.Coordinate.Angle };

    /// <summary>HingeJoint.angle: own body against the connected one about the axis, left-hand sense, 0 at start-up; degrees in (-180, 180].</summary>
    public double Angle => Wrapped() * Degrees;

    /// <summary>The same with its whole turns since start-up, degrees.</summary>
    public double UnwrappedAngle => SwingTwist.Nearest(Wrapped(), _unwrapped) * Degrees;

    /// <summary>HingeJoint.velocity with the sign of the angle's growth, degrees/s.</summary>
    public double Velocity
    {
        get
        {
            Vector3d axis = (Pose0 * Solved.Frame0).Rotation * Vector3d.UnitX;
            return Vector3d.Dot(MultibodySystem.Bodies.AngularVelocityOf(Solved.Body0) - MultibodySystem.Bodies.AngularVelocityOf(Solved.Body1), axis) * Degrees;
        }
    }

    /// <inheritdoc/>
    public override double Coordinate(Coordinate coordinate)
    {
        Check(coordinate);
        return UnwrappedAngle;
    }

    /// <inheritdoc/>
    public override void DriveTo(Coordinate coordinate, double target)
    {
        Check(coordinate);
        Finite.OrThrow(target, nameof(target));
        var joint = (RevoluteJoint)Solved;
        joint.MotorEnabled = false;
        joint.Spring = PositionDrive(joint.Spring);
        joint.SpringTarget = -target / Degrees;
        _goal = target / Degrees;
    }

    /// <inheritdoc/>
    public override void DriveAt(Coordinate coordinate, double speed)
    {
        Check(coordinate);
        Finite.OrThrow(speed, nameof(speed));
        var joint = (RevoluteJoint)Solved;
        joint.MotorEnabled = true;
        _goal = double.NaN;
        joint.MotorVelocity = -speed / Degrees;
        joint.MotorForceLimit = ForceLimit(_settings.Motor.Force);
    }

    internal override void NoteSpeeds() => _speed = Velocity / Degrees;

    // The spring counts from where the joint's own angle stands, which may have wrapped.
    internal override void BeforeStep()
    {
        if (!double.IsNaN(_goal))
        {
            var joint = (RevoluteJoint)Solved;
            double turns = Math.Round((_unwrapped + joint.Angle(Pose0, Pose1)) / (2 * Math.PI));
            joint.SpringTarget = 2 * Math.PI * turns - _goal;
        }
    }

    internal override void AfterStep(double dt, double endShare)
    {
        double speed = Velocity / Degrees;
        double angle = Wrapped();
        double near = Solved.HasCounted(-angle) ? -Solved.LastTwist : _unwrapped + dt * ((1 - endShare) * _speed + endShare * speed);
        _unwrapped = SwingTwist.Nearest(angle, near);
        _speed = speed;
        Solved.RestartTwist(-_unwrapped);
    }

    internal override void Exchange(StateTape tape)
    {
        tape.Value(ref _settings);
        tape.Value(ref _unwrapped);
        tape.Value(ref _speed);
        tape.Value(ref _goal);
    }

    private static void Check(Coordinate coordinate)
    {
        if (coordinate != Document.Coordinate.Angle)
        {
            throw new ArgumentException("A HingeJoint has the coordinate angle alone.", nameof(coordinate));
        }
    }

    // phi = -twist of c; minus pi becomes plus pi.
    private double Wrapped()
    {
        double angle = -((RevoluteJoint)Solved).Angle(Pose0, Pose1);
        return angle - 2 * Math.PI * Math.Ceiling((angle - Math.PI) / (2 * Math.PI));
    }
}
