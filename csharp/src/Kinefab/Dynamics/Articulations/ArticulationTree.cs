using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>
/// An articulation's links and joints, with the state of its joints. Links are numbered so that each stands behind the one above it and
/// whole branches stand together (depth first); link 0 is the root.
/// </summary>
internal sealed class ArticulationTree
{
    /// <summary>Most freedoms of one joint.</summary>
    public const int MostAxes = 3;

    public readonly LinkDefinition[] Links;
    public readonly bool IsFixed;

    /// <summary>-1 for the root.</summary>
    public readonly int[] Parents;

    /// <summary>Index of the last link right below; -1: none.</summary>
    public readonly int[] LastChildren;

    /// <summary>Where a link's freedoms start; one more: their number.</summary>
    public readonly int[] FirstFreedom;

    /// <summary>Of each freedom its axis: 0, 1, 2 for X, Y, Z.</summary>
    public readonly int[] AxisOf;

    /// <summary>Of each freedom the motion that speed 1 gives the link, in the link's own frame.</summary>
    public readonly Twist[] OwnAxes;

    /// <summary>Of each link its frame in that of its joint's anchor.</summary>
    public readonly Pose[] FromAnchors;

    /// <summary>Metres or radians; those of a spherical joint are the rotation vector of its relative rotation, in the anchors' axes.</summary>
    public readonly double[] Positions;

    /// <summary>m/s or rad/s; of a spherical joint the components of the relative angular velocity.</summary>
    public readonly double[] Speeds;

    /// <summary>N or N m, over the next step.</summary>
    public readonly double[] Forces;

    /// <summary>Of each link, its centre of mass and principal axes in the world.</summary>
    public readonly Pose[] Poses;

    /// <summary>Of each link, of its centre of mass.</summary>
    public readonly Twist[] Motions;

    /// <param name="links">In the order of the numbers, see <see cref="DepthFirst"/>.</param>
    /// <param name="root">Where link 0 stands.</param>
    /// <param name="isFixed">Whether link 0 stands still.</param>
    public ArticulationTree(IReadOnlyList<LinkDefinition> links, in Pose root, bool isFixed)
    {
        int n = links.Count;
        IsFixed = isFixed;
        Links = new LinkDefinition[n];
        Parents = new int[n];
        LastChildren = new int[n];
        FirstFreedom = new int[n + 1];
        var axes = new List<int>();
        for (int i = 0; i < n; i++)
        {
            LinkDefinition link = links[i];
            Links[i] = link;
            Parents[i] = link.Parent;
            LastChildren[i] = -1;
            if (i > 0)
            {
                LastChildren[link.Parent] = i;
                for (int axis = 0; axis < MostAxes; axis++)
                {
                    if (HasFreedom(link, axis))
                        axes.Add(axis);
                }
            }

            FirstFreedom[i + 1] = axes.Count;
        }

        AxisOf = axes.ToArray();
        OwnAxes = new Twist[axes.Count];
        Positions = new double[axes.Count];
        Speeds = new double[axes.Count];
        Forces = new double[axes.Count];
        FromAnchors = new Pose[n];
        Poses = new Pose[n];
        Motions = new Twist[n];
        Poses[0] = root;
        for (int i = 1; i < n; i++)
        {
            FromAnchors[i] = links[i].Anchor.Inverse();
            for (int f = FirstFreedom[i]; f < FirstFreedom[i + 1]; f++)
                OwnAxes[f] = OwnAxis(links[i], AxisOf[f]);
        }
    }

    public int Count => Links.Length;

    public int Freedoms => AxisOf.Length;

    public ref LinkAxis AxisOfFreedom(int link, int freedom) => ref Links[link].Axes[AxisOf[freedom]];

    /// <summary>Old numbers in the order in which whole branches stand together; children in the order that they have.</summary>
    public static int[] DepthFirst(IReadOnlyList<int> parents)
    {
        int n = parents.Count;
        var children = new List<int>[n];
        var stack = new Stack<int>();
        for (int i = n - 1; i >= 0; i--)
        {
            if (parents[i] < 0)
                stack.Push(i);
            else
                (children[parents[i]] ??= new List<int>()).Add(i);
        }

        var order = new List<int>(n);
        while (stack.Count > 0)
        {
            int link = stack.Pop();
            order.Add(link);
            foreach (int child in children[link] ?? new List<int>())
                stack.Push(child);
        }

        return order.ToArray();
    }

    private static bool HasFreedom(LinkDefinition link, int axis) => link.Joint switch
    {
        LinkJointKind.Fixed => false,
        LinkJointKind.Spherical => link.Axes[axis].Motion != LinkMotion.Locked,
        _ => axis == 0,
    };

    private static Twist OwnAxis(LinkDefinition link, int axis)
    {
        Vector3d u = link.Anchor.Rotation * (axis == 0 ? Vector3d.UnitX : axis == 1 ? Vector3d.UnitY : Vector3d.UnitZ);
        return link.Joint == LinkJointKind.Prismatic
            ? new Twist(Vector3d.Zero, u)
            : new Twist(u, Vector3d.Cross(u, -link.Anchor.Position));
    }
}
