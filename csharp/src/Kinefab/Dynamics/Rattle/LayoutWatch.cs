using System;
using Kinefab.Joints;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Tells when joints' fields ask for other rows than their blocks were made for. It looks at every joint in every step, with
/// nothing of the blocks in between: in a large world each further object is one more wait for memory.
/// </summary>
internal readonly struct LayoutWatch
{
    private readonly JointModel[] _joints;
    private readonly int[] _signatures;

    public LayoutWatch(JointModel[] joints)
    {
        _joints = Array.FindAll(joints, joint => !joint.IsBroken);
        _signatures = Array.ConvertAll(_joints, joint => joint.Layout().Signature);
    }

    /// <summary>Whether a joint broke or changed since.</summary>
    /// <param name="canBreak">Whether one of them could break, where none has changed.</param>
    public bool IsStale(out bool canBreak)
    {
        canBreak = false;
        for (int i = 0; i < _joints.Length; i++)
        {
            if (_joints[i].IsBroken || _joints[i].Layout().Signature != _signatures[i])
            {
                return true;
            }

            canBreak |= _joints[i].CanBreak;
        }

        return false;
    }
}
