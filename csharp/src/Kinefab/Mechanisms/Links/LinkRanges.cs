using Kinefab.Document;

namespace Kinefab.Mechanisms;

/// <summary>Ranges that a link holds and no ConfigurableJoint does, which the exporter leaves in the joint's extras.</summary>
internal static class LinkRanges
{
    // Degrees to either side within which PhysX holds the range of a link's hinge.
    private const double MostTurn = 360;

    /// <summary>The link with the ranges; what was told as lost is no longer.</summary>
    internal static ArticulationBody Widened(ArticulationBody link, Joint joint, bool onChild, string name, ToldLosses told)
    {
        if (link.JointType == ArticulationJointType.Revolute && JointExtras.Range(joint, "angularXRange") is (double low, double high) && -MostTurn <= low && high <= MostTurn)
        {
            told.IsKept($"joint {name}", "JOINT_LIMIT_BEYOND_TURN");
            if (joint is not ConfigurableJoint twisted)
                return link;
            (double from, double to) = Sorted(low, high, twisted.SwapBodies ? 1 : -1);
            return link with { TwistLock = ConfigurableJointMotion.Limited, XDrive = link.XDrive with { LowerLimit = from, UpperLimit = to } };
        }

        // Where the component counts the other way round, the twist turns its swings into each other.
        if (link.JointType != ArticulationJointType.Spherical || joint is not ConfigurableJoint ball || ball.SwapBodies != onChild)
            return link;

        // Of a component on the parent the link's frame is turned round about Y.
        link = link with { YDrive = Swung(link.YDrive, JointExtras.Range(joint, "angularYRange"), 1), ZDrive = Swung(link.ZDrive, JointExtras.Range(joint, "angularZRange"), onChild ? 1 : -1) };
        told.IsKept($"joint {name}", "JOINT_LIMIT_ASYMMETRIC");
        told.IsKept($"joint {name}", "JOINT_LIMIT_ELEVATION");
        return link;
    }

    private static ArticulationDrive Swung(ArticulationDrive drive, (double Low, double High)? range, double sense)
    {
        if (range is not (double low, double high))
            return drive;
        (double from, double to) = Sorted(low, high, sense);
        return drive with { LowerLimit = from, UpperLimit = to };
    }

    private static (double From, double To) Sorted(double low, double high, double sense) =>
        sense * low <= sense * high ? (sense * low, sense * high) : (sense * high, sense * low);
}
