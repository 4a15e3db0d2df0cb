using System.Diagnostics;
using System;

namespace Kinefab.Dynamics;

/// <summary>A joint broke in the step just done; as Unity's OnJointBreak.</summary>
[DebuggerDisplay("{ToString(),nq}")]
public sealed class JointBrokenEventArgs : EventArgs
{
    internal JointBrokenEventArgs(WorldJoint joint) => Joint = joint;

    /// <summary>The joint; its force and torque are those that broke it.</summary>
    public WorldJoint Joint { get; }

    /// <summary>The joint, and what broke it in N and N m.</summary>
    public override string ToString() => $"{Joint}; {Joint.CurrentForce} N, {Joint.CurrentTorque} N m";
}
