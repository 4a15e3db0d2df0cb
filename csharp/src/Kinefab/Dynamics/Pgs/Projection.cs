using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>Snaps bodies back after the step along joints that ask for it, from the fixed side outwards.</summary>
internal static class Projection
{
    public static void Apply(Mechanism mechanism)
    {
        Bodies bodies = mechanism.Bodies;
        foreach (Joint joint in mechanism.Joints)
        {
            if (!joint.Projection || joint.IsBroken)
            {
                continue;
            }

            bool fixed0 = joint.Body0 < 0 || bodies.IsKinematic[joint.Body0];
            bool fixed1 = joint.Body1 < 0 || bodies.IsKinematic[joint.Body1];
            if (fixed0 && fixed1)
            {
                continue;
            }

            Pose pose0 = bodies.PoseOf(joint.Body0);
            Pose pose1 = bodies.PoseOf(joint.Body1);
            bool moveBody1 = fixed0 || !fixed1;
            if (!joint.Project(ref pose0, ref pose1, moveBody1))
            {
                continue;
            }

            if (moveBody1)
            {
                bodies.Poses[joint.Body1] = pose1;
            }
            else
            {
                bodies.Poses[joint.Body0] = pose0;
            }
        }
    }
}
