using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>Poses and motions of the links from those of the root and the joints.</summary>
internal static class TreeKinematics
{
    /// <summary>The root's pose stays; spherical joints turn by the rotation vector that their positions are.</summary>
    public static void Place(ArticulationTree tree)
    {
        for (int i = 1; i < tree.Count; i++)
            tree.Poses[i] = Place(tree, i, Relative(tree, i));
    }

    /// <summary>Joint frame in the child against that in the parent: what the joint's positions say.</summary>
    public static Pose Relative(ArticulationTree tree, int link)
    {
        int f = tree.FirstFreedom[link];
        switch (tree.Links[link].Joint)
        {
            case LinkJointKind.Prismatic:
                return new Pose(new Vector3d(tree.Positions[f], 0, 0), Quaterniond.Identity);
            case LinkJointKind.Revolute:
                return new Pose(Vector3d.Zero, Quaterniond.AxisAngle(Vector3d.UnitX, tree.Positions[f]));
            case LinkJointKind.Spherical:
                Vector3d turn = Vector3d.Zero;
                for (; f < tree.FirstFreedom[link + 1]; f++)
                    turn += Along(tree.AxisOf[f], tree.Positions[f]);
                return new Pose(Vector3d.Zero, Turn(turn));
            default:
                return Pose.Identity;
        }
    }

    /// <summary>A link's pose from its parent's and the joint's: F0 c F1^-1.</summary>
    public static Pose Place(ArticulationTree tree, int link, in Pose relative)
    {
        Pose pose = tree.Poses[tree.Parents[link]] * tree.Links[link].ParentAnchor * relative * tree.FromAnchors[link];
        return new Pose(pose.Position, pose.Rotation.Normalized());
    }

    /// <summary>The joint's rotation, child against parent.</summary>
    public static Quaterniond RelativeRotation(ArticulationTree tree, int link)
    {
        LinkDefinition definition = tree.Links[link];
        Quaterniond q = (tree.Poses[tree.Parents[link]].Rotation * definition.ParentAnchor.Rotation).Conjugate() * (tree.Poses[link].Rotation * definition.Anchor.Rotation);
        return q.W < 0 ? new Quaterniond(-q.X, -q.Y, -q.Z, -q.W) : q;
    }

    /// <summary>Writes a spherical joint's positions from its links' poses.</summary>
    public static void ReadSpherical(ArticulationTree tree, int link)
    {
        Vector3d turn = RotationVector(RelativeRotation(tree, link));
        for (int f = tree.FirstFreedom[link]; f < tree.FirstFreedom[link + 1]; f++)
            tree.Positions[f] = turn[tree.AxisOf[f]];
    }

    /// <summary>Positions and speeds of all joints from the links' poses and motions.</summary>
    public static void Read(ArticulationTree tree)
    {
        for (int i = 1; i < tree.Count; i++)
        {
            int first = tree.FirstFreedom[i];
            if (tree.Links[i].Joint == LinkJointKind.Spherical)
                ReadSpherical(tree, i);
            else if (tree.FirstFreedom[i + 1] > first)
                tree.Positions[first] = ReadPosition(tree, i, tree.Positions[first]);
            Twist relative = tree.Motions[i] - tree.Motions[tree.Parents[i]].At(tree.Poses[i].Position - tree.Poses[tree.Parents[i]].Position);
            for (int f = first; f < tree.FirstFreedom[i + 1]; f++)
            {
                Twist axis = Turned(tree.Poses[i].Rotation, tree.OwnAxes[f]);
                tree.Speeds[f] = tree.Links[i].Joint == LinkJointKind.Prismatic ? Vector3d.Dot(axis.Linear, relative.Linear) : Vector3d.Dot(axis.Angular, relative.Angular);
            }
        }
    }

    /// <summary>A slide's or hinge's position from its links' poses; of angles the one nearest to a given one, 0 where that is no number.</summary>
    public static double ReadPosition(ArticulationTree tree, int link, double near)
    {
        LinkDefinition definition = tree.Links[link];
        if (definition.Joint == LinkJointKind.Prismatic)
            return ((tree.Poses[tree.Parents[link]] * definition.ParentAnchor).Inverse() * (tree.Poses[link] * definition.Anchor)).Position.X;
        Quaterniond q = RelativeRotation(tree, link);
        double angle = SwingTwist.TwistAngle(q);
        double nearest = SwingTwist.Nearest(angle, near);
        return Finite.Is(nearest) ? nearest : angle;
    }

    /// <summary>Motions of all links below the root from the joints' speeds.</summary>
    public static void Move(ArticulationTree tree)
    {
        for (int i = 1; i < tree.Count; i++)
        {
            int parent = tree.Parents[i];
            Quaterniond q = tree.Poses[i].Rotation;
            Twist motion = tree.Motions[parent].At(tree.Poses[i].Position - tree.Poses[parent].Position);
            for (int f = tree.FirstFreedom[i]; f < tree.FirstFreedom[i + 1]; f++)
                motion += Turned(q, tree.OwnAxes[f]) * tree.Speeds[f];
            tree.Motions[i] = motion;
        }
    }

    public static Twist Turned(Quaterniond q, in Twist axis) => new(q * axis.Angular, q * axis.Linear);

    /// <summary>exp of half the rotation vector.</summary>
    public static Quaterniond Turn(Vector3d rotation)
    {
        double angle = rotation.Length;
        return angle > 0 ? Quaterniond.AxisAngle(rotation * (1 / angle), angle) : Quaterniond.Identity;
    }

    public static Vector3d RotationVector(Quaterniond q)
    {
        Vector3d v = q.W < 0 ? -q.Vector : q.Vector;
        double s = v.Length;
        return s > 0 ? v * (2 * Trigonometry.Atan2(s, Math.Abs(q.W)) / s) : Vector3d.Zero;
    }

    private static Vector3d Along(int axis, double value) => new(axis == 0 ? value : 0, axis == 1 ? value : 0, axis == 2 ? value : 0);
}
