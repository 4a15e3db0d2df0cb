using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Freedoms of a body, or of a leg of bodies between two others, that move nothing else, which are its motions while all others stand
/// still: a rod's spin between its two balls. In a single loop: of bodies that turn in it as one.
/// </summary>
internal sealed class IdleFreedoms
{
    private const double LeastMotion = 1e-6;

    private readonly Mechanism _mechanism;
    private readonly IndependentLinkages _parts;
    private readonly DisjointSets _rigid;
    private readonly Dictionary<int, SortedSet<int>> _neighbours;
    private readonly Dictionary<int, List<int>> _members = new();

    /// <summary>Finds which bodies of a mechanism stand beside which.</summary>
    public IdleFreedoms(Mechanism mechanism, IndependentLinkages parts)
    {
        _mechanism = mechanism;
        _parts = parts;
        _rigid = RigidGroups(mechanism);
        _neighbours = Neighbours(mechanism, _rigid);
        foreach (int body in mechanism.Tree.Order)
        {
            int group = _rigid.Find(body);
            if (!_members.TryGetValue(group, out List<int>? members))
            {
                _members.Add(group, members = new List<int>());
            }

            members.Add(body);
        }
    }

    /// <summary>Of one block's velocities; a free end of a chain is no loop, and not idle.</summary>
    /// <param name="loop">What the block can do.</param>
    /// <param name="movers">The bodies that have freedoms in it.</param>
    /// <param name="closed">The pose that it was counted at.</param>
    /// <param name="cancellation">Ends the counting early, with an OperationCanceledException.</param>
    public IEnumerable<IdleFreedom> Of(LoopMobility loop, IReadOnlyList<int> movers, MechanismState closed, CancellationToken cancellation)
    {
        if (loop.Finite < 2 || movers.Count < 2)
        {
            yield break;
        }

        var velocities = new LoopMotions(loop, loop.Here, movers, _rigid);
        List<List<int>> legs = Legs(velocities.Groups, _neighbours);
        if (legs.Count == 1)
        {
            if (loop.Motions is null)
            {
                yield break;
            }

            foreach ((List<int> turning, int count) in SingleLoop.TurningAlone(new LoopMotions(loop, loop.Motions, movers, _rigid), _neighbours))
            {
                // What hangs on them may have to move along.
                int alone = HasOthersBeside(turning, velocities.Groups) ? Math.Min(count, Alone(turning, closed, cancellation)) : count;
                if (alone > 0)
                {
                    yield return new IdleFreedom(GameObjects(turning), alone);
                }
            }

            yield break;
        }

        foreach (List<int> leg in legs)
        {
            // What moves by itself seems to from the first; whether it does is asked with all else held.
            int count = velocities.Count > RankWithout(leg, velocities) ? Alone(leg, closed, cancellation) : 0;
            if (count > 0)
            {
                yield return new IdleFreedom(GameObjects(leg), count);
            }
        }
    }

    // Freedoms of finite motion of some groups while all others stand still.
    private int Alone(List<int> leg, MechanismState closed, CancellationToken cancellation)
    {
        var moving = new HashSet<int>();
        foreach (int group in leg)
        {
            moving.UnionWith(_members[group]);
        }

        return new LoopMobility(_parts.Alone(moving), closed, cancellation).Finite;
    }

    // Whether anything stands beside some groups of a loop that is neither in the loop nor where it begins and ends.
    private bool HasOthersBeside(List<int> some, List<int> loop)
    {
        var inside = new HashSet<int>(loop);
        int? root = SingleLoop.Root(loop, _neighbours);
        return some.Exists(group => _neighbours[group].Any(other => other != root && !inside.Contains(other)));
    }

    // Bodies that a tree joint without freedoms holds to their parent are one.
    private static DisjointSets RigidGroups(Mechanism mechanism)
    {
        var rigid = new DisjointSets(mechanism.BodyCount);
        foreach (int body in mechanism.Tree.Order)
        {
            if (mechanism.Tree.Freedoms[body] == 0 && mechanism.Tree.Parents[body] >= 0)
            {
                rigid.Join(body, mechanism.Tree.Parents[body]);
            }
        }

        return rigid;
    }

    private static Dictionary<int, SortedSet<int>> Neighbours(Mechanism mechanism, DisjointSets rigid)
    {
        var neighbours = new Dictionary<int, SortedSet<int>>();
        foreach (Joints.JointModel joint in mechanism.Joints)
        {
            int a = Group(joint.Body0);
            int b = Group(joint.Body1);
            if (a != b)
            {
                Beside(a).Add(b);
                Beside(b).Add(a);
            }
        }

        return neighbours;

        int Group(int body) => mechanism.Tree.Moving(body) < 0 ? KinematicTree.Ground : rigid.Find(body);

        SortedSet<int> Beside(int group)
        {
            if (!neighbours.TryGetValue(group, out SortedSet<int>? beside))
            {
                neighbours.Add(group, beside = new SortedSet<int>());
            }

            return beside;
        }
    }

    // Chains of groups with two neighbours each, as long as they go; other groups by themselves.
    private static List<List<int>> Legs(List<int> groups, Dictionary<int, SortedSet<int>> neighbours)
    {
        var inside = new HashSet<int>(groups);
        var seen = new HashSet<int>();
        var legs = new List<List<int>>();
        foreach (int group in groups)
        {
            if (!seen.Add(group))
            {
                continue;
            }

            var leg = new List<int> { group };
            foreach (int start in neighbours[group].Count == 2 ? neighbours[group] : new SortedSet<int>())
            {
                int next = start;
                while (inside.Contains(next) && neighbours[next].Count == 2 && seen.Add(next))
                {
                    leg.Add(next);
                    foreach (int after in neighbours[next])
                    {
                        next = seen.Contains(after) ? next : after;
                    }
                }
            }

            legs.Add(leg);
        }

        return legs;
    }

    // Rank of the motions as all groups but the leg's show them.
    private static int RankWithout(List<int> leg, LoopMotions motions)
    {
        var twists = new double[6 * (motions.Groups.Count - leg.Count), motions.Count];
        int row = 0;
        foreach (int group in motions.Groups)
        {
            if (leg.Contains(group))
            {
                continue;
            }

            for (int m = 0; m < motions.Count; m++)
            {
                motions.Twist(group, m, out Vector3d linear, out Vector3d angular);
                for (int i = 0; i < 3; i++)
                {
                    twists[row + i, m] = linear[i];
                    twists[row + 3 + i, m] = angular[i];
                }
            }

            row += 6;
        }

        return new SingularValues(twists).Rank(Math.Max(LeastMotion, motions.Noise));
    }

    private List<int> GameObjects(List<int> leg)
    {
        var objects = new List<int>();
        foreach (int group in leg)
        {
            foreach (int body in _members[group])
            {
                objects.Add(_mechanism.GameObjects[body]);
            }
        }

        objects.Sort();
        return objects;
    }
}
