using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The limits of islands that are stepped without their rows: while none is reached, those do nothing. A lane whose pose at the start of a step is at
/// a limit, or whose drift would end beyond one, leaves the batch for that step: for the one in which hinges rest on limits, or to be stepped alone.
/// </summary>
internal sealed class WatchedLimits<V>
    where V : struct, ILane<V>
{
    // Turn of a hinge in a step beyond which it may as well have gone the other way round, radians: a lane turns half as far by its speed at the start.
    private const double MostTurn = 1;

    private readonly Island _shape;
    private readonly ConstraintRow[] _rows = new ConstraintRow[JointModel.MaxRows];

    // Cosine and sine of the turn of each watched hinge, then the turn itself, radians.
    private readonly double[] _turns;

    private WatchedLimits(Island shape)
    {
        _shape = shape;
        _turns = new double[2 * shape.Blocks.Length * Lane<V>.Width];
    }

    /// <summary>Those of a shape; null where none has to be watched.</summary>
    public static WatchedLimits<V>? Of(Island shape) =>
        Array.Exists(shape.Blocks, block => block.Watch != WatchForm.None) ? new WatchedLimits<V>(shape) : null;

    /// <summary>Whether a lane stands at a limit, so that its row may act from the start of the step on; those of axis rows are for these to tell.</summary>
    /// <param name="batch">Placed at the start pose.</param>
    /// <param name="lane">The lane.</param>
    /// <param name="tolerance">Largest C, m or rad.</param>
    public bool IsReached(LaneBatch<V> batch, int lane, double tolerance)
    {
        double reach = ActiveSet<V>.Reach * tolerance;
        for (int n = 0; n < _shape.Blocks.Length; n++)
        {
            WatchForm form = _shape.Blocks[n].HasAxisRow ? WatchForm.None : _shape.Blocks[n].Watch;
            if (form == WatchForm.None)
            {
                continue;
            }

            // Where nobody has moved the bodies the joint knows its turn from the end of the last step.
            JointModel joint = batch.Models[n * Lane<V>.Width + lane]!;
            bool isKnown = form == WatchForm.Twist && batch.Work.Moved[lane] == 0;
            if (!((isKnown ? HingeRange.LeftOf(joint, joint.LastTwist) : LeastLeft(batch, n, joint, lane)) > reach))
            {
                return true;
            }
        }

        return false;
    }

    /// <summary>Finds the turns of all lanes at the end of the drift.</summary>
    public void Measure(LaneBatch<V> batch)
    {
        for (int n = 0; n < _shape.Blocks.Length; n++)
        {
            if (_shape.Blocks[n].Watch is WatchForm.Twist or WatchForm.Turn)
            {
                int at = 2 * n * Lane<V>.Width;
                HingeTurn<V>.Measure(batch, n, _turns, at);
                LaneTrigonometry<V>.Atan2(_turns, at + Lane<V>.Width, _turns, at, _turns, at);
            }
        }
    }

    /// <summary>
    /// Whether the drift of a lane ended at a limit or beyond it, which is a blow, or turned a hinge so far that no pose tells whether it did, after
    /// <see cref="Measure"/>.
    /// </summary>
    /// <param name="batch">Placed at the end of the drift.</param>
    /// <param name="lane">The lane.</param>
    /// <param name="tolerance">Largest C, m or rad.</param>
    public bool IsPassed(LaneBatch<V> batch, int lane, double tolerance)
    {
        int w = Lane<V>.Width;
        for (int n = 0; n < _shape.Blocks.Length; n++)
        {
            WatchForm form = _shape.Blocks[n].Watch;
            if (form == WatchForm.None)
            {
                continue;
            }

            // What has an axis row may have rested at its limit all along.
            double least = _shape.Blocks[n].HasAxisRow ? -ActiveSet<V>.MostPassed * tolerance : ActiveSet<V>.Reach * tolerance;
            JointModel joint = batch.Models[n * w + lane]!;
            if (form == WatchForm.Prepared)
            {
                if (!(LeastLeft(batch, n, joint, lane) > least))
                {
                    return true;
                }

                continue;
            }

            ref double turn = ref _turns[2 * n * w + lane];
            turn = SwingTwist.Nearest(turn, joint.LastTwist);
            if (!(Math.Abs(turn - joint.LastTwist) <= MostTurn) || (form == WatchForm.Twist && !(HingeRange.LeftOf(joint, turn) > least)))
            {
                return true;
            }
        }

        return false;
    }

    /// <summary>Notes the angles that a lane has reached by the step, after <see cref="IsPassed"/>.</summary>
    public void FinishAngles(LaneBatch<V> batch, int lane)
    {
        int w = Lane<V>.Width;
        for (int n = 0; n < _shape.Blocks.Length; n++)
        {
            RowBlock block = _shape.Blocks[n];
            JointModel joint = batch.Models[n * w + lane]!;
            if (block.Watch is WatchForm.Twist or WatchForm.Turn)
            {
                joint.CountTwist(_turns[2 * n * w + lane]);
            }
            else if (block.Watch == WatchForm.Prepared)
            {
                joint.FinishTwist(LaneTransfer<V>.ReadPose(batch, block.Bodies[0], lane), LaneTransfer<V>.ReadPose(batch, block.Bodies[1], lane));
            }
        }
    }

    // The least C of its limits by the joint's own rows.
    private double LeastLeft(LaneBatch<V> batch, int n, JointModel joint, int lane)
    {
        RowBlock block = _shape.Blocks[n];
        int count = joint.PrepareForces(LaneTransfer<V>.ReadPose(batch, block.Bodies[0], lane), LaneTransfer<V>.ReadPose(batch, block.Bodies[1], lane), _rows);
        double least = double.PositiveInfinity;
        for (int i = 0; i < count; i++)
        {
            least = _rows[i].Has(RowFlags.Limit) ? Math.Min(least, _rows[i].GeometricError) : least;
        }

        return least;
    }
}
