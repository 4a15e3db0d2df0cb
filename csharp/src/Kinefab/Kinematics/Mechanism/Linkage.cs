using System.Threading;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Bodies, joints and couplings at position level and a spanning tree over them: what the equations are made of, by indices
/// alone. A whole mechanism's, or that of a part of it by itself. Never changes.
/// </summary>
internal sealed class Linkage
{
    private MechanismRows? _rows;

    /// <summary>Hangs the bodies on a tree.</summary>
    /// <param name="isFixed">For each body whether it never moves.</param>
    /// <param name="joints">Between these bodies and the world.</param>
    /// <param name="isClosure">For each joint whether it is better left out of the tree.</param>
    /// <param name="coordinates">Of these joints.</param>
    /// <param name="couplings">Of these coordinates.</param>
    /// <param name="origin">See <see cref="Origin"/>.</param>
    /// <param name="length">See <see cref="Length"/>.</param>
    public Linkage(bool[] isFixed, JointModel[] joints, bool[] isClosure, MechanismCoordinate[] coordinates, PositionCoupling[] couplings, Vector3d origin, double length)
    {
        BodyCount = isFixed.Length;
        Joints = joints;
        Coordinates = coordinates;
        Couplings = couplings;
        Origin = origin;
        Length = length;
        IsCoupledAmongOthers = new bool[coordinates.Length];
        foreach (PositionCoupling coupling in couplings)
        {
            IsCoupledAmongOthers[coupling.Driven] = coordinates[coupling.Driven].IsAngleAmongOthers;
            foreach (int term in coupling.Terms)
            {
                IsCoupledAmongOthers[term] = coordinates[term].IsAngleAmongOthers;
            }
        }

        Tree = new KinematicTree(isFixed, joints, isClosure);
    }

    public int BodyCount { get; }

    public JointModel[] Joints { get; }

    public MechanismCoordinate[] Coordinates { get; }

    public PositionCoupling[] Couplings { get; }

    /// <summary>For each coordinate whether it is coupled and an <see cref="CoordinateCoupling.AngleAmongOthers"/>.</summary>
    public bool[] IsCoupledAmongOthers { get; }

    public KinematicTree Tree { get; }

    /// <summary>Which bodies each joint, coupling and coordinate depends on.</summary>
    public MechanismRows Rows => FindRows(default);

    /// <summary>Point that twists are referred to, world.</summary>
    public Vector3d Origin { get; }

    /// <summary>Typical distance of a body's joints, metres: what a radian weighs against.</summary>
    public double Length { get; }

    /// <summary>
    /// Finds <see cref="Rows"/> where nobody has asked for them yet. A loop's depend on all of its bodies, so that those of a grid of n joints are n^1.5
    /// numbers, which whoever only places bodies does without.
    /// </summary>
    /// <param name="cancellation">Ends it early, with an OperationCanceledException.</param>
    public MechanismRows FindRows(CancellationToken cancellation) => _rows ??= new MechanismRows(Tree, Joints, Coordinates, Couplings, cancellation);

    /// <summary>A body's pose; the identity for the world.</summary>
    public static Pose PoseOf(int body, Pose[] poses) => body < 0 ? Pose.Identity : poses[body];
}
