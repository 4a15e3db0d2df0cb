using System;
using System.Collections.Generic;
using Kinefab.Joints;

namespace Kinefab.Kinematics;

/// <summary>
/// A spanning tree of the bodies over the joints, rooted at the ground. A tree joint's equations are solved by moving its
/// child along the joint's freedoms, so that only the joints left over, which close loops, need equations between unknowns.
/// </summary>
internal sealed class KinematicTree
{
    /// <summary>Stands for what never moves: the world and the kinematic bodies.</summary>
    public const int Ground = -1;

    /// <summary>Moving bodies, each after the body that carries it.</summary>
    public readonly int[] Order;

    /// <summary>For each body the body that carries it, or Ground.</summary>
    public readonly int[] Parents;

    /// <summary>For each body the joint to its parent, or -1: a body that hangs on nothing is free in space.</summary>
    public readonly int[] TreeJoints;

    /// <summary>For each body whether its tree joint's body 0 is the child.</summary>
    public readonly bool[] ChildIsBody0;

    /// <summary>For each body the number of bodies between it and the ground.</summary>
    public readonly int[] Depths;

    /// <summary>For each body its freedoms against its parent.</summary>
    public readonly int[] Freedoms;

    /// <summary>For each joint the body whose tree joint it is, or -1 for a loop-closing joint.</summary>
    public readonly int[] ChildOf;

    /// <summary>Joints that close loops.</summary>
    public readonly int[] Closures;

    private readonly bool[] _isFixed;

    /// <summary>Builds the tree: joints that are not marked as closures first, then those near the ground, then the stiffer ones.</summary>
    /// <param name="isFixed">For each body whether it never moves.</param>
    /// <param name="joints">Joints; World and fixed bodies are the ground.</param>
    /// <param name="isClosure">For each joint whether the exporter takes it for a loop's closing one.</param>
    public KinematicTree(bool[] isFixed, JointModel[] joints, bool[] isClosure)
    {
        int n = isFixed.Length;
        _isFixed = isFixed;
        Depths = new int[n];
        Parents = new int[n];
        TreeJoints = new int[n];
        ChildIsBody0 = new bool[n];
        Freedoms = new int[n];
        ChildOf = new int[joints.Length];
        Array.Fill(ChildOf, -1);
        Array.Fill(Parents, Ground);
        Array.Fill(TreeJoints, -1);

        var at = new List<int>[n];
        for (int i = 0; i < n; i++)
        {
            at[i] = new List<int>();
        }

        var queue = new SortedSet<(bool Closure, int Depth, int Freedoms, int Joint)>();
        for (int j = 0; j < joints.Length; j++)
        {
            int a = Moving(joints[j].Body0);
            int b = Moving(joints[j].Body1);
            if (a >= 0)
            {
                at[a].Add(j);
            }

            if (b >= 0)
            {
                at[b].Add(j);
            }

            if (a < 0 != b < 0)
            {
                queue.Add((isClosure[j], 0, MotionSubspace.Count(MotionSubspace.LockedAxes(joints[j])), j));
            }
        }

        var order = new List<int>(n);
        var reached = new bool[n];
        for (int root = 0; ; root++)
        {
            while (queue.Count > 0)
            {
                (bool Closure, int Depth, int Freedoms, int Joint) next = queue.Min;
                queue.Remove(next);
                int a = Moving(joints[next.Joint].Body0);
                int b = Moving(joints[next.Joint].Body1);
                bool aIsNew = a >= 0 && !reached[a];
                if (aIsNew || (b >= 0 && !reached[b]))
                {
                    Reach(aIsNew ? a : b, aIsNew ? b : a, next.Joint, next.Freedoms);
                }
            }

            while (root < n && (isFixed[root] || reached[root]))
            {
                root++;
            }

            if (root >= n)
            {
                break;
            }

            Reach(root, Ground, -1, 6);
        }

        Order = order.ToArray();
        var closures = new List<int>();
        for (int j = 0; j < joints.Length; j++)
        {
            if (ChildOf[j] < 0 && (Moving(joints[j].Body0) >= 0 || Moving(joints[j].Body1) >= 0))
            {
                closures.Add(j);
            }
        }

        Closures = closures.ToArray();

        void Reach(int body, int parent, int joint, int freedoms)
        {
            reached[body] = true;
            order.Add(body);
            Parents[body] = parent;
            TreeJoints[body] = joint;
            Freedoms[body] = freedoms;
            Depths[body] = parent < 0 ? 0 : Depths[parent] + 1;
            if (joint >= 0)
            {
                ChildOf[joint] = body;
                ChildIsBody0[body] = Moving(joints[joint].Body0) == body;
            }

            foreach (int j in at[body])
            {
                if (ChildOf[j] < 0)
                {
                    queue.Add((isClosure[j], Depths[body] + 1, MotionSubspace.Count(MotionSubspace.LockedAxes(joints[j])), j));
                }
            }
        }
    }

    /// <summary>The body itself, or Ground for the world and for bodies that never move.</summary>
    public int Moving(int body) => body < 0 || _isFixed[body] ? Ground : body;

    /// <summary>
    /// Bodies whose tree freedoms move <paramref name="a"/> against <paramref name="b"/>: +1 for those under a, -1 for those
    /// under b, down to where the two branches meet. Bodies without freedoms are left out.
    /// </summary>
    public void Between(int a, int b, List<int> bodies, List<double> signs)
    {
        a = Moving(a);
        b = Moving(b);
        while (a != b)
        {
            if (b < 0 || (a >= 0 && Depths[a] >= Depths[b]))
            {
                Add(a, 1);
                a = Parents[a];
            }
            else
            {
                Add(b, -1);
                b = Parents[b];
            }
        }

        void Add(int body, double sign)
        {
            if (Freedoms[body] > 0)
            {
                bodies.Add(body);
                signs.Add(sign);
            }
        }
    }
}
