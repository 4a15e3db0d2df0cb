using System;
using Kinefab.Document;
using Kinefab.Joints;

namespace Kinefab.Dynamics;

/// <summary>A ConfigurableJoint in a <see cref="World"/>.</summary>
public sealed class WorldConfigurableJoint : WorldJoint
{
    private const int Axes = 6;

    private readonly double[] _start = new double[Axes];
    private readonly double[] _unwrapped = new double[Axes];
    private readonly double _sign;
    private ConfigurableJoint _settings;

    internal WorldConfigurableJoint(Mechanism mechanism, int index, JointPlace place, ConfigurableJoint settings)
        : base(mechanism, index, place)
    {
        _settings = settings;
        _sign = UnityJoints.CoordinateSign(settings);
        for (int i = 0; i < Axes; i++)
        {
            _start[i] = Raw(i, 0);
            _unwrapped[i] = _start[i];
        }
    }

    /// <summary>
    /// Motions, limits, drives, targets, break limits and mass scales. A new value acts from the next step on; the frames and swapBodies stay
    /// as created.
    /// </summary>
    /// <exception cref="ArgumentException">swapBodies differs.</exception>
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

            _settings = value;
            UnityJoints.Apply(value, (D6Joint)Solved);
        }
    }

    /// <inheritdoc/>
    public override double Coordinate(Coordinate coordinate)
    {
        if (coordinate < Document.Coordinate.X || coordinate > Document.Coordinate.AngularZ)
        {
            throw new ArgumentException("A ConfigurableJoint has the coordinates x to angularZ.", nameof(coordinate));
        }

        int i = coordinate - Document.Coordinate.X;
        double value = Raw(i, _unwrapped[i]) - _start[i];
        return i < (int)CoordinateAxis.AngularX ? value : value * Degrees;
    }

    internal override void AfterStep()
    {
        for (int i = (int)CoordinateAxis.AngularX; i < Axes; i++)
        {
            _unwrapped[i] = Raw(i, _unwrapped[i]);
        }
    }

    private double Raw(int axis, double near) =>
        new Kinefab.Joints.JointCoordinate(Solved, (CoordinateAxis)axis, _sign).Evaluate(Pose0, Pose1, near, out _);
}
