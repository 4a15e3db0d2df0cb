using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>
/// The articulated-body algorithm: accelerations of the joints from forces in one pass inwards and one outwards. Everything stands in world
/// axes about the links' centres of mass. Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, section 7.3; the names in
/// brackets are his.
/// </summary>
internal sealed class ForwardDynamics
{
    private const int Axes = ArticulationTree.MostAxes;

    private readonly ArticulationTree _tree;

    /// <summary>From each parent's centre of mass to the link's.</summary>
    public readonly Vector3d[] Levers;

    /// <summary>Motion of a link at speed 1 of a freedom (S).</summary>
    public readonly Twist[] Axis;

    /// <summary>Inertia of a link with all that hangs below it (I^A), joints free.</summary>
    public readonly SpatialMatrix[] Inertias;

    /// <summary>(S^T I^A S)^-1, nine numbers a link, rows first.</summary>
    public readonly double[] InverseInertias;

    /// <summary>I^A S (S^T I^A S)^-1: what a unit of force on the freedom takes from the parent.</summary>
    public readonly Wrench[] Reactions;

    /// <summary>Acceleration of a link that speeds alone give it against its parent (c).</summary>
    public readonly Twist[] SpeedTerms;

    /// <summary>Of the root: 0 when it is fixed.</summary>
    public SpatialMatrix RootResponse;

    /// <summary>Of the joints, m/s^2 or rad/s^2.</summary>
    public readonly double[] JointAccelerations;

    /// <summary>Of the links' centres of mass.</summary>
    public readonly Twist[] Accelerations;

    /// <summary>Seconds in which accelerations take no joint past its largest speed; 0: they may.</summary>
    public double SpeedLimitStep;

    // What a link and all below it resist with while the joints do not accelerate (p^A).
    private readonly Wrench[] _bias;

    public ForwardDynamics(ArticulationTree tree)
    {
        _tree = tree;
        int n = tree.Count;
        int m = tree.Freedoms;
        Levers = new Vector3d[n];
        Axis = new Twist[m];
        Inertias = new SpatialMatrix[n];
        InverseInertias = new double[n * Axes * Axes];
        Reactions = new Wrench[m];
        SpeedTerms = new Twist[n];
        JointAccelerations = new double[m];
        Accelerations = new Twist[n];
        _bias = new Wrench[n];
    }

    /// <summary>Axes, levers, the links' motions and what else follows from the joints' speeds, at the tree's poses.</summary>
    public void Update()
    {
        for (int i = 1; i < _tree.Count; i++)
        {
            int parent = _tree.Parents[i];
            Quaterniond q = _tree.Poses[i].Rotation;
            Vector3d lever = _tree.Poses[i].Position - _tree.Poses[parent].Position;
            Levers[i] = lever;
            Twist motion = _tree.Motions[parent].At(lever);
            Vector3d w = motion.Angular;
            Vector3d angular = Vector3d.Zero;
            Vector3d linear = Vector3d.Zero;
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
            {
                Twist axis = TreeKinematics.Turned(q, _tree.OwnAxes[f]);
                Axis[f] = axis;
                Twist own = axis * _tree.Speeds[f];
                angular += own.Angular;
                linear += own.Linear;
                motion += own;
            }

            _tree.Motions[i] = motion;

            // w x (w x r), and of the joint's own motion (u, s): (w x u, 2 w x s + u x s).
            SpeedTerms[i] = new Twist(
                Vector3d.Cross(w, angular),
                Vector3d.Cross(w, Vector3d.Cross(w, lever)) + 2 * Vector3d.Cross(w, linear) + Vector3d.Cross(angular, linear));
        }
    }

    /// <summary>Inertias of all branches; needs <see cref="Update"/>.</summary>
    public void FindInertias()
    {
        for (int i = 0; i < _tree.Count; i++)
        {
            LinkDefinition link = _tree.Links[i];
            Inertias[i] = SpatialMatrix.Inertia(link.Mass, link.Inertia, _tree.Poses[i].Rotation);
        }

        Span<Wrench> axes = stackalloc Wrench[Axes];
        for (int i = _tree.Count - 1; i > 0; i--)
        {
            ref SpatialMatrix inertia = ref Inertias[i];
            int first = _tree.FirstFreedom[i];
            int count = _tree.FirstFreedom[i + 1] - first;
            for (int k = 0; k < count; k++)
                axes[k] = inertia.Times(Axis[first + k]);
            SpatialMatrix seen = inertia;
            if (count == 1)
            {
                double d = Wrench.Dot(axes[0], Axis[first]);
                double inverse = d > 0 ? 1 / d : 0;
                InverseInertias[i * Axes * Axes] = inverse;
                Reactions[first] = axes[0] * inverse;
                seen.Subtract(axes[0], inverse);
            }
            else if (count > 1)
            {
                InvertSeveral(i, axes.Slice(0, count));
                for (int k = 0; k < count; k++)
                    seen.SubtractBoth(axes[k], Reactions[first + k]);
            }

            int parent = _tree.Parents[i];
            Inertias[parent].AddFrom(seen, Levers[i]);
        }

        RootResponse = _tree.IsFixed ? default : Inertias[0].Response();
    }

    /// <summary>Accelerations; needs <see cref="FindInertias"/> for these poses and <see cref="Update"/> for these speeds.</summary>
    /// <param name="forces">On each link at its centre of mass, gravity included, less what its spin resists with (w x I w): the net wrench at acceleration 0.</param>
    /// <param name="jointForces">Of each freedom, N or N m.</param>
    /// <param name="withSpeedTerms">Whether the speeds' own accelerations count.</param>
    public void Accelerate(ReadOnlySpan<Wrench> forces, ReadOnlySpan<double> jointForces, bool withSpeedTerms = true)
    {
        for (int i = 0; i < _tree.Count; i++)
            _bias[i] = forces[i] * -1;
        for (int i = _tree.Count - 1; i > 0; i--)
        {
            Wrench bias = _bias[i];
            if (withSpeedTerms)
                bias += Inertias[i].Times(SpeedTerms[i]);
            Wrench passed = bias;
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
            {
                double free = jointForces[f] - Wrench.Dot(bias, Axis[f]);
                JointAccelerations[f] = free;
                passed += Reactions[f] * free;
            }

            int parent = _tree.Parents[i];
            _bias[parent] += passed.From(Levers[i]);
        }

        Accelerations[0] = RootResponse.Times(_bias[0] * -1);
        for (int i = 1; i < _tree.Count; i++)
        {
            Twist acceleration = Accelerations[_tree.Parents[i]].At(Levers[i]);
            Answer(i, acceleration);
            if (SpeedLimitStep > 0)
                LimitSpeeds(i);
            if (withSpeedTerms)
                acceleration += SpeedTerms[i];
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
                acceleration += Axis[f] * JointAccelerations[f];
            Accelerations[i] = acceleration;
        }
    }

    // From the forces that are left on a joint's freedoms to their accelerations: D^-1 force - R^T a, for a parent's acceleration a.
    private void Answer(int link, in Twist above)
    {
        int first = _tree.FirstFreedom[link];
        int count = _tree.FirstFreedom[link + 1] - first;
        Span<double> forces = stackalloc double[Axes];
        for (int k = 0; k < count; k++)
            forces[k] = JointAccelerations[first + k];
        for (int k = 0; k < count; k++)
        {
            double answer = -Wrench.Dot(Reactions[first + k], above);
            for (int l = 0; l < count; l++)
                answer += InverseInertias[(link * Axes + k) * Axes + l] * forces[l];
            JointAccelerations[first + k] = answer;
        }
    }

    private void LimitSpeeds(int link)
    {
        double most = _tree.Links[link].MaxJointSpeed;
        for (int f = _tree.FirstFreedom[link]; f < _tree.FirstFreedom[link + 1]; f++)
        {
            double speed = _tree.Speeds[f] + JointAccelerations[f] * SpeedLimitStep;
            if (Math.Abs(speed) > most)
                JointAccelerations[f] = (Math.Min(Math.Max(speed, -most), most) - _tree.Speeds[f]) / SpeedLimitStep;
        }
    }

    private void InvertSeveral(int link, ReadOnlySpan<Wrench> axes)
    {
        int first = _tree.FirstFreedom[link];
        int count = axes.Length;

        // Missing freedoms stand as ones on the diagonal.
        Span<double> d = stackalloc double[9];
        d.Clear();
        for (int k = 0; k < Axes; k++)
            d[4 * k] = 1;
        for (int k = 0; k < count; k++)
        {
            for (int l = 0; l < count; l++)
                d[3 * k + l] = Wrench.Dot(axes[k], Axis[first + l]);
        }

        SpatialMatrix.Invert(new Vector3d(d[0], d[3], d[6]), new Vector3d(d[1], d[4], d[7]), new Vector3d(d[2], d[5], d[8]), out Vector3d x, out Vector3d y, out Vector3d z);
        for (int k = 0; k < Axes; k++)
        {
            int row = (link * Axes + k) * Axes;
            InverseInertias[row] = x[k];
            InverseInertias[row + 1] = y[k];
            InverseInertias[row + 2] = z[k];
        }

        for (int k = 0; k < count; k++)
        {
            Wrench reaction = default;
            for (int l = 0; l < count; l++)
                reaction += axes[l] * InverseInertias[link * 9 + 3 * l + k];
            Reactions[first + k] = reaction;
        }
    }
}
