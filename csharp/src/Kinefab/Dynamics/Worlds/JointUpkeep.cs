using System;

namespace Kinefab.Dynamics;

/// <summary>What a world's joints do by themselves before and after a step: each joint has to do with itself alone.</summary>
internal sealed class JointUpkeep : IStepParts
{
    private const int JointsInPart = 256;

    private readonly WorldJoint[] _joints;
    private readonly double _endShare;
    private bool _isBefore;
    private double _dt;

    /// <param name="joints">The world's.</param>
    /// <param name="endShare">See <see cref="WorldJoint.AfterStep"/>.</param>
    public JointUpkeep(WorldJoint[] joints, double endShare)
    {
        _joints = joints;
        _endShare = endShare;
    }

    public void BeforeStep(int threads)
    {
        _isBefore = true;
        Run(threads);
    }

    public void AfterStep(double dt, int threads)
    {
        _isBefore = false;
        _dt = dt;
        Run(threads);
    }

    /// <inheritdoc/>
    void IStepParts.Do(int part)
    {
        int end = Math.Min(_joints.Length, (part + 1) * JointsInPart);
        for (int i = part * JointsInPart; i < end; i++)
        {
            if (_isBefore)
            {
                _joints[i].BeforeStep();
            }
            else
            {
                _joints[i].AfterStep(_dt, _endShare);
            }
        }
    }

    private void Run(int threads) => StepThreads.ForEach(this, (_joints.Length + JointsInPart - 1) / JointsInPart, threads);
}
