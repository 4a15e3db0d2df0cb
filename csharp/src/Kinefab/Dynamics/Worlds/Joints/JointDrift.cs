using System.Diagnostics;
using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics;

/// <summary>How far a joint's locked freedoms have come apart.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public readonly struct JointDrift
{
    // A limit counts as reached this close to it, m or rad.
    private const double LimitTolerance = 1e-3;

    internal JointDrift(double distance, double angle)
    {
        Distance = distance;
        Angle = angle;
    }

    /// <summary>Distance of the anchors along the locked axes, metres.</summary>
    public double Distance { get; }

    /// <summary>Rotation about the locked axes, degrees.</summary>
    public double Angle { get; }

    /// <summary>1.2e-06 m, 0.0e+00 deg.</summary>
    public override string ToString() => FormattableString.Invariant($"{Distance:0.0e+00} m, {Angle:0.0e+00} deg");

    internal static JointDrift Of(JointModel joint, in Pose body0, in Pose body1)
    {
        if (joint.IsBroken)
        {
            return default;
        }

        Span<ConstraintRow> rows = stackalloc ConstraintRow[JointModel.MaxRows];
        int count = joint.Prepare(body0, body1, rows);
        double distance = 0;
        double angle = 0;
        for (int i = 0; i < count; i++)
        {
            ref ConstraintRow row = ref rows[i];
            if (row.Hint != SolveHint.Equality)
            {
                continue;
            }

            if (row.Has(RowFlags.Angular))
            {
                double error = row.GeometricError / row.Angular0.Length;
                angle += error * error;
            }
            else
            {
                distance += row.GeometricError * row.GeometricError;
            }
        }

        // A row's error over its axis is a tangent: of the angle where one swing is locked alone, else twice that of its half.
        int angular = joint.Layout().Locked >> (int)CoordinateAxis.AngularX;
        double tangent = Math.Sqrt(angle);
        double turned = angular is 0b010 or 0b100 ? Trigonometry.Atan(tangent) : 2 * Trigonometry.Atan(tangent / 2);
        return new JointDrift(Math.Sqrt(distance), turned * (180 / Math.PI));
    }

    internal static bool IsAtLimit(JointModel joint, in Pose body0, in Pose body1)
    {
        if (joint.IsBroken)
        {
            return false;
        }

        Span<ConstraintRow> rows = stackalloc ConstraintRow[JointModel.MaxRows];
        int count = joint.Prepare(body0, body1, rows);
        for (int i = 0; i < count; i++)
        {
            if (rows[i].Has(RowFlags.Limit) && rows[i].GeometricError <= LimitTolerance)
            {
                return true;
            }
        }

        return false;
    }
}
