using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Freedoms of a body, or of a leg of bodies between two others, that move nothing else: a rod's spin between its balls. In a
/// single loop: of bodies that turn in it as one.
/// </summary>
internal static class IdleFreedoms
{
    private const double LeastMotion = 1e-6;

    /// <summary>
    /// Of the velocities at one pose, loop by loop; a free end of a chain is no loop, and not idle. Where these are more than
    /// the <paramref name="finite"/> motions, those some steps away are looked at: there no part seems to move alone that cannot.
    /// </summary>
    public static List<IdleFreedom> Of(Mechanism mechanism, VelocitySpace here, VelocitySpace away, int[] finite)
    {
        var idle = new List<IdleFreedom>();
        DisjointSets rigid = RigidGroups(mechanism);
        Dictionary<int, SortedSet<int>> neighbours = Neighbours(mechanism, rigid);
        for (int block = 0; block < finite.Length; block++)
        {
            VelocitySpace space = here.Blocks.Columns[block].Count - here.Ranks[block] == finite[block] ? here : away;
            if (space.Blocks.Columns[block].Count - space.Ranks[block] != finite[block])
            {
                continue;
            }

            var motions = new List<double[]>();
            foreach ((int of, double[] vector) in space.Basis)
            {
                if (of == block)
                {
                    motions.Add(vector);
                }
            }

            List<int> groups = GroupsOf(mechanism, space, rigid, block);
            if (motions.Count < 2 || groups.Count < 2)
            {
                continue;
            }

            List<List<int>> legs = Legs(groups, neighbours);
            if (legs.Count == 1)
            {
                foreach ((List<int> turning, int count) in SingleLoop.TurningAlone(mechanism, groups, neighbours, motions, space))
                {
                    idle.Add(new IdleFreedom(GameObjects(mechanism, rigid, turning), count));
                }

                continue;
            }

            foreach (List<int> leg in legs)
            {
                int count = motions.Count - RankWithout(leg, groups, motions, space);
                if (count > 0)
                {
                    idle.Add(new IdleFreedom(GameObjects(mechanism, rigid, leg), count));
                }
            }
        }

        return idle;
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
        foreach (Joints.Joint joint in mechanism.Joints)
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

    private static List<int> GroupsOf(Mechanism mechanism, VelocitySpace space, DisjointSets rigid, int block)
    {
        var groups = new List<int>();
        foreach (int body in mechanism.Tree.Order)
        {
            if (mechanism.Tree.Freedoms[body] > 0 && space.BlockOf(body) == block)
            {
                groups.Add(rigid.Find(body));
            }
        }

        groups.Sort();
        return groups;
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
    private static int RankWithout(List<int> leg, List<int> groups, List<double[]> motions, VelocitySpace space)
    {
        var twists = new double[6 * (groups.Count - leg.Count), motions.Count];
        int row = 0;
        foreach (int group in groups)
        {
            if (leg.Contains(group))
            {
                continue;
            }

            for (int m = 0; m < motions.Count; m++)
            {
                space.Twist(group, motions[m], out Vector3d linear, out Vector3d angular);
                for (int i = 0; i < 3; i++)
                {
                    twists[row + i, m] = linear[i];
                    twists[row + 3 + i, m] = angular[i];
                }
            }

            row += 6;
        }

        int rank = 0;
        foreach (double value in new SingularValues(twists).Values)
        {
            rank += value > LeastMotion ? 1 : 0;
        }

        return rank;
    }

    private static List<int> GameObjects(Mechanism mechanism, DisjointSets rigid, List<int> leg)
    {
        var objects = new List<int>();
        foreach (int body in mechanism.Tree.Order)
        {
            if (leg.Contains(rigid.Find(body)))
            {
                objects.Add(mechanism.GameObjects[body]);
            }
        }

        objects.Sort();
        return objects;
    }
}
