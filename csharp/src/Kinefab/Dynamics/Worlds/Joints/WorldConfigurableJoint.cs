using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Joints;
using Kinefab.Mechanisms;
using Kinefab.Numerics;

namespace Kinefab.Dynamics;

/// <summary>A ConfigurableJoint in a <see cref="World"/>.</summary>
public sealed class WorldConfigurableJoint : WorldJoint
{
    private const int Axes = 6;
    private const int FirstAngle = (int)CoordinateAxis.AngularX;

    // How far ahead of the joint a goal is put, radians: the rows pull by the sine of the whole or the half of it.
    private const double MostAheadOfSwing = Math.PI / 2;
    private const double MostAheadOfTwist = 3;

    private readonly double[] _start = new double[Axes];
    private readonly double[] _unwrapped = new double[Axes];
    private readonly double _sign;

    // Of the angles about X, Y and Z, as the joint's rows count them, radians.
    private readonly double[] _goals;

    // Of the angles too, but with their whole turns; NaN where DriveTo set none.
    private readonly double[] _turningGoals = { double.NaN, double.NaN, double.NaN };

    // Whether a program drives the angle about Y, and about Z.
    private readonly bool[] _isSwingDriven = new bool[2];
    private readonly double[] _speeds = new double[Axes];
    private ConfigurableJoint _settings;

    internal WorldConfigurableJoint(MultibodySystem mechanism, int index, JointPlace place, ConfigurableJoint settings)
        : base(mechanism, index, place)
    {
        _settings = settings;
        _sign = UnityJoints.CoordinateSign(settings);
        FreeCoordinates = new[] { settings.XMotion, settings.YMotion, settings.ZMotion, settings.AngularXMotion, settings.AngularYMotion, settings.AngularZMotion }
            .Select((motion, axis) => (motion, Coordinate: Document.Coordinate.X + axis))
            .Where(one => one.motion != ConfigurableJointMotion.Locked)
            .Select(one => one.Coordinate)
            .ToArray();
        _goals = ConfigurableDrives.Goals((D6Joint)Solved);
        for (int i = 0; i < Axes; i++)
        {
            _start[i] = Evaluate(i, 0, out _speeds[i]);
            _unwrapped[i] = _start[i];
        }
    }

    /// <summary>
    /// Motions, limits, drives, targets, break limits and mass scales. A new value acts from the next step on; the frames and swapBodies stay
    /// as created.
    /// </summary>
    /// <exception cref="ArgumentException">swapBodies differs; or a number is out of its range or none.</exception>
    public ConfigurableJoint Settings
    {
        get => _settings;
        set
        {
            if (value is null)
            {
                throw new ArgumentNullException(nameof(value));
            }

            if (value.SwapBodies != _settings.SwapBodies)
            {
                throw new ArgumentException("swapBodies is decided when the joint is created.", nameof(value));
            }

            SettingsCheck.ThrowIfWrong(value);
            _settings = value;
            Given?.Invoke(this, value);
            UnityJoints.Apply(value, (D6Joint)Solved);
            ConfigurableDrives.Goals((D6Joint)Solved).CopyTo(_goals, 0);
            Array.Fill(_turningGoals, double.NaN);
            Array.Clear(_isSwingDriven, 0, _isSwingDriven.Length);
        }
    }

    /// <inheritdoc/>
    public override IReadOnlyList<Coordinate> FreeCoordinates { get; }

    /// <inheritdoc/>
    public override double Coordinate(Coordinate coordinate)
    {
        int i = Axis(coordinate);
        double value = Raw(i, _unwrapped[i]) - _start[i];
        return IsAngle(i) ? value * Degrees : value;
    }

    /// <inheritdoc/>
    public override void DriveTo(Coordinate coordinate, double target)
    {
        int i = Axis(coordinate);
        Finite.OrThrow(target, nameof(target));
        var joint = (D6Joint)Solved;
        TellOfSlerp(joint, i, isSpeed: false);
        SetDrive(joint, i, PositionDrive(OwnDrive(i)));
        ConfigurableDrives.SetSpeed(joint, i, 0);
        double goal = _sign * ((IsAngle(i) ? target / Degrees : target) + _start[i]);
        if (IsAngle(i))
        {
            _turningGoals[i - FirstAngle] = goal;
            _goals[i - FirstAngle] = goal;
            ConfigurableDrives.SetAngles(joint, _goals);
        }
        else
        {
            ConfigurableDrives.SetPosition(joint, i, goal);
        }
    }

    /// <inheritdoc/>
    public override void DriveAt(Coordinate coordinate, double speed)
    {
        // In the solver that mirrors Unity a damper, this stiff: it holds the speed to one part in a million within a step of 1 ms.
        const double damping = 1e9;
        int i = Axis(coordinate);
        Finite.OrThrow(speed, nameof(speed));
        var joint = (D6Joint)Solved;
        TellOfSlerp(joint, i, isSpeed: true);
        if (IsAngle(i))
        {
            _turningGoals[i - FirstAngle] = double.NaN;
        }

        SetDrive(joint, i, new Kinefab.Joints.DriveModel { Damping = damping, ForceLimit = ForceLimit(OwnDrive(i).ForceLimit), IsAcceleration = true, Prescribes = Kinefab.Joints.Prescribed.Speed });
        ConfigurableDrives.SetSpeed(joint, i, _sign * (IsAngle(i) ? speed / Degrees : speed));
    }

    /// <summary>Counts the turns anew from the pose as it is: about X nearest to an angle, about Y and Z within half a turn of zero.</summary>
    /// <param name="twist">Radians, in the sense of the coordinate.</param>
    internal void Restart(double twist)
    {
        for (int i = FirstAngle; i < Axes; i++)
        {
            _unwrapped[i] = Evaluate(i, i == FirstAngle ? twist : 0, out _speeds[i]);
        }

        Solved.RestartTwist(_sign * _unwrapped[FirstAngle]);
    }

    /// <summary>Puts frame 0 so far on along its X; the coordinate stays what it is.</summary>
    internal void MoveFrame(double way)
    {
        Solved.Frame0 *= new Pose(new Vector3d(way, 0, 0), Quaterniond.Identity);
        _start[0] -= _sign * way;
        foreach (Kinefab.Joints.CoordinateCoupling coupling in MultibodySystem.Couplings)
        {
            coupling.Recount(Solved, Kinefab.Joints.CoordinateAxis.X, way);
        }
    }

    internal override void NoteSpeeds()
    {
        for (int i = FirstAngle; i < Axes; i++)
        {
            Evaluate(i, _unwrapped[i], out _speeds[i]);
        }
    }

    // A drive's row knows the goal as a rotation, which it reaches by the shorter way: a goal farther off is led there.
    internal override void BeforeStep()
    {
        bool isLed = false;
        bool goesAlong = GoesAlong((D6Joint)Solved);
        for (int i = 0; i < _goals.Length; i++)
        {
            double at = _sign * _unwrapped[FirstAngle + i];
            double goal;
            if (!double.IsNaN(_turningGoals[i]))
            {
                double ahead = _turningGoals[i] - at;
                double most = i == 0 ? MostAheadOfTwist : MostAheadOfSwing;
                goal = Math.Abs(ahead) > most ? at + Math.Sign(ahead) * most : _turningGoals[i];
            }
            else if (goesAlong && ConfigurableDrives.Of((D6Joint)Solved, FirstAngle + i).Stiffness == 0)
            {
                goal = at;
            }
            else
            {
                continue;
            }

            isLed |= goal != _goals[i];
            _goals[i] = goal;
        }

        if (isLed)
        {
            ConfigurableDrives.SetAngles((D6Joint)Solved, _goals);
        }
    }

    internal override void AfterStep(double dt, double endShare)
    {
        for (int i = FirstAngle; i < Axes; i++)
        {
            double reached = Evaluate(i, _unwrapped[i], out double speed);
            bool isCounted = i == FirstAngle && Solved.HasCounted(_sign * reached);
            double near = isCounted ? _sign * Solved.LastTwist : IsWithinHalfATurn((D6Joint)Solved, i - FirstAngle) ? 0 : _unwrapped[i] + dt * ((1 - endShare) * _speeds[i] + endShare * speed);
            _unwrapped[i] = SwingTwist.Nearest(reached, near);
            _speeds[i] = speed;
        }

        Solved.RestartTwist(_sign * _unwrapped[FirstAngle]);
    }

    internal override void Exchange(StateTape tape)
    {
        tape.Value(ref _settings);
        tape.Array(_start);
        tape.Array(_unwrapped);
        tape.Array(_goals);
        tape.Array(_turningGoals);
        tape.Array(_isSwingDriven);
        tape.Array(_speeds);
    }

    // A swing between hard limits, into which no other turn mixes: however fast it is thrown about between them, it is never beyond half a turn.
    private static bool IsWithinHalfATurn(D6Joint joint, int angle)
    {
        (AxisMotion own, AxisMotion other) = angle == 1 ? (joint.Swing1, joint.Swing2) : (joint.Swing2, joint.Swing1);
        return angle > 0 && own == AxisMotion.Limited && (other == AxisMotion.Locked || joint.Twist == AxisMotion.Locked)
            && !joint.SwingLimit.Response.IsSoft && !joint.IsBroken;
    }

    // In Unity the two swings have one drive: it holds the one that a program does not drive by itself.
    private void SetDrive(D6Joint joint, int axis, in Kinefab.Joints.DriveModel drive)
    {
        ConfigurableDrives.Of(joint, axis) = drive;
        int swing = axis - (int)CoordinateAxis.AngularY;
        if (swing < 0 || joint.Layout().IsSlerp)
        {
            return;
        }

        _isSwingDriven[swing] = true;
        if (!_isSwingDriven[1 - swing])
        {
            ConfigurableDrives.Of(joint, (int)CoordinateAxis.AngularY + 1 - swing) = drive;
        }
    }

    // The row of one swing counts the other and the twist too: where both swings are free, the goal's rotation goes along with what no spring holds.
    private bool GoesAlong(D6Joint joint) =>
        !(double.IsNaN(_turningGoals[1]) && double.IsNaN(_turningGoals[2])) && joint.Swing1 != AxisMotion.Locked && joint.Swing2 != AxisMotion.Locked;

    // A slerp drive has no axes: it is at speeds or to goals about all three.
    private void TellOfSlerp(D6Joint joint, int axis, bool isSpeed)
    {
        if (Tell is null || !IsAngle(axis) || !joint.Layout().IsSlerp)
        {
            return;
        }

        for (int other = FirstAngle; other < Axes; other++)
        {
            bool isGivenUp = isSpeed
                ? !double.IsNaN(_turningGoals[other - FirstAngle])
                : joint.DriveSlerp.Prescribes == Prescribed.Speed && joint.DriveAngularVelocity[other - FirstAngle] != 0;
            if (other != axis && isGivenUp)
            {
                Tell(Diagnostic.Of(
                    DiagnosticCodes.DriveShared,
                    Pointer,
                    ("coordinate", CoordinateWords.Table.WordOf(Document.Coordinate.X + axis)),
                    ("how", isSpeed ? "at a speed" : "to a goal"),
                    ("other", CoordinateWords.Table.WordOf(Document.Coordinate.X + other)),
                    ("lost", isSpeed ? "goal" : "speed")));
                return;
            }
        }
    }

    private static bool IsAngle(int axis) => axis >= (int)CoordinateAxis.AngularX;

    private static int Axis(Coordinate coordinate) => coordinate >= Document.Coordinate.X && coordinate <= Document.Coordinate.AngularZ
        ? coordinate - Document.Coordinate.X
        : throw new ArgumentException("A ConfigurableJoint has the coordinates x to angularZ.", nameof(coordinate));

    // The component's, whatever has driven the axis since.
    private Kinefab.Joints.DriveModel OwnDrive(int axis)
    {
        var own = (D6Joint)Solved.Between(Solved.Body0, Solved.Body1);
        UnityJoints.Apply(_settings, own);
        return ConfigurableDrives.Of(own, axis);
    }

    private double Raw(int axis, double near) => Evaluate(axis, near, out _);

    // An angle's rate in rad/s; 0 of a slide, whose way is never counted by turns.
    private double Evaluate(int axis, double near, out double speed)
    {
        double value = new Kinefab.Joints.CoordinateAxisMap(Solved, (CoordinateAxis)axis, _sign).Evaluate(Pose0, Pose1, near, out ConstraintRow row);
        Bodies bodies = MultibodySystem.Bodies;
        speed = IsAngle(axis) ? row.Velocity(Vector3d.Zero, bodies.AngularVelocityOf(Solved.Body0), Vector3d.Zero, bodies.AngularVelocityOf(Solved.Body1)) : 0;
        return value;
    }
}
