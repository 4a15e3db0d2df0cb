using System;
using System.Runtime.CompilerServices;

namespace Kinefab.Numerics;

/// <summary>Angles in lanes: + - * / alone, so that a lane's bits are the same at every width.</summary>
internal static class LaneTrigonometry<V>
    where V : struct, ILane<V>
{
    // tan(pi / 8): up to it the series is taken as it is, beyond it from pi / 4 on.
    private const double MostSlope = 0.41421356237309503;

    // A number so large that what is added to it is rounded to a whole one.
    private const double Whole = 6755399441055744;

    /// <summary>
    /// The angle of a point, -pi to pi; of none where the point is the origin. Within two units in the last place.
    /// Source: Moshier 1989, Methods and Programs for Mathematical Functions (Cephes), atan.
    /// </summary>
    [MethodImpl(MethodImplOptions.NoInlining)]
    public static void Atan2(double[] ys, int y, double[] xs, int x, double[] to, int at)
    {
        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> across = Lane<V>.Load(ys, y), along = Lane<V>.Load(xs, x);
        Lane<V> a = Lane<V>.Abs(across), b = Lane<V>.Abs(along);
        Lane<V> least = Lane<V>.Min(a, b), most = Lane<V>.Max(a, b);
        Lane<V> isSteep = Lane<V>.Max(least - Lane<V>.Splat(MostSlope) * most, zero);
        Lane<V> t = Lane<V>.Select(isSteep, least - most, least) / Lane<V>.Select(isSteep, least + most, most);
        Lane<V> angle = Atan(t);
        angle = Lane<V>.Select(isSteep, Lane<V>.Splat(Math.PI / 4) + angle, angle);
        angle = Lane<V>.Select(Lane<V>.Max(a - b, zero), Lane<V>.Splat(Math.PI / 2) - angle, angle);
        angle = Lane<V>.Select(Lane<V>.Min(along, zero), Lane<V>.Splat(Math.PI) - angle, angle);
        Lane<V>.Select(Lane<V>.Min(across, zero), zero - angle, angle).Store(to, at);
    }

    /// <summary>The angle of a slope of at most 0.66 either way.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Atan(Lane<V> t)
    {
        Lane<V> z = t * t;
        Lane<V> p = Lane<V>.Splat(-8.750608600031904122785e-1) * z + Lane<V>.Splat(-1.615753718733365076637e1);
        p = p * z + Lane<V>.Splat(-7.500855792314704667340e1);
        p = p * z + Lane<V>.Splat(-1.228866684490136173410e2);
        p = p * z + Lane<V>.Splat(-6.485021904942025371773e1);
        Lane<V> q = z + Lane<V>.Splat(2.485846490142306297962e1);
        q = q * z + Lane<V>.Splat(1.650270098316988542046e2);
        q = q * z + Lane<V>.Splat(4.328810604912902668951e2);
        q = q * z + Lane<V>.Splat(4.853903996359136964868e2);
        q = q * z + Lane<V>.Splat(1.945506571482613964425e2);
        return t + t * z * (p / q);
    }

    /// <summary>Of the angles that differ from one by whole turns the one nearest to a reference, radians; the reference is less than 1e15.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Nearest(Lane<V> angle, Lane<V> reference)
    {
        Lane<V> turns = (reference - angle) * Lane<V>.Splat(1 / (2 * Math.PI)) + Lane<V>.Splat(Whole) - Lane<V>.Splat(Whole);
        return angle + Lane<V>.Splat(2 * Math.PI) * turns;
    }
}
