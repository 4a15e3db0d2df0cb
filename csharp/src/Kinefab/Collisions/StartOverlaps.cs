using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Threading;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Collisions;

/// <summary>
/// What Unity will push apart when a scene starts: colliders of different bodies that overlap at the exported pose, where neither a joint,
/// a link above the other nor an ignored pair keeps the two from colliding. Kinefab's own solvers know no contacts.
/// </summary>
public static class StartOverlaps
{
    // Metres: Unity's default contact offset, within which touching shapes are held apart softly.
    private const double ContactOffset = 0.01;

    // Of the smaller shape's size: the depth that counts for shapes that are small against the contact offset.
    private const double Share = 0.02;

    // Points that are looked at in all; counted, not clocked, so that the same file gives the same findings. About a second.
    private const long MostPoints = 400_000_000;

    // Points of a shape are looked at so often until its depth is known.
    private const int Looks = 40;

    /// <summary>Looks for them; the export does so too.</summary>
    /// <param name="scene">At the pose of the file.</param>
    /// <param name="cancellation">Ends it early.</param>
    /// <returns>A warning <c>COLLIDERS_OVERLAP</c> for each pair of objects, the deepest first; an info <c>OVERLAPS_NOT_CHECKED</c> where there was too much to look at.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public static Report Of(ValidScene scene, CancellationToken cancellation = default)
    {
        if (scene is null)
            throw new ArgumentNullException(nameof(scene));
        var pairs = new CollisionPairs(scene);
        if (!pairs.HasMoving)
            return Report.Empty;
        var depth = new ConvexDepth();
        var deepest = new Dictionary<(int A, int B), double>();
        long left = MostPoints;
        int unseen = 0;
        foreach ((StandingCollider first, StandingCollider second, double tolerated) in Near(StandingCollider.Of(scene), pairs, cancellation))
        {
            cancellation.ThrowIfCancellationRequested();
            left -= Cost(first, second);
            if (left < 0)
            {
                unseen++;
                continue;
            }

            double found = Depth(depth, first, second, tolerated);
            (int A, int B) owners = (first.Owner, second.Owner);
            if (found > tolerated && !(deepest.TryGetValue(owners, out double before) && before >= found))
                deepest[owners] = found;
        }

        IReadOnlyList<GameObject> objects = scene.Document.GameObjects;
        List<Diagnostic> told = deepest
            .OrderByDescending(entry => Math.Round(entry.Value, 9)).ThenBy(entry => entry.Key)
            .Select(entry => Finding(DiagnosticCodes.CollidersOverlap, $"/gameObjects/{Invariant.Text(entry.Key.A)}", ("a", objects[entry.Key.A].Id), ("b", objects[entry.Key.B].Id), ("depth", entry.Value.ToString("g3", CultureInfo.InvariantCulture))))
            .ToList();
        if (unseen > 0)
            told.Add(Finding(DiagnosticCodes.OverlapsNotChecked, "", ("detail", $"{Invariant.Text(unseen)} pairs of close shapes were left out, as the shapes before them have too many points")));
        return new Report(told.ToArray());
    }

    // Those that may collide and whose boxes overlap by more than is tolerated: what stands in a box moves no further to be free than the box itself.
    private static IEnumerable<(StandingCollider First, StandingCollider Second, double Tolerated)> Near(List<StandingCollider> colliders, CollisionPairs pairs, CancellationToken cancellation)
    {
        ConvexShape[] hulls = colliders.Select(collider => collider.Hull).ToArray();
        int[] groups = colliders.Select(collider => pairs.Group(collider.Owner)).ToArray();
        var near = new List<(int First, int Second)>();
        foreach ((int a, int b) in BoxSweep.Pairs(hulls, groups, cancellation))
        {
            if (Reach(hulls[a], hulls[b]) > Tolerated(colliders[a], colliders[b]) && pairs.MayCollide(colliders[a].Owner, colliders[b].Owner))
                near.Add(IgnoredPairs.Pair(a, b));
        }

        foreach ((int a, int b) in near.OrderBy(pair => pair))
            yield return (colliders[a], colliders[b], Tolerated(colliders[a], colliders[b]));
    }

    private static double Tolerated(StandingCollider first, StandingCollider second) => Math.Min(ContactOffset, Share * Math.Min(Size(first.Hull), Size(second.Hull)));

    private static double Depth(ConvexDepth depth, StandingCollider first, StandingCollider second, double tolerated)
    {
        if (first.IsSolid && second.IsSolid)
            return depth.Between(first.Hull, second.Hull);
        (StandingCollider surface, StandingCollider other) = first.IsSolid ? (second, first) : (first, second);
        double deepest = 0;
        for (int i = 0; i < surface.Triangles; i++)
        {
            // Only a body that moves by forces pushes, and what it carries is convex.
            ConvexShape triangle = surface.Triangle(i);
            if (Reach(triangle, other.Hull) > Math.Max(deepest, tolerated))
                deepest = Math.Max(deepest, depth.Between(triangle, other.Hull));
        }

        return deepest;
    }

    private static long Cost(StandingCollider first, StandingCollider second) =>
        (long)Looks * (first.IsSolid && second.IsSolid ? first.Hull.Count + second.Hull.Count : Math.Max(first.Triangles, second.Triangles) * 4L + first.Hull.Count + second.Hull.Count);

    // How far the boxes reach into each other; negative where they are apart.
    private static double Reach(ConvexShape first, ConvexShape second)
    {
        double least = double.PositiveInfinity;
        for (int axis = 0; axis < 3; axis++)
            least = Math.Min(least, Math.Min(first.High[axis] - second.Low[axis], second.High[axis] - first.Low[axis]));
        return least;
    }

    private static double Size(ConvexShape shape)
    {
        Vector3d size = shape.High - shape.Low;
        return Math.Max(size.X, Math.Max(size.Y, size.Z));
    }

    private static Diagnostic Finding(string code, string pointer, params (string Name, string Value)[] values)
    {
        DiagnosticTable.Entry entry = DiagnosticTable.Entries[code];
        return new Diagnostic(code, entry.Severity, DiagnosticTable.Fill(entry.Message, values), DiagnosticTable.Fill(entry.Remedy, values), pointer, null, null);
    }
}
