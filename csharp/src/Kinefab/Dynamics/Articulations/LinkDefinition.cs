using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>How a link may move against the one above it (PxArticulationJointType).</summary>
internal enum LinkJointKind
{
    Fixed,

    /// <summary>Along X of the anchors.</summary>
    Prismatic,

    /// <summary>About X of the anchors.</summary>
    Revolute,

    /// <summary>About those of X, Y, Z of the child's anchor that are not locked.</summary>
    Spherical,
}

/// <summary>Whether one axis of a link's joint moves.</summary>
internal enum LinkMotion
{
    Locked,
    Limited,
    Free,
}

/// <summary>A limit and a drive of one axis; metres or radians, newtons or newton metres.</summary>
internal struct LinkAxis
{
    public LinkMotion Motion;
    public double Lower;
    public double Upper;

    /// <summary>Per m or rad of gap to the target; with IsAcceleration per unit of the inertia that the axis sees.</summary>
    public double Stiffness;
    public double Damping;
    public double ForceLimit;
    public bool IsAcceleration;
    public double Target;
    public double TargetSpeed;

    public readonly bool HasDrive => ForceLimit > 0 && (Stiffness > 0 || Damping > 0);
}

/// <summary>A link and the joint to the one above it; the link's frame is its centre of mass and principal axes.</summary>
internal sealed class LinkDefinition
{
    /// <summary>Index of the link above, which stands before this one; -1: the root.</summary>
    public int Parent { get; set; } = -1;

    public double Mass { get; set; } = 1;

    /// <summary>Principal moments, kg m^2.</summary>
    public Vector3d Inertia { get; set; } = new(1, 1, 1);

    /// <summary>1/s.</summary>
    public double LinearDamping { get; set; }
    public double AngularDamping { get; set; }
    public bool UseGravity { get; set; } = true;

    /// <summary>Of the link against the world, rad/s.</summary>
    public double MaxAngularSpeed { get; set; } = double.PositiveInfinity;

    public LinkJointKind Joint { get; set; }

    /// <summary>The joint's frame in the parent's and in the link's own frame.</summary>
    public Pose ParentAnchor { get; set; } = Pose.Identity;
    public Pose Anchor { get; set; } = Pose.Identity;

    /// <summary>Of X, and of a spherical joint about X, Y and Z.</summary>
    public readonly LinkAxis[] Axes = new LinkAxis[3];

    /// <summary>Friction of every axis as a share of what the joint transmits (a coefficient; force and torque are taken together, in N and N m).</summary>
    public double Friction { get; set; }

    /// <summary>Of every axis, m/s or rad/s.</summary>
    public double MaxJointSpeed { get; set; } = double.PositiveInfinity;
}
