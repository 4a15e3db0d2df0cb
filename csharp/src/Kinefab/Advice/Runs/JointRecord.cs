using System;
using System.Collections.Generic;
using Kinefab.Dynamics;
using Kinefab.Validation;

namespace Kinefab.Advice.Runs;

/// <summary>What a joint did in a run.</summary>
internal sealed class JointRecord
{
    private const double Degrees = 180 / Math.PI;

    private readonly WorldJoint _joint;
    private readonly ShakeMeter _shake = new();

    public JointRecord(WorldJoint joint, IReadOnlyList<JointFreedom> freedoms, int samples)
    {
        _joint = joint;
        Freedoms = freedoms;
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

    /// <summary>Furthest way beyond a limit.</summary>
    public AdviceMeasure Overshoot { get; private set; }

    /// <summary>Takes note of a step.</summary>
    public void Note(WorldJoint joint, bool isLate)
    {
        JointDrift drift = joint.Drift;
        Drift = AdviceMeasure.Max(Drift, new AdviceMeasure(drift.Distance, drift.Angle * Degrees));
        _shake.Note(joint.Relative, isLate);
        foreach (JointFreedom freedom in Freedoms)
        {
            if (!freedom.IsLimited)
                continue;
            double value = joint.Coordinate(freedom.Coordinate);
            double beyond = Math.Max(0, Math.Max(freedom.Lower - value, value - freedom.Upper));
            Overshoot = AdviceMeasure.Max(Overshoot, Of(freedom, beyond));
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
