using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>What ties a row's impulse to its speed.</summary>
internal enum RowKind : byte
{
    /// <summary>Nothing: the row is not there.</summary>
    None,

    /// <summary>Spring and damper within force limits: drives, hinge springs, soft limits.</summary>
    Spring,

    /// <summary>A speed held within force limits.</summary>
    SpeedMotor,

    /// <summary>C falls as prescribed, by an impulse within force limits.</summary>
    Motion,

    /// <summary>C stays positive by an impulse that is not negative.</summary>
    Limit,
}

/// <summary>Where on its piecewise-linear characteristic a row stands.</summary>
internal enum RowState : byte
{
    /// <summary>The impulse is fixed, at a bound or at 0.</summary>
    AtBound,

    /// <summary>The impulse follows from the speed.</summary>
    Free,
}

/// <summary>What a scalar row is in the matrix.</summary>
internal enum ProjectedAs : byte
{
    /// <summary>An identity row.</summary>
    Inactive,

    /// <summary>A row like a locked axis's.</summary>
    Rigid,

    /// <summary>A row with a spring's compliance.</summary>
    Compliant,
}

/// <summary>
/// One row whose impulse is a monotone piecewise-linear function of its speed. Impulse p is what the drift gets of it.
/// Spring: the force -k C + d (vT - v) is taken at the share Theta of the step, C = C0 + Theta h v, and its impulse
/// l = h (d vT - k C0) - G v, G = h (d + Theta h k) the <see cref="SpringLaw.ImplicitDamping"/>, is given by Theta before the drift and the rest after it:
/// Theta = 1/2 is the implicit midpoint rule, second order and without numerical damping; Theta = 1 is implicit Euler.
/// </summary>
internal struct ScalarRow
{
    /// <summary>A limit that is passed by less at a step's start is the drift's to close, m or rad; one by more, that closing the pose left there, stays.</summary>
    public const double MostClosedByDrift = 1e-6;

    /// <summary>Keeps the pivot of a limit or speed that other rows hold too above 0, without a trace in the speed.</summary>
    public const double RigidShare = 1e-11;

    /// <summary>A compliance beyond this share of the row's response stands for a spring that hardly acts.</summary>
    public const double LeastResponse = 1e-200;

    /// <summary>A bound of force beyond this is none: Unity's own "no limit" is the largest float, 3.4e38.</summary>
    public const double Endless = 1e30;

    /// <summary>Block, row in the block and row in the vectors.</summary>
    public int Block;
    public int BlockRow;
    public int Index;

    /// <summary>J, and C at the pose of the last Build.</summary>
    public ConstraintRow Built;

    /// <summary>Whether Prepare wrote the row at that pose.</summary>
    public bool IsActive;

    /// <summary>J and C at the end of the drift.</summary>
    public ConstraintRow End;

    /// <summary>Whether Prepare wrote that row where it was last asked.</summary>
    public bool HasEnd;

    /// <summary>What it is in the step, and where it stands: as all that follows the active set's to say.</summary>
    public RowKind Kind;
    public RowState State;

    /// <summary>What the factored matrix has of it.</summary>
    public ProjectedAs ProjectedAs;

    /// <summary>C at the start of the step, m or rad.</summary>
    public double StartError;

    /// <summary>C that a prescribed motion is to have at the end of the step by the weight that C has at its start, m or rad.</summary>
    public double EndError;

    /// <summary>Speed of the row at the start of the step, m/s or rad/s; in an impact, before it.</summary>
    public double StartSpeed;

    /// <summary>Share of the step at which a row's force is taken, and of its impulse that acts before the drift: 1/2 to 1.</summary>
    public double Theta;

    /// <summary>Bounds of the whole step's impulse, N s or N m s.</summary>
    public double Low;
    public double High;

    /// <summary>Impulse before the drift, and after it, N s or N m s.</summary>
    public double ImpulseFirstHalf;
    public double ImpulseSecondHalf;

    /// <summary>Change of <see cref="ImpulseFirstHalf"/> when it came to its bound, until the momenta have it.</summary>
    public double PendingImpulse;

    /// <summary>What it is as a limit.</summary>
    public LimitEvent Limit;

    /// <summary>As a spring.</summary>
    public ImplicitSpring Spring;

    /// <summary>As a drive without limit of force.</summary>
    public DriveStall Drive;

    /// <summary>And how fast it goes as such.</summary>
    public DrivePace Pace;

    /// <summary>
    /// What acts before the drift of an impulse at its bound: half of it, as of all that is constant in a step, also where a spring is too stiff for the
    /// midpoint rule.
    /// </summary>
    public readonly double BoundShare => Theta == 1 ? 1 : 0.5;

    /// <summary>What acts before the drift of the impulse as the row stands.</summary>
    public readonly double FirstShare => State == RowState.Free ? Theta : BoundShare;

    /// <summary>Whether a drive's force has no bound to a side.</summary>
    public readonly bool IsEndless => Math.Max(Built.Maximum, -Built.Minimum) > Endless;

    /// <summary>Whether it is there and a motor or prescribed motion whose force has no bound to a side: a spring's follows from where it is.</summary>
    public readonly bool IsEndlessDrive => IsActive && Built.Has(RowFlags.Drive) && !Built.Has(RowFlags.Spring) && IsEndless;

    /// <summary>Whether it asks for a speed in this step: a motor, or a prescribed motion.</summary>
    public readonly bool AsksForSpeed => Kind is RowKind.SpeedMotor or RowKind.Motion;

    /// <summary>Whether it has none to either side, so that a motor keeps its speed whatever strikes.</summary>
    public readonly bool HoldsThroughBlows => Math.Min(Built.Maximum, -Built.Minimum) > Endless;

    /// <summary>What the row is to the step that begins at the pose where it was written.</summary>
    /// <param name="reach">C up to which a soft limit counts as reached, m or rad.</param>
    public readonly RowKind FindKind(double reach)
    {
        if (!IsActive)
        {
            return RowKind.None;
        }

        if (Built.Has(RowFlags.Spring))
        {
            bool isIdle = Built.Stiffness == 0 && Built.Damping == 0;
            return isIdle || (Built.Has(RowFlags.Limit) && StartError > reach) ? RowKind.None : RowKind.Spring;
        }

        return Built.Has(RowFlags.Limit) ? RowKind.Limit : Built.Has(RowFlags.Motion) ? RowKind.Motion : RowKind.SpeedMotor;
    }

    /// <summary>What the matrix is to have of it.</summary>
    public readonly ProjectedAs FindProjectedAs() =>
        State == RowState.AtBound || !IsActive ? ProjectedAs.Inactive
        : Kind == RowKind.Spring ? ProjectedAs.Compliant
        : ProjectedAs.Rigid;

    /// <summary>Whether the joint stands at its limit where the row was last built, or beyond it.</summary>
    /// <param name="reach">C up to which it does, m or rad.</param>
    public readonly bool IsReached(double reach) => Built.GeometricError - Limit.Allowed <= reach;

    /// <summary>
    /// About where in the drift a limit that is passed at its end is reached, as a share of it: where the parabola through C and its rate at the start
    /// and C at the end falls through 0; where nothing is known of its start, as of a fall from rest at twice the depth, 1 / sqrt 2.
    /// </summary>
    /// <param name="h">Length of the drift, s.</param>
    public readonly double ReachedAt(double h)
    {
        double c = IsActive ? Math.Max(0, StartError) : -End.GeometricError;
        double b = IsActive ? StartSpeed * h : 0;
        double a = End.GeometricError - c - b;
        double square = b * b - 4 * a * c;

        // Of the two roots the one at which it falls, in the form that does not cancel.
        double root = Math.Sqrt(Math.Max(0, square));
        return b > 0 ? -(b + root) / (2 * a) : 2 * c / (root - b);
    }

    /// <summary>Whether the drift led from one side of a limit of place to the other, as from a slide's one end to the other: C of both is one.</summary>
    public readonly bool IsOnOtherSide => IsActive && HasEnd && Vector3d.Dot(Built.Linear0, End.Linear0) < 0;

    /// <param name="h">Step, s.</param>
    /// <param name="areForces">Whether the bounds of the joint's drives are forces, not impulses.</param>
    public void SetBounds(double h, bool areForces)
    {
        bool isForce = areForces && Built.Has(RowFlags.HasDriveLimit);
        Low = Built.Minimum * (isForce ? h : 1);
        High = Built.Maximum * (isForce ? h : 1);
    }

    /// <summary>The C that is wanted of a prescribed motion at the end of the step, of e^(-x) to second order and never beyond the goal.</summary>
    /// <param name="h">Step, s.</param>
    public void SetMotion(double h) => EndError = StartError / Growth(h);

    /// <summary>How far a prescribed motion is from where it is to be at the end of the step, as C there: the way that is left falls, whatever becomes of its weight.</summary>
    public readonly double Ahead => End.GeometricError - EndError * (Built.Weight > SwingTwist.LeastWeight ? End.Weight / Built.Weight : 1);

    /// <summary>Slows a drive down, or lets it go faster again.</summary>
    /// <param name="times">How often it is slowed down in all.</param>
    public void SlowDown(int times) => Pace.SlowDown(times, ref Built);

    /// <summary>The speed that a drive is asked for, 1/s of its C.</summary>
    /// <param name="h">Step, s.</param>
    public readonly double AskedSpeed(double h) => Kind == RowKind.Motion ? (EndError - StartError) / h : Built.VelocityTarget;

    /// <summary>
    /// A force without limit ends at what no mechanism needs, so that what the drive cannot move, as a limit, a dead point or another such drive, has
    /// a finite answer: the drive stalls.
    /// </summary>
    /// <param name="impulse">The most that it may need, N s or N m s.</param>
    public void BoundForce(double impulse)
    {
        Low = Built.Minimum < -Endless ? Math.Max(Low, -impulse) : Low;
        High = Built.Maximum > Endless ? Math.Min(High, impulse) : High;
    }

    /// <summary>By how much a prescribed motion's C was larger a time before.</summary>
    /// <param name="time">s.</param>
    public readonly double Growth(double time)
    {
        double x = Built.Stiffness * time;
        return 1 + x + x * x / 2;
    }

    /// <param name="h">Step, s.</param>
    /// <param name="response">J M^-1 J^T, 1/kg or 1/(kg m^2).</param>
    /// <param name="isImplicit">Whether the whole impulse acts before the drift, see <see cref="ProjectedStep"/>.</param>
    /// <param name="isSine">Whether C is a sine of the angle by which the row turns.</param>
    public void SetSpring(double h, double response, bool isImplicit, bool isSine)
    {
        var gains = new DriveModel { Stiffness = Built.Stiffness, Damping = Built.Damping, IsAcceleration = Built.Has(RowFlags.AccelerationSpring) };
        Spring.Law = new SpringLaw(gains, Built.VelocityTarget, StartError, h, response, isImplicit);
        Spring.StartResponse = response;
        Spring.StartTarget = Built.VelocityTarget;
        Theta = Spring.Law.Theta;
        Spring.EndShare = isSine && Theta == 0.5 && Spring.Law.ImplicitDamping > 0 ? 1 - h * Spring.Law.Damping / Spring.Law.ImplicitDamping : 0;
        Spring.Length = h;
    }
}

/// <summary>What a scalar row brings into a step from the one before: all else follows from the rows that are built at its start.</summary>
internal readonly struct WarmStart
{
    public readonly double ImpulseFirstHalf;
    public readonly RowState State;
    public readonly double Work;

    public WarmStart(in ScalarRow scalar)
    {
        ImpulseFirstHalf = scalar.ImpulseFirstHalf;
        State = scalar.State;
        Work = scalar.Spring.Work;
    }
}
