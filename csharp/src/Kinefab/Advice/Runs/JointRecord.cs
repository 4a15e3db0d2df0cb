using System;
using System.Collections.Generic;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Validation;

namespace Kinefab.Advice.Runs;

/// <summary>What a joint did in a run.</summary>
internal sealed class JointRecord
{
    private readonly WorldJoint _joint;
    private readonly ShakeMeter _shake = new();
    private readonly double[] _overshoots;

    public JointRecord(WorldJoint joint, IReadOnlyList<JointFreedom> freedoms, int samples)
    {
        _joint = joint;
        Freedoms = freedoms;
        _overshoots = new double[freedoms.Count];
        Coordinates = new double[freedoms.Count][];
        for (int i = 0; i < Coordinates.Length; i++)
            Coordinates[i] = new double[samples];
    }

    /// <summary>The unlocked freedoms.</summary>
    public IReadOnlyList<JointFreedom> Freedoms { get; }

    /// <summary>By freedom and sample; degrees or metres, 0 at the start.</summary>
    public double[][] Coordinates { get; }

    /// <summary>Largest gap of the locked freedoms.</summary>
    public AdviceMeasure Drift { get; private set; }

    /// <summary>By how much the relative motion goes to and fro from one step to the next, on average over the second half.</summary>
    public AdviceMeasure Shake => _shake.Mean;

    /// <summary>Furthest way beyond the limits of a coordinate, degrees or metres; 0 where it is locked.</summary>
    public double Overshoot(Coordinate coordinate)
    {
        for (int i = 0; i < _overshoots.Length; i++)
        {
            if (Freedoms[i].Coordinate == coordinate)
                return _overshoots[i];
        }

        return 0;
    }

    /// <summary>Takes note of a step.</summary>
    public void Note(bool isLate)
    {
        JointDrift drift = _joint.Drift;
        Drift = AdviceMeasure.Max(Drift, new AdviceMeasure(drift.Distance, drift.Angle));
        _shake.Note(_joint.Relative, isLate);
        for (int i = 0; i < _overshoots.Length; i++)
        {
            JointFreedom freedom = Freedoms[i];
            if (!freedom.IsLimited)
                continue;
            double value = _joint.Coordinate(freedom.Coordinate);
            _overshoots[i] = Math.Max(_overshoots[i], Math.Max(freedom.Lower - value, value - freedom.Upper));
        }
    }

    /// <summary>Writes the coordinates down.</summary>
    public void Sample(int k)
    {
        for (int i = 0; i < Coordinates.Length; i++)
            Coordinates[i][k] = _joint.Coordinate(Freedoms[i].Coordinate);
    }

    /// <summary>A value of a freedom as a measure.</summary>
    public static AdviceMeasure Of(in JointFreedom freedom, double value) =>
        freedom.IsAngle ? new AdviceMeasure(null, value) : new AdviceMeasure(value, null);
}
