using System;
using Kinefab.Numerics;

namespace Kinefab.Joints;

/// <summary>
/// A joint in PhysX's terms. Frames are given in the frames of the bodies' centres of mass and principal axes.
/// Angles are those of actor 1 seen from actor 0: c = F0^-1 * F1. Nothing here knows Unity's signs.
/// </summary>
internal abstract class JointModel
{
    /// <summary>No joint emits more rows than this (PhysX: MAX_CONSTRAINT_ROWS).</summary>
    public const int MaxRows = 20;

    /// <summary>Stands for the world, which never moves.</summary>
    public const int World = -1;

    /// <summary>Index of actor 0, or World.</summary>
    public int Body0 = World;

    /// <summary>Index of actor 1, or World.</summary>
    public int Body1 = World;

    /// <summary>Joint frame in body 0's frame (in the world for World).</summary>
    public Pose Frame0 = Pose.Identity;

    /// <summary>Joint frame in body 1's frame (in the world for World).</summary>
    public Pose Frame1 = Pose.Identity;

    /// <summary>Largest constraint force before the joint breaks, N.</summary>
    public double BreakForce = double.PositiveInfinity;

    /// <summary>Largest constraint torque at actor 1's anchor before the joint breaks, N m.</summary>
    public double BreakTorque = double.PositiveInfinity;

    /// <summary>Whether either limit is a finite one.</summary>
    public bool CanBreak => BreakForce < double.PositiveInfinity || BreakTorque < double.PositiveInfinity;

    /// <summary>Factors on the inverse masses as this joint sees them.</summary>
    public double InverseMassScale0 = 1;
    public double InverseMassScale1 = 1;

    /// <summary>Factors on the inverse inertias as this joint sees them.</summary>
    public double InverseInertiaScale0 = 1;
    public double InverseInertiaScale1 = 1;

    /// <summary>Makes the joint's rigid rows mass-orthogonal to each other before they are solved.</summary>
    public bool Preprocessing = true;

    /// <summary>Drive limits are forces, not impulses (PhysX: eDRIVE_LIMITS_ARE_FORCES).</summary>
    public bool DriveLimitsAreForces = true;

    /// <summary>Angles reach from -2 pi to 2 pi (PhysX: eENABLE_EXTENDED_LIMITS).</summary>
    public bool ExtendedLimits;

    /// <summary>Body poses are snapped back after the step once an error passes a tolerance (PhysX: ePROJECTION).</summary>
    public bool Projection;
    public double ProjectionLinearTolerance = 1e10;
    public double ProjectionAngularTolerance = Math.PI;

    /// <summary>
    /// Prepare writes the rows of all limits however far they are, not only within their contact distance, and counts the angle about X
    /// with its whole turns, near <see cref="LastTwist"/>; else it wraps where PhysX's does.
    /// </summary>
    public bool LimitsFromAfar;

    /// <summary>Angle of actor 1 against actor 0 about X at the last finished step, with its whole turns, radians.</summary>
    public double LastTwist;

    /// <summary>A broken joint has no rows.</summary>
    public bool IsBroken;

    private bool _isCounted;

    /// <summary>The joint's frames at poses of its bodies.</summary>
    public void FramesAt(in Pose body0, in Pose body1, out JointFrames f) => JointFrames.Of(body0 * Frame0, body1 * Frame1, ExtendedLimits, out f);

    /// <summary>Notes the angle about X that the joint has reached, by which its next step counts the turns.</summary>
    public void FinishTwist(in Pose body0, in Pose body1)
    {
        FramesAt(body0, body1, out JointFrames f);
        CountTwist(SwingTwist.Nearest(Twisted(f), LastTwist));
    }

    /// <summary>As <see cref="FinishTwist"/>, of an angle that is known with its whole turns.</summary>
    /// <param name="twist">Radians.</param>
    public void CountTwist(double twist)
    {
        LastTwist = twist;
        _isCounted = true;
    }

    /// <summary>Between steps: where the angle about X stands; the next step has counted nothing yet.</summary>
    /// <param name="twist">With its whole turns, radians.</param>
    public void RestartTwist(double twist)
    {
        LastTwist = twist;
        _isCounted = false;
    }

    /// <summary>Whether the solver counted the angle about X part by part through the last step, so that <see cref="LastTwist"/> is where it stands.</summary>
    /// <param name="twist">The angle at the pose, less whole turns, radians.</param>
    public bool HasCounted(double twist)
    {
        const double rounding = 1e-6;
        return LimitsFromAfar && _isCounted && Math.Abs(SwingTwist.Nearest(twist, LastTwist) - LastTwist) <= rounding;
    }

    /// <summary>A copy of the joint between other bodies.</summary>
    public JointModel Between(int body0, int body1)
    {
        JointModel copy = (JointModel)MemberwiseClone();
        copy.Body0 = body0;
        copy.Body1 = body1;
        return copy;
    }

    /// <summary>Takes over every setting of a copy of this joint.</summary>
    public virtual void TakeOver(JointModel copy)
    {
        Body0 = copy.Body0;
        Body1 = copy.Body1;
        Frame0 = copy.Frame0;
        Frame1 = copy.Frame1;
        BreakForce = copy.BreakForce;
        BreakTorque = copy.BreakTorque;
        InverseMassScale0 = copy.InverseMassScale0;
        InverseMassScale1 = copy.InverseMassScale1;
        InverseInertiaScale0 = copy.InverseInertiaScale0;
        InverseInertiaScale1 = copy.InverseInertiaScale1;
        Preprocessing = copy.Preprocessing;
        DriveLimitsAreForces = copy.DriveLimitsAreForces;
        ExtendedLimits = copy.ExtendedLimits;
        Projection = copy.Projection;
        ProjectionLinearTolerance = copy.ProjectionLinearTolerance;
        ProjectionAngularTolerance = copy.ProjectionAngularTolerance;
        LimitsFromAfar = copy.LimitsFromAfar;
        LastTwist = copy.LastTwist;
        IsBroken = copy.IsBroken;
        _isCounted = copy._isCounted;
    }

    /// <summary>
    /// Writes the joint's rows at the given poses of its bodies' centres of mass and returns their number; a pure
    /// function of its arguments and the joint's fields. Rows come in PhysX's order of emission. World's pose is the identity.
    /// </summary>
    public abstract int Prepare(in Pose body0, in Pose body1, Span<ConstraintRow> rows);

    /// <summary>As <see cref="Prepare"/>, but the locked axes' rows alone, and the frames at which they hold; no row unless a joint says otherwise.</summary>
    public virtual int PrepareLocked(in Pose body0, in Pose body1, Span<ConstraintRow> rows, out JointFrames frames)
    {
        FramesAt(body0, body1, out frames);
        return 0;
    }

    /// <summary>Which rows the joint may ever have with its fields as they are. Unless a joint says otherwise: drive rows alone, as many as it writes now.</summary>
    public virtual RowLayout Layout()
    {
        Span<ConstraintRow> rows = stackalloc ConstraintRow[MaxRows];
        return new RowLayout(0, 0, Prepare(Pose.Identity, Pose.Identity, rows), 0, false);
    }

    /// <summary>The angle about X at a pose, less whole turns, radians.</summary>
    private protected virtual double Twisted(in JointFrames f) => SwingTwist.TwistAngle(f.Relative.Rotation);

    /// <summary>An angle about X as Prepare counts it.</summary>
    private protected double Followed(double twist) => LimitsFromAfar ? SwingTwist.Nearest(twist, LastTwist) : twist;

    /// <summary>As <see cref="Prepare"/>, but locked axes may be left out: for a solver that has their rows already.</summary>
    public virtual int PrepareForces(in Pose body0, in Pose body1, Span<ConstraintRow> rows) => Prepare(body0, body1, rows);
}
