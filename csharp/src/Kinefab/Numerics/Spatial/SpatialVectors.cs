using System.Runtime.CompilerServices;

namespace Kinefab.Numerics;

/// <summary>A rigid body's motion, world axes: its rotation and the velocity (or acceleration) of one of its points.</summary>
internal readonly struct Twist
{
    /// <summary>rad/s (or rad/s^2).</summary>
    public readonly Vector3d Angular;

    /// <summary>Of the point, m/s (or m/s^2).</summary>
    public readonly Vector3d Linear;

    public Twist(Vector3d angular, Vector3d linear)
    {
        Angular = angular;
        Linear = linear;
    }

    /// <summary>The same motion seen from another point of the body, r away: v + w x r.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Twist At(Vector3d r) => new(Angular, Linear + Vector3d.Cross(Angular, r));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Twist operator +(in Twist a, in Twist b) => new(a.Angular + b.Angular, a.Linear + b.Linear);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Twist operator -(in Twist a, in Twist b) => new(a.Angular - b.Angular, a.Linear - b.Linear);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Twist operator *(in Twist a, double s) => new(a.Angular * s, a.Linear * s);
}

/// <summary>A force and a torque on a rigid body (or their impulses), world axes, the torque about one of its points.</summary>
internal readonly struct Wrench
{
    /// <summary>N (or N s).</summary>
    public readonly Vector3d Force;

    /// <summary>About the point, N m (or N m s).</summary>
    public readonly Vector3d Torque;

    public Wrench(Vector3d force, Vector3d torque)
    {
        Force = force;
        Torque = torque;
    }

    /// <summary>The same wrench about another point; r leads from there to the old one: t + r x f.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Wrench From(Vector3d r) => new(Force, Torque + Vector3d.Cross(r, Force));

    /// <summary>Power (or work) on a motion of the same point.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static double Dot(in Wrench f, in Twist v) => Vector3d.Dot(f.Force, v.Linear) + Vector3d.Dot(f.Torque, v.Angular);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Wrench operator +(in Wrench a, in Wrench b) => new(a.Force + b.Force, a.Torque + b.Torque);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Wrench operator -(in Wrench a, in Wrench b) => new(a.Force - b.Force, a.Torque - b.Torque);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Wrench operator *(in Wrench a, double s) => new(a.Force * s, a.Torque * s);
}

/// <summary>A twist seen from one point that all links share, so that nothing has to be moved from link to link.</summary>
internal readonly struct SharedTwist
{
    private readonly Double4 _angular;
    private readonly Double4 _linear;

    /// <param name="twist">Seen from a point of its own.</param>
    /// <param name="arm">From the shared point there.</param>
    public SharedTwist(in Twist twist, Vector3d arm)
        : this(new Double4(twist.Angular, 0), new Double4(twist.Linear - Vector3d.Cross(twist.Angular, arm), 0))
    {
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private SharedTwist(in Double4 angular, in Double4 linear)
    {
        _angular = angular;
        _linear = linear;
    }

    /// <summary>Seen from the point at the end of an arm.</summary>
    public Twist At(Vector3d arm) => new Twist(_angular.Vector, _linear.Vector).At(arm);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static double Dot(in SharedWrench f, in SharedTwist v) => (f.Force * v._linear + f.Torque * v._angular).Sum3;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static SharedTwist operator +(in SharedTwist a, in SharedTwist b) => new(a._angular + b._angular, a._linear + b._linear);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static SharedTwist operator *(in SharedTwist a, double s) => new(a._angular * s, a._linear * s);
}

/// <summary>A wrench about the point that all links share.</summary>
internal readonly struct SharedWrench
{
    public readonly Double4 Force;
    public readonly Double4 Torque;

    /// <param name="wrench">About a point of its own.</param>
    /// <param name="arm">From the shared point there.</param>
    public SharedWrench(in Wrench wrench, Vector3d arm)
        : this(new Double4(wrench.Force, 0), new Double4(wrench.From(arm).Torque, 0))
    {
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private SharedWrench(in Double4 force, in Double4 torque)
    {
        Force = force;
        Torque = torque;
    }

    /// <summary>About the point at the end of an arm.</summary>
    public Wrench At(Vector3d arm) => new Wrench(Force.Vector, Torque.Vector).From(-arm);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static SharedWrench operator +(in SharedWrench a, in SharedWrench b) => new(a.Force + b.Force, a.Torque + b.Torque);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static SharedWrench operator -(in SharedWrench a, in SharedWrench b) => new(a.Force - b.Force, a.Torque - b.Torque);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static SharedWrench operator *(in SharedWrench a, double s) => new(a.Force * s, a.Torque * s);
}
