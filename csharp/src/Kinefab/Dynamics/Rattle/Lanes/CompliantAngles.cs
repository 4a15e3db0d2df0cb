using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Locked angles of an inconsistent island as springs, so that it moves as it does in Unity though its axes are off: softer than a misalignment,
/// harder than a freedom. Their stiffness k is the island's own, whatever the step and its parts, and wherever the bodies stand, so that k C^2 / 2
/// is a potential, and their work stands in the island's account. The impulse of a drift is p = -k h (C0 + t (C - C0)) with t a little beyond the
/// midpoint, which takes a little energy and lets what swings too fast for the step decay. It acts before the drift; the projection leaves the
/// angles alone. With 1 / (t k h^2) on the matrix's diagonal each is one more row of the chord iteration.
/// </summary>
internal static class CompliantAngles<V>
    where V : struct, ILane<V>
{
    // With which the body of the largest moment about a joint of its own would swing, were a locked angle its only freedom, rad/s. One stiffness for
    // the island: that of a light body's own would let what hangs on it turn it over.
    private const double Frequency = 32;

    // Of what moves.
    private const double LeastWork = 5e-4;

    // Where on the way the force is taken, as a share of it.
    private const double Theta = 0.6;

    /// <summary>1 / (t k h^2), of what the largest moment answers.</summary>
    /// <param name="h">Length of the drift, s.</param>
    public static double Share(double h) => 1 / (Theta * Frequency * Frequency * h * h);

    /// <summary>A drift begins; nothing where the island is not inconsistent.</summary>
    /// <param name="batch">At the start pose.</param>
    /// <param name="h">Length of the drift, s.</param>
    public static void Begin(LaneRecords<V> batch, double h)
    {
        if (batch.Shape.IsInconsistent)
        {
            BilateralRows<V>.Evaluate(batch);
            Array.Copy(batch.Work.Error, batch.Work.LastAngles, batch.Work.LastAngles.Length);
            batch.CompliantStep = h;
            FindInertia(batch);
        }
    }

    /// <summary>What the springs add to the errors at the end of the drift.</summary>
    public static void Evaluate(LaneRecords<V> batch)
    {
        int w = Lane<V>.Width;
        for (int n = 0; n < batch.Shape.Blocks.Length && batch.Shape.IsInconsistent; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            Lane<V> side = Lane<V>.Splat(IsTurnedOver(batch, n) ? -1 : 1);
            int row = batch.Shape.Pattern.Rows[n] * w;
            for (int i = 0; i < block.BilateralCount; i++, row += w)
            {
                if (block.IsLockedAngle(i))
                {
                    (side * Lane<V>.Load(batch.Work.Error, row) + Held(batch, row)).Store(batch.Work.Error, row);
                }
            }
        }
    }

    /// <summary>
    /// Adds to the right-hand side at the start pose the speeds that angles shall have by the impulses that they have: v + p / (t k h^2) = -C0 / (t h).
    /// </summary>
    public static void AddStepTargets(LaneRecords<V> batch)
    {
        int w = Lane<V>.Width;
        Lane<V> rate = Lane<V>.Splat(1 / (Theta * batch.CompliantStep));
        bool[] isAngular = batch.Shape.IsAngular;
        for (int i = 0; i < isAngular.Length; i++)
        {
            if (isAngular[i])
            {
                Lane<V> speed = rate * Lane<V>.Load(batch.Work.LastAngles, i * w) + Lane<V>.Load(batch.Compliance, i * w) * Lane<V>.Load(batch.Work.PositionImpulses, i * w);
                (Lane<V>.Load(batch.Work.Solution, i * w) - speed).Store(batch.Work.Solution, i * w);
            }
        }
    }

    /// <summary>Adds the springs' work in the drift, after it.</summary>
    public static void AddDrift(LaneRecords<V> batch)
    {
        AddWork(batch, Theta);
        batch.CompliantStep = 0;
    }

    /// <summary>Adds, after <see cref="AddDrift"/>, what closing the pose has changed of the potential.</summary>
    public static void AddClosing(LaneRecords<V> batch)
    {
        BilateralRows<V>.Evaluate(batch);
        AddWork(batch, 0.5);
    }

    /// <summary>Whether a lane's springs did more work since the start of the step than the account overlooks: they may have lost some of it.</summary>
    /// <param name="batch">The island is one of these.</param>
    /// <param name="lane">Its lane.</param>
    /// <param name="kinetic">What moves, J.</param>
    public static bool HaveActed(LaneRecords<V> batch, int lane, double kinetic) => Math.Abs(batch.Work.CompliantWork[lane]) > LeastWork * kinetic;

    /// <summary>What the springs hold more at most where each is off by an angle, J; on the only lane.</summary>
    public static double LargestEnergy(LaneRecords<V> batch, double angle)
    {
        double sum = 0;
        for (int n = 0; n < batch.Shape.Blocks.Length && batch.Shape.IsInconsistent; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            for (int i = 0; i < block.BilateralCount; i++)
            {
                double c = batch.Work.LastAngles[batch.Shape.Pattern.Rows[n] + i];
                sum += block.IsLockedAngle(i) ? angle * (angle + Math.Abs(c)) : 0;
            }
        }

        return sum > 0 && batch.Work.CompliantInertia[0] > 0 ? Frequency * Frequency / batch.Work.CompliantInertia[0] * sum : 0;
    }

    // By the force at a share of the way from the angles where the work was last added to those where the rows were last evaluated.
    private static void AddWork(LaneRecords<V> batch, double at)
    {
        if (!batch.Shape.IsInconsistent)
        {
            return;
        }

        int w = Lane<V>.Width;
        Lane<V> sum = Lane<V>.Splat(0);
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            int row = batch.Shape.Pattern.Rows[n] * w;
            for (int i = 0; i < block.BilateralCount; i++, row += w)
            {
                if (block.IsLockedAngle(i))
                {
                    Lane<V> last = Lane<V>.Load(batch.Work.LastAngles, row);
                    Lane<V> c = Lane<V>.Load(batch.Work.Error, row);
                    c = batch.CompliantStep > 0 ? c - Held(batch, row) : c;
                    sum += (last + Lane<V>.Splat(at) * (c - last)) * (c - last);
                    c.Store(batch.Work.LastAngles, row);
                }
            }
        }

        (Lane<V>.Load(batch.Work.CompliantWork, 0) - Lane<V>.Splat(Frequency * Frequency) / Lane<V>.Load(batch.Work.CompliantInertia, 0) * sum).Store(batch.Work.CompliantWork, 0);
    }

    private static void FindInertia(LaneRecords<V> batch)
    {
        Lane<V> most = Lane<V>.Splat(0);
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            for (int side = 0; side < 2 && block.Joint != null; side++)
            {
                if (block.Bodies[side] < batch.Shape.MovingBodies)
                {
                    LaneVector<V> lever = LaneVector<V>.Load(batch.Joints, LaneRecords<V>.Joint(n, LaneRecords<V>.Frame(side)));
                    int body = LaneRecords<V>.Body(block.Bodies[side], 0);
                    Lane<V> inverse = Lane<V>.Load(batch.Bodies, body, BodyLanes.LeastInverseInertia);
                    Lane<V> own = Lane<V>.Select(inverse, Lane<V>.Splat(1) / inverse, Lane<V>.Splat(0));
                    most = Lane<V>.Max(most, own + LaneVector<V>.Dot(lever, lever) / Lane<V>.Load(batch.Bodies, body, BodyLanes.InverseMass));
                }
            }
        }

        (Lane<V>.Splat(1) / most).Store(batch.Work.CompliantInertia, 0);
    }

    // A lone locked twist is half a quaternion's component, which changes its sign where the quaternion is taken on the other side of the double cover.
    private static bool IsTurnedOver(LaneRecords<V> batch, int n)
    {
        return batch.Shape.Blocks[n].Angular == AngularForm.Prepared && batch.Models[n]!.Layout().Locked >> 3 == 1
            && Side(BodyLanes.Q) * Side(BodyLanes.EndQ) < 0;

        double Side(int slot) => JointFrames.Dot(FrameAt(0, slot, batch.Models[n]!.Frame0), FrameAt(1, slot, batch.Models[n]!.Frame1));

        Quaterniond FrameAt(int side, int slot, in Pose frame) =>
            LaneTransfer<V>.ReadQuaternion(batch.Bodies, LaneRecords<V>.Body(batch.Shape.Blocks[n].Bodies[side], slot)) * frame.Rotation;
    }

    // Of C0 (1 - t) / t + C + p / (t k h) = 0 all but C.
    private static Lane<V> Held(LaneRecords<V> batch, int row) =>
        Lane<V>.Splat(batch.CompliantStep) * Lane<V>.Load(batch.Compliance, row) * Lane<V>.Load(batch.Work.PositionImpulses, row)
        + Lane<V>.Splat((1 - Theta) / Theta) * Lane<V>.Load(batch.Work.LastAngles, row);
}
