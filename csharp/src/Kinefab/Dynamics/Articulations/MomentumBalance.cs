using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>Momentum of all links about their common centre of mass, and what gives a floating articulation back what a step took of it.
/// Source: DyFeatherstoneForwardDynamic.cpp (5.6.1), computeMomentum, computeLinkInternalAcceleration and updateBodies.</summary>
internal struct MomentumBalance
{
    private Vector3d _center;
    private double _mass;
    private Vector3d _linear;
    private Vector3d _angular;

    public readonly Vector3d Center => _center;

    /// <summary>kg m/s.</summary>
    public readonly Vector3d Linear => _linear;

    /// <summary>About the centre of mass, kg m^2/s.</summary>
    public readonly Vector3d Angular => _angular;

    /// <summary>Total mass, kg.</summary>
    public readonly double Mass => _mass;

    public static MomentumBalance Of(ArticulationTree tree) => Of(tree, tree.Poses);

    /// <summary>At the tree's motions, with the links at these poses.</summary>
    public static MomentumBalance Of(ArticulationTree tree, Pose[] poses)
    {
        var m = default(MomentumBalance);
        for (int i = 0; i < tree.Count; i++)
        {
            double mass = tree.Links[i].Mass;
            m._mass += mass;
            m._center += poses[i].Position * mass;
            m._linear += tree.Motions[i].Linear * mass;
        }

        m._center *= 1 / m._mass;
        Vector3d speed = m._linear * (1 / m._mass);
        for (int i = 0; i < tree.Count; i++)
        {
            Quaterniond q = poses[i].Rotation;
            m._angular += q * Vector3d.Scale(tree.Links[i].Inertia, q.InverseRotate(tree.Motions[i].Angular))
                + Vector3d.Cross((poses[i].Position - m._center) * tree.Links[i].Mass, tree.Motions[i].Linear - speed);
        }

        return m;
    }

    /// <summary>Turns and moves all links as one, so that the momentum is as long as before, and the linear one the same.</summary>
    public static void Restore(ArticulationTree tree, in MomentumBalance before, Vector3d linearNow)
    {
        MomentumBalance now = Of(tree);
        double length = now._angular.Length;
        Vector3d missing = length > 0 ? now._angular * (before._angular.Length / length - 1) : Vector3d.Zero;
        Vector3d turn = Inertia(tree, now._center).Times(missing);
        Vector3d linear = linearNow;
        for (int i = 0; i < tree.Count; i++)
        {
            var change = new Twist(turn, Vector3d.Cross(turn, tree.Poses[i].Position - now._center));
            tree.Motions[i] += change;
            linear += change.Linear * tree.Links[i].Mass;
        }

        Vector3d shift = (before._linear - linear) * (1 / now._mass);
        for (int i = 0; i < tree.Count; i++)
            tree.Motions[i] += new Twist(Vector3d.Zero, shift);
    }

    public static void Restore(ArticulationTree tree, in MomentumBalance before) => Restore(tree, before, Of(tree)._linear);

    private static InverseInertia Inertia(ArticulationTree tree, Vector3d center)
    {
        Vector3d c0 = Vector3d.Zero, c1 = Vector3d.Zero, c2 = Vector3d.Zero;
        for (int i = 0; i < tree.Count; i++)
        {
            Quaterniond q = tree.Poses[i].Rotation;
            Vector3d r = tree.Poses[i].Position - center;
            double mass = tree.Links[i].Mass;
            c0 += Column(tree.Links[i].Inertia, q, r, mass, Vector3d.UnitX);
            c1 += Column(tree.Links[i].Inertia, q, r, mass, Vector3d.UnitY);
            c2 += Column(tree.Links[i].Inertia, q, r, mass, Vector3d.UnitZ);
        }

        SpatialMatrix.Invert(c0, c1, c2, out Vector3d x, out Vector3d y, out Vector3d z);
        return new InverseInertia(x, y, z);
    }

    private static Vector3d Column(Vector3d inertia, Quaterniond q, Vector3d r, double mass, Vector3d e) =>
        q * Vector3d.Scale(inertia, q.InverseRotate(e)) + Vector3d.Cross(r, Vector3d.Cross(e, r)) * mass;

    private readonly struct InverseInertia
    {
        private readonly Vector3d _x, _y, _z;

        public InverseInertia(Vector3d x, Vector3d y, Vector3d z) => (_x, _y, _z) = (x, y, z);

        public Vector3d Times(Vector3d v) => _x * v.X + _y * v.Y + _z * v.Z;
    }
}
