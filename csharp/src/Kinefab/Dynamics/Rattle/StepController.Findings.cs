using System;
using System.Collections.Generic;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <content>What there is to say of a step: where it stopped, what stalls, what stood open or moved as it may not.</content>
internal sealed partial class StepController
{
    /// <summary>What was farthest from closed in the last step that had a stop.</summary>
    /// <param name="island">The island that was stepped; the batch may be of another of its shape.</param>
    public UnsolvedStep Unsolved(Island island)
    {
        return _worst < 0
            ? new UnsolvedStep { Body = island.Bodies[0], Troubles = _troubles }
            : new UnsolvedStep { Body = island.Bodies[0], Troubles = _troubles, Joint = island.JointOf(_worst), Error = _worstError, IsAngular = island.IsInRadians(_worst) };
    }

    /// <summary>The joints whose limits stand passed and cannot be closed are added to a list.</summary>
    /// <param name="island">The island that was stepped; the batch may be of another of its shape.</param>
    /// <param name="held">Takes them.</param>
    public void AddHeldLimits(Island island, List<HeldLimit> held)
    {
        for (int i = _batch.ActiveSet?.NextHeldOpen(0) ?? -1; i >= 0; i = _batch.ActiveSet!.NextHeldOpen(i + 1))
        {
            ref readonly ScalarRow row = ref _batch.ActiveSet!.Row(i);
            held.Add(new HeldLimit { Body = island.Bodies[0], Joint = island.Blocks[row.Block].Joint!, Error = -row.Limit.Allowed, IsAngular = row.Built.Has(RowFlags.Angular) });
        }
    }

    /// <summary>
    /// The joints whose endless drives stall, and those whose limits they push against, are added to a list; not a drive that rests at its own joint's
    /// limit.
    /// </summary>
    /// <param name="island">The island that was stepped; the batch may be of another of its shape.</param>
    /// <param name="stalled">Takes them.</param>
    public void AddStalled(Island island, List<StalledJoint> stalled)
    {
        double weight = _batch.ActiveSet?.StalledWeight() ?? -1;
        if (weight >= 0)
        {
            AddStalled(island, stalled, weight);
        }
    }

    private void AddStalled(Island island, List<StalledJoint> stalled, double weight)
    {
        ActiveSet<ScalarLane> scalars = _batch.ActiveSet!;
        int first = stalled.Count;
        bool areOpposed = scalars.HasHeldStalled();
        for (int i = 0; i < scalars.Count; i++)
        {
            ref readonly ScalarRow row = ref scalars.Row(i);
            bool isDrive = row.Drive.IsStalled || (areOpposed && row.Drive.IsOpposing);
            if (!isDrive && !scalars.IsPushed(row, weight))
            {
                continue;
            }

            // A joint's drives stand before its limits.
            JointModel joint = island.Blocks[row.Block].Joint!;
            bool isOwnLimit = !isDrive && stalled.RemoveAll(one => one.IsDrive && one.Joint == joint) > 0;
            if (!isOwnLimit)
            {
                stalled.Add(new StalledJoint { Body = island.Bodies[0], Joint = joint, IsDrive = isDrive });
            }
        }

        if (stalled.FindIndex(first, one => one.IsDrive) < 0)
        {
            stalled.RemoveRange(first, stalled.Count - first);
        }
    }

    /// <inheritdoc cref="StepStart.HasClosed"/>
    public bool HasClosed => _stepStart.HasClosed;

    /// <inheritdoc cref="StepStart.HasForbiddenSpeed"/>
    public bool HasForbiddenSpeed => _stepStart.HasForbiddenSpeed;

    /// <inheritdoc cref="StepStart.Forbidden"/>
    public ForbiddenSpeed Forbidden(Island island) => _stepStart.Forbidden(island);

    /// <inheritdoc cref="StepStart.Closed"/>
    public ClosedPose Closed(Island island) => _stepStart.Closed(island);

    // Of the first part that no method could take.
    private void MeasureWorstResidual()
    {
        _worst = -1;
        _worstError = _tolerance;
        for (int i = 0; i < _batch.Work.Error.Length; i++)
        {
            double error = Math.Abs(_batch.Work.Error[i]);
            error = double.IsNaN(error) ? double.PositiveInfinity : error;
            if (error > _worstError)
            {
                _worst = i;
                _worstError = error;
            }
        }
    }

    // Of the pose that is built; its rows have to be built anew after it.
    private void FindTroubles()
    {
        _troubles = _batch.ActiveSet?.Troubles(ActiveSet<ScalarLane>.Reach * _tolerance) ?? StepTroubles.None;
        _troubles |= _stepStart.IsOpen() ? StepTroubles.Open : StepTroubles.None;
    }
}
