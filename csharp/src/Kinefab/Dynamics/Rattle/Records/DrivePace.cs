using System;
using Kinefab.Joints;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// How fast a drive without limit of force goes of what it is asked for: slower where the mechanism did not follow it, not at all where it stood, see
/// <see cref="ActiveSet{V}.EndPace"/>.
/// </summary>
internal struct DrivePace
{
    /// <summary>By how much a drive may become faster in a step.</summary>
    public const double SlowerBy = 2;

    /// <summary>Of a drive that nothing can follow, its speed is a millionth.</summary>
    public const int MostSlowdowns = 20;

    /// <summary>
    /// One that stands rests: it asks for nothing that rounding tells from rest, so that it and what holds it agree. It tries again now and then as it comes
    /// back from there, and rests on until it is that much faster than one that nothing can follow; where <see cref="HeldDrives"/> sees it free, at once.
    /// </summary>
    public const int Resting = 60;
    private const int Awake = 4;
    private const int Return = 4;

    /// <summary>How often the speed was halved.</summary>
    public int Slowdowns;

    /// <summary>How often, when the mechanism last followed it.</summary>
    public int FollowedSlowdowns;

    /// <summary>Whether it was slowed down within the step, see <see cref="ActiveSet{V}.SlowDown"/>.</summary>
    public bool IsSlowedWithin;

    /// <summary>Which way it was asked to go then: the sign of its speed.</summary>
    public int Side;

    /// <summary>Whether it rested at the end of the last step.</summary>
    public bool HasRested;

    /// <summary>What freedom it had when it came to rest, see <see cref="HeldDrives.Wake"/>; NaN: it is not measured yet.</summary>
    public double RestingFreedom;

    /// <summary>What the mechanism is to it at the end of a step, kg or kg m^2; 0: it is not known.</summary>
    public double Inertia;

    /// <summary>Speed of the row where the step began, before which its pace was set.</summary>
    public double StartSpeed;

    /// <summary>What is left of its speed.</summary>
    public readonly double Share => Slowdowns == 0 ? 1 : Math.Pow(SlowerBy, -Slowdowns);

    /// <summary>Whether it rests. One that comes back from a rest does until it was followed a little.</summary>
    public readonly bool Rests => Slowdowns > MostSlowdowns - (HasRested ? Return : 0);

    /// <summary>How often it is slowed down as it goes on after a rest.</summary>
    public readonly int AwakeSlowdowns => Math.Max(Awake, FollowedSlowdowns);

    /// <summary>Slows it down, or lets it go faster again.</summary>
    /// <param name="times">How often it is slowed down in all.</param>
    /// <param name="row">The drive's, at the pace that it had.</param>
    public void SlowDown(int times, ref ConstraintRow row)
    {
        if (times != Slowdowns)
        {
            double before = Share;
            Slowdowns = times;
            Scale(ref row, Share / before);
        }
    }

    /// <summary>A drive that was slowed down asks for its speed, or for the rate at which its C is to fall, at that pace.</summary>
    /// <param name="row">As its joint wrote it.</param>
    public readonly void Slow(ref ConstraintRow row)
    {
        if (Slowdowns > 0)
        {
            Scale(ref row, Share);
        }
    }

    // A spring has no pace: its row may be one that was a drive's.
    private static void Scale(ref ConstraintRow row, double factor)
    {
        if (row.Has(RowFlags.Drive) && !row.Has(RowFlags.Spring))
        {
            row.VelocityTarget *= factor;
            row.Stiffness *= factor;
        }
    }
}
