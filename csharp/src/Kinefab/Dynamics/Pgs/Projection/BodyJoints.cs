using System;
using Kinefab.Joints;

namespace Kinefab.Dynamics.Pgs;

/// <summary>The joints of each body, in the mechanism's order.</summary>
internal sealed class BodyJoints
{
    private readonly int[] _joints;

    // Where a body's joints begin, and, one further, where they end.
    private readonly int[] _first;

    public BodyJoints(MultibodySystem mechanism)
    {
        _first = new int[mechanism.Bodies.Count + 1];
        foreach (JointModel joint in mechanism.Joints)
        {
            Count(joint.Body0);
            Count(joint.Body1);
        }

        for (int body = 1; body < _first.Length; body++)
        {
            _first[body] += _first[body - 1];
        }

        // From the last joint on, every body's place moves down to where its first one stands.
        _joints = new int[_first[^1]];
        for (int i = mechanism.Joints.Length - 1; i >= 0; i--)
        {
            Put(mechanism.Joints[i].Body0, i);
            Put(mechanism.Joints[i].Body1, i);
        }
    }

    /// <summary>Indices of a body's joints, broken ones too.</summary>
    public ReadOnlySpan<int> Of(int body) => _joints.AsSpan(_first[body], _first[body + 1] - _first[body]);

    private void Count(int body)
    {
        if (body >= 0)
        {
            _first[body]++;
        }
    }

    private void Put(int body, int joint)
    {
        if (body >= 0)
        {
            _joints[--_first[body]] = joint;
        }
    }
}
