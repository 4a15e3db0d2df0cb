using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>Where a mechanism stands and how large its links are, so that angles and lengths can be weighed and rounding stays small.</summary>
internal static class MechanismScale
{
    // Places nearer than this, in metres or by their distance from the origin, differ by the rounding of the file.
    private const double SamePlace = 1e-9;

    /// <summary>Mean of the joints' places, world.</summary>
    public static Vector3d Center(JointModel[] joints, Pose[] poses)
    {
        Vector3d sum = Vector3d.Zero;
        foreach (JointModel joint in joints)
        {
            sum += Anchor(joint, poses);
        }

        return joints.Length == 0 ? sum : sum * (1.0 / joints.Length);
    }

    /// <summary>
    /// Root mean square distance of the joints from the middle of the joints of each of their bodies, times 2: about the
    /// length of a link.
    /// </summary>
    /// <param name="joints">Between the bodies.</param>
    /// <param name="poses">Of the bodies.</param>
    /// <param name="otherwise">What it is where no body has two joints at different places.</param>
    public static double LinkLength(JointModel[] joints, Pose[] poses, double otherwise = 1)
    {
        int n = poses.Length;
        var count = new int[n];
        var sum = new Vector3d[n];
        Each((body, anchor) =>
        {
            count[body]++;
            sum[body] += anchor;
        });

        double squares = 0;
        int links = 0;
        Each((body, anchor) =>
        {
            double square = (anchor - sum[body] * (1.0 / count[body])).LengthSquared;
            if (square > SamePlace * SamePlace * Math.Max(1, anchor.LengthSquared))
            {
                squares += square;
                links++;
            }
        });
        return links == 0 ? otherwise : 2 * Math.Sqrt(squares / links);

        void Each(Action<int, Vector3d> visit)
        {
            foreach (JointModel joint in joints)
            {
                Vector3d anchor = Anchor(joint, poses);
                if (joint.Body0 >= 0)
                {
                    visit(joint.Body0, anchor);
                }

                if (joint.Body1 >= 0)
                {
                    visit(joint.Body1, anchor);
                }
            }
        }
    }

    /// <summary>The same of a linkage, in its mechanism's lengths, and no more than 1.</summary>
    public static double LinkShare(Linkage linkage, Pose[] poses) => Math.Min(1, LinkLength(linkage.Joints, poses, linkage.Length) / linkage.Length);

    /// <summary>How far links in line turn that close a gap g: with the length l of a link by about the root of 2 g / l.</summary>
    /// <param name="gap">In the mechanism's lengths or radians.</param>
    /// <param name="linkShare">See <see cref="LinkShare"/>.</param>
    public static double Turned(double gap, double linkShare) => Math.Sqrt(2 * gap / linkShare);

    /// <summary>Where the joint that carries a body holds it, or its own origin where none does; world.</summary>
    public static Vector3d Place(Linkage linkage, int body, Pose[] poses)
    {
        int joint = linkage.Tree.TreeJoints[body];
        return joint < 0 ? poses[body].Position : Anchor(linkage.Joints[joint], poses);
    }

    private static Vector3d Anchor(JointModel joint, Pose[] poses) =>
        Linkage.PoseOf(joint.Body1, poses).Point(joint.Frame1.Position);
}
