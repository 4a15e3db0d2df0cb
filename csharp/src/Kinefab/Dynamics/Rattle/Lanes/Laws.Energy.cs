using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>What springs and motors hold and give: the account by which a step is audited.</content>
internal sealed partial class Laws<V>
    where V : struct, ILane<V>
{
    /// <summary>Opens the account of <see cref="SpringWork"/>.</summary>
    public void ClearWork()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            _laws[i].Work = 0;
        }
    }

    /// <summary>Puts the flight's work into the account, with the rows still those of its start and end.</summary>
    public void AddWork()
    {
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            law.Work += law.Kind == LawKind.Spring && !HasPotential(law) ? law.First / law.Theta * FlightSpeed(law) : 0;
        }
    }

    /// <summary>Work of the springs that have no potential since the account was opened, J.</summary>
    public double SpringWork()
    {
        double sum = 0;
        for (int i = 0; i < _laws.Length; i++)
        {
            sum += _laws[i].Work;
        }

        return sum;
    }

    /// <summary>
    /// Energy in the springs that have a potential where the rows were last built, J: of one at its limit, what that force
    /// gives on the way back.
    /// </summary>
    /// <param name="dt">Step, s.</param>
    public double Stored(double dt)
    {
        double sum = 0;
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            double c = law.Row.GeometricError;
            if (law.IsWritten && law.Row.Has(RowFlags.Spring) && law.Row.Stiffness > 0 && !(law.Row.Has(RowFlags.Limit) && c >= 0) && HasPotential(law))
            {
                double response = law.Row.Has(RowFlags.AccelerationSpring) ? Response(law) : 1;
                double k = response > LeastResponse ? law.Row.Stiffness / response : 0;
                bool isForce = _batch.Shape.Nodes[law.Node].Joint!.DriveLimitsAreForces || !law.Row.Has(RowFlags.HasDriveLimit);
                double most = (c < 0 ? law.Row.Maximum : -law.Row.Minimum) / (isForce ? 1 : dt);
                double yield = Math.Min(Math.Abs(c), most / Math.Max(k, LeastResponse));
                sum += k * yield * (Math.Abs(c) - yield / 2);
            }
        }

        return sum;
    }

    /// <summary>The most that motors can have given since the start of the step, J.</summary>
    public double Driven()
    {
        double sum = 0;
        for (int i = 0; i < _laws.Length; i++)
        {
            ref Law law = ref _laws[i];
            sum += law.IsWritten && !law.Row.Has(RowFlags.Spring) ? Math.Abs(law.Row.VelocityTarget * _batch.Work.Total[law.Index]) : 0;
        }

        return sum;
    }

    // Whether the force is one in C alone and C changes as the row moves: not where a damper drives, nor of twist and swing
    // drives, whose C is a sine of the angle by which the row turns, so that a force at its limit works by more than C says.
    private bool HasPotential(in Law law) =>
        law.Row.Hint == SolveHint.SlerpSpring ? ((D6Joint)_batch.Shape.Nodes[law.Node].Joint!).DriveAngularVelocity == Vector3d.Zero
        : law.Row.VelocityTarget == 0 && (!law.Row.Has(RowFlags.Angular | RowFlags.Drive) || _batch.Shape.Nodes[law.Node].Joint is RevoluteJoint);
}
