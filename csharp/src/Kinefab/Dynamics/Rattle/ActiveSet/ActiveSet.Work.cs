using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>What springs and motors hold and give: the account by which a step is audited.</content>
internal sealed partial class ActiveSet<V>
    where V : struct, ILane<V>
{
    /// <summary>Whether a row gave any impulse since the start of the step.</summary>
    public bool HasActed
    {
        get
        {
            bool hasActed = false;
            for (int i = 0; i < _rows.Length && !hasActed; i++)
            {
                hasActed = _batch.Work.TotalImpulses[_rows[i].Index] != 0;
            }

            return hasActed;
        }
    }

    /// <summary>Opens the account of <see cref="SpringWork"/>.</summary>
    public void ClearWork()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            _rows[i].Spring.Work = 0;
        }
    }

    /// <summary>Puts the drift's work into the account, with the rows still those of its start and end.</summary>
    public void AddWork()
    {
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            scalar.Spring.DriftSpeed = scalar.Kind == RowKind.Spring && !HasPotential(scalar) ? DriftSpeed(scalar) : 0;
            scalar.Spring.Work += scalar.Spring.DriftSpeed != 0 ? scalar.ImpulseFirstHalf / scalar.FirstShare * scalar.Spring.DriftSpeed : 0;
        }
    }

    /// <summary>Work of the springs that have no potential since the account was opened, J.</summary>
    public double SpringWork()
    {
        double sum = 0;
        for (int i = 0; i < _rows.Length; i++)
        {
            sum += _rows[i].Spring.Work;
        }

        return sum;
    }

    /// <summary>
    /// Energy in the springs that have a potential where the rows were last built, J: of one at its limit, what that force
    /// gives on the way back.
    /// </summary>
    /// <param name="dt">Step, s.</param>
    public double StoredEnergy(double dt)
    {
        double sum = 0;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            double c = scalar.Built.GeometricError;
            if (scalar.IsActive && scalar.Built.Has(RowFlags.Spring) && scalar.Built.Stiffness > 0 && !(scalar.Built.Has(RowFlags.Limit) && c >= 0) && HasPotential(scalar))
            {
                double k = Stiffness(scalar);
                double yield = Math.Min(Math.Abs(c), MostForce(scalar, dt) / Math.Max(k, ScalarRow.LeastResponse));
                sum += k * yield * (Math.Abs(c) - yield / 2);
            }
        }

        return sum;
    }

    /// <summary>What all springs hold more at most where each is off by a distance, J.</summary>
    /// <param name="distance">m or rad.</param>
    /// <param name="dt">Step, s.</param>
    public double LargestStoredEnergy(double distance, double dt)
    {
        double sum = 0;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            if (scalar.IsActive && scalar.Built.Has(RowFlags.Spring))
            {
                double k = Stiffness(scalar);
                sum += distance * Math.Min(MostForce(scalar, dt), k * (distance + Math.Abs(scalar.Built.GeometricError)));
            }
        }

        return sum;
    }

    /// <summary>The most that motors and prescribed motions can have given by impulses, J.</summary>
    /// <param name="h">In how long, s.</param>
    /// <param name="impulses">Of all rows, N s or N m s.</param>
    public double MotorWorkBound(double h, double[] impulses)
    {
        double sum = 0;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow scalar = ref _rows[i];
            double fastest = scalar.Built.VelocityTarget * (scalar.Built.Has(RowFlags.Motion) ? scalar.Growth(h) : 1);
            sum += scalar.IsActive && !scalar.Built.Has(RowFlags.Spring) ? Math.Abs(fastest * impulses[scalar.Index]) : 0;
        }

        return sum;
    }

    // To the side to which it draws, N or N m.
    private double MostForce(in ScalarRow scalar, double dt)
    {
        bool isForce = _batch.Models[scalar.Block]!.DriveLimitsAreForces || !scalar.Built.Has(RowFlags.HasDriveLimit);
        return (scalar.Built.GeometricError < 0 || scalar.Built.Has(RowFlags.Limit) ? scalar.Built.Maximum : -scalar.Built.Minimum) / (isForce ? 1 : dt);
    }

    // N/m or N m/rad, of an acceleration spring too; 0 where it hardly acts.
    private double Stiffness(in ScalarRow scalar)
    {
        double response = scalar.Built.Has(RowFlags.AccelerationSpring) ? Response(scalar) : 1;
        return response > ScalarRow.LeastResponse ? scalar.Built.Stiffness / response : 0;
    }

    // Whether the force is one in C alone and C changes as the row moves: not where a damper drives, nor of twist and swing
    // drives, whose C is a sine of the angle by which the row turns, so that a force at its limit works by more than C says; nor of an acceleration that
    // asks the bodies for another force in each pose, as it does but in a hinge and a slide.
    private bool HasPotential(in ScalarRow scalar) =>
        !IsSine(scalar) && (scalar.Built.Damping == 0 || !IsAskedForSpeed(scalar))
        && (!scalar.Built.Has(RowFlags.AccelerationSpring) || _batch.Shape.Blocks[scalar.Block].HasOneFreedom);

    private bool IsAskedForSpeed(in ScalarRow scalar) =>
        scalar.Built.Hint == SolveHint.SlerpSpring ? ((D6Joint)_batch.Models[scalar.Block]!).DriveAngularVelocity != Vector3d.Zero : scalar.Built.VelocityTarget != 0;

    // The springs of a D6's twist and swing.
    private bool IsSine(in ScalarRow scalar) =>
        scalar.Built.Has(RowFlags.Angular | RowFlags.Drive) && scalar.Built.Hint != SolveHint.SlerpSpring && _batch.Models[scalar.Block] is not RevoluteJoint;
}
