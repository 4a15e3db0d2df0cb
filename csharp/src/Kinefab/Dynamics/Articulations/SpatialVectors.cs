using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

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
