using System;
using Kinefab.Dynamics.Articulations;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Articulations;

/// <summary>
/// The recursive Newton-Euler algorithm: forces of the joints from their accelerations. Independent of <see cref="ForwardDynamics"/> but for the
/// poses and motions. Source: Featherstone, Rigid Body Dynamics Algorithms, 2008, section 5.3.
/// </summary>
internal sealed class InverseDynamics
{
    private readonly ArticulationTree _tree;
    private readonly Twist[] _accelerations;
    private readonly Wrench[] _wrenches;

    public InverseDynamics(ArticulationTree tree)
    {
        _tree = tree;
        _accelerations = new Twist[tree.Count];
        _wrenches = new Wrench[tree.Count];
    }

    /// <summary>What must act on the root from outside, about its centre of mass; 0 for a floating root in free motion.</summary>
    public Wrench RootWrench => _wrenches[0];

    /// <summary>Forces of the joints, N or N m.</summary>
    /// <param name="root">Acceleration of the root's centre of mass.</param>
    /// <param name="jointAccelerations">m/s^2 or rad/s^2.</param>
    /// <param name="gravity">m/s^2.</param>
    /// <param name="forces">Takes them.</param>
    public void Forces(in Twist root, ReadOnlySpan<double> jointAccelerations, Vector3d gravity, Span<double> forces)
    {
        for (int i = 0; i < _tree.Count; i++)
        {
            Quaterniond q = _tree.Poses[i].Rotation;
            Twist motion = _tree.Motions[i];
            Twist acceleration = root;
            if (i > 0)
            {
                int parent = _tree.Parents[i];
                Vector3d lever = _tree.Poses[i].Position - _tree.Poses[parent].Position;
                Twist above = _tree.Motions[parent];
                acceleration = _accelerations[parent].At(lever);
                Vector3d angular = acceleration.Angular;
                Vector3d linear = acceleration.Linear + Vector3d.Cross(above.Angular, Vector3d.Cross(above.Angular, lever));
                Vector3d u = motion.Angular - above.Angular;
                Vector3d s = motion.Linear - above.At(lever).Linear;
                angular += Vector3d.Cross(above.Angular, u);
                linear += 2 * Vector3d.Cross(above.Angular, s) + Vector3d.Cross(u, s);
                acceleration = new Twist(angular, linear);
                for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
                    acceleration += TreeKinematics.Turned(q, _tree.OwnAxes[f]) * jointAccelerations[f];
            }

            _accelerations[i] = acceleration;
            LinkDefinition link = _tree.Links[i];
            Vector3d own = q.InverseRotate(motion.Angular);
            Vector3d spin = Vector3d.Scale(link.Inertia, own);
            Vector3d torque = q * (Vector3d.Scale(link.Inertia, q.InverseRotate(acceleration.Angular)) + Vector3d.Cross(own, spin));
            _wrenches[i] = new Wrench((acceleration.Linear - (link.UseGravity ? gravity : Vector3d.Zero)) * link.Mass, torque);
        }

        for (int i = _tree.Count - 1; i > 0; i--)
        {
            Quaterniond q = _tree.Poses[i].Rotation;
            for (int f = _tree.FirstFreedom[i]; f < _tree.FirstFreedom[i + 1]; f++)
                forces[f] = Wrench.Dot(_wrenches[i], TreeKinematics.Turned(q, _tree.OwnAxes[f]));
            int parent = _tree.Parents[i];
            _wrenches[parent] += _wrenches[i].From(_tree.Poses[i].Position - _tree.Poses[parent].Position);
        }
    }
}
