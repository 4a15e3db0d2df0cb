using System;
using System.Collections;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Collisions;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Collisions;

/// <summary>What of many objects is looked at, and that it gives the answers of a look at all.</summary>
public sealed class CollisionPairsTests
{
    [Test]
    public void MayCollide_RandomTrees_IsWhatAClimbFinds([Range(1, 60)] int seed)
    {
        var random = new Random(seed);
        int count = random.Next(2, 30);
        var objects = new GameObject[count];
        for (int i = 0; i < count; i++)
        {
            int? parent = i == 0 || random.Next(6) == 0 ? null : random.Next(Math.Max(0, i - 4), i);
            objects[i] = Object(i, parent, random.Next(4) == 0);
        }

        // Of most pairs none, since a rule that names the top of a tree covers all of it.
        var rules = Enumerable.Range(0, random.Next(1, 12))
            .Select(_ => (A: random.Next(count), B: random.Next(count)))
            .Where(pair => pair.A != pair.B)
            .Select(pair => new IgnoredCollision { A = pair.A, B = pair.B })
            .DistinctBy(rule => (Math.Min(rule.A, rule.B), Math.Max(rule.A, rule.B)))
            .ToArray();
        ValidScene scene = Scene(objects, rules);
        var pairs = new CollisionPairs(scene);
        for (int a = 0; a < count; a++)
        {
            for (int b = 0; b < count; b++)
            {
                bool isIgnored = rules.Any(rule => (IsOver(rule.A, a) && IsOver(rule.B, b)) || (IsOver(rule.A, b) && IsOver(rule.B, a)));
                Assert.That(pairs.MayCollide(a, b), Is.EqualTo(scene.BodyOf(a) != scene.BodyOf(b) && !isIgnored), $"{a} and {b}");
            }
        }

        bool IsOver(int above, int below) => above == below || (scene.BodyOf(below) != below && objects[below].Parent is int parent && IsOver(above, parent));
    }

    // Each pair had all objects above the one looked up with all above the other: 10^12 look-ups here.
    [Test]
    public void MayCollide_DeepTreesWithRulesAtTheirEnds_IsLookedUpWithoutAClimb()
    {
        const int Depth = 16_000;
        GameObject[] objects = Enumerable.Range(0, 2 * Depth).Select(i => Object(i, i % Depth == 0 ? null : i - 1, i % Depth == 0)).ToArray();
        IgnoredCollision[] rules = Enumerable.Range(Depth / 2, Depth / 2).Select(i => new IgnoredCollision { A = i, B = Depth + i }).ToArray();
        var pairs = new CollisionPairs(Scene(objects, rules));

        // The rule of the middle names all that is below the middle of both.
        Assert.That(Enumerable.Range(0, Depth).Count(i => pairs.MayCollide(i, Depth + i)), Is.EqualTo(Depth / 2));
        Assert.That(Enumerable.Range(0, Depth).Count(i => pairs.MayCollide(2 * Depth - 1, i)), Is.EqualTo(Depth / 2));
    }

    [Test]
    public void BoxSweep_RandomShapes_FindsThoseOfOtherGroupsThatMeetAlongX([Range(1, 20)] int seed)
    {
        var random = new Random(seed);
        ConvexShape[] shapes = Enumerable.Range(0, 60).Select(_ => Ball(10 * random.NextDouble(), random.NextDouble())).ToArray();
        int[] groups = shapes.Select(_ => random.Next(-1, 3)).ToArray();
        IEnumerable<(int, int)> expected = from a in Enumerable.Range(0, shapes.Length)
                                           from b in Enumerable.Range(a + 1, shapes.Length - a - 1)
                                           where groups[a] != groups[b] && shapes[a].Low.X <= shapes[b].High.X && shapes[b].Low.X <= shapes[a].High.X
                                           select (a, b);
        Assert.That(BoxSweep.Pairs(shapes, groups, default).Select(pair => IgnoredPairs.Pair(pair.First, pair.Second)), Is.EquivalentTo(expected));
    }

    // All pairs of them were: colliders of a body that lie across each other cost the square of their number.
    [Test]
    public void BoxSweep_OneGroupBesideAFewOthers_LooksAtEachAFewTimes()
    {
        const int Count = 20_000;
        var shapes = new CountingList(Enumerable.Range(0, Count + 2).Select(i => Ball(1e-6 * i, 1)).ToArray());
        int[] groups = Enumerable.Repeat(7, Count).Append(8).Append(9).ToArray();
        Assert.That(BoxSweep.Pairs(shapes, groups, CancellationToken.None).Count(), Is.EqualTo(2 * Count + 1));
        Assert.That(shapes.Looks, Is.LessThan(8 * Count));
    }

    private static ConvexShape Ball(double x, double radius) => new(new[] { new Vector3d(x, 0, 0) }, radius);

    private static GameObject Object(int index, int? parent, bool isBody) => new()
    {
        Id = $"o{index}",
        Name = $"o{index}",
        Parent = parent,
        Components = isBody ? [new Rigidbody { InertiaTensor = new Vector3d(1, 1, 1) }] : [],
    };

    private static ValidScene Scene(GameObject[] objects, IgnoredCollision[] rules)
    {
        SceneValidation validation = SceneValidator.Validate(new SceneDocument { GameObjects = objects, IgnoredCollisions = rules });
        Assert.That(validation.Scene, Is.Not.Null, string.Join("\n", validation.Report.Diagnostics));
        return validation.Scene!;
    }

    private sealed class CountingList(ConvexShape[] shapes) : IReadOnlyList<ConvexShape>
    {
        public int Looks { get; private set; }

        public int Count => shapes.Length;

        public ConvexShape this[int index]
        {
            get
            {
                Looks++;
                return shapes[index];
            }
        }

        public IEnumerator<ConvexShape> GetEnumerator() => throw new NotSupportedException();

        IEnumerator IEnumerable.GetEnumerator() => GetEnumerator();
    }
}
