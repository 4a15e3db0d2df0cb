using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Finds the drives without limit of force whose way the joints, alone or with other such drives, leave no freedom. Such a row j is a combination of
/// theirs, so that what is left of its response when they answer, j M⁻¹ jᵀ − c A⁻¹ cᵀ with c = j M⁻¹ Jᵀ and A = J M⁻¹ Jᵀ (the Schur complement), is
/// nothing: whatever the drive gave would load them without end and move nothing. It gives nothing, and stalls where they do not move it as it asks. Of
/// drives that contradict each other those act that have the most freedom, or else are the slowest.
/// </summary>
internal static class HeldDrives
{
    // Of a row's own response: so far from its dead point no lever is built.
    private const double LeastFree = 1e-9;

    // C up to which a limit holds what rests at it, m or rad: what a drive has pressed there gives by ten tolerances when it lets go.
    private const double StillReached = 1e-6;

    // Of the freedom that a drive came to rest with, from which on it goes on.
    private const double MoreFree = 4;

    // Of what a held drive's response comes to, the share of another drive from which on that one takes part in holding it.
    private const double LeastPart = 1e-6;

    // Shares of freedom that rounding may tell apart.
    private const double Alike = 1e-6;

    /// <summary>Marks them. Leaves momenta and matrix for the caller to restore.</summary>
    /// <param name="batch">Built at the start pose.</param>
    /// <param name="scalars">Its rows.</param>
    /// <param name="conjugateGradient">Solves without the matrix's compliance.</param>
    public static void Find(LaneBatch<ScalarLane> batch, ActiveSet<ScalarLane> scalars, ConjugateGradient conjugateGradient)
    {
        batch.Work.Active[0] = 1;
        scalars.Deactivate();
        RattleStep<ScalarLane>.Factor(batch, false);
        int[] drives = scalars.EndlessDrives();
        List<int>[] opposing = Array.ConvertAll(drives, _ => new List<int>());

        // What the joints leave of the drives' responses, and what the drives that act take from those that are left.
        double[][] left = Array.ConvertAll(drives, drive => Left(batch, scalars, conjugateGradient, drives, drive, 1));
        double[] own = Array.ConvertAll(drives, drive => Impulses<ScalarLane>.ResponseOf(batch, scalars.Row(drive).Block, scalars.Row(drive).Built));
        var byJoints = new double[drives.Length];
        var waiting = new List<int>();
        for (int j = 0; j < drives.Length; j++)
        {
            byJoints[j] = left[j][j] / own[j];
            waiting.Add(j);
        }

        while (waiting.Count > 0)
        {
            int first = First(waiting, left, own, drives, scalars);
            if (!(left[first][first] >= LeastFree * own[first]))
            {
                break;
            }

            waiting.Remove(first);
            foreach (int j in waiting)
            {
                double share = left[j][first] / left[first][first];
                if (byJoints[j] >= LeastFree && share * left[j][first] > LeastPart * byJoints[j] * own[j])
                {
                    opposing[j].Add(first);
                }

                foreach (int i in waiting)
                {
                    left[j][i] -= share * left[first][i];
                }
            }
        }

        foreach (int j in waiting)
        {
            scalars.Hold(drives[j]);
            opposing[j].ForEach(i => scalars.Oppose(drives[i]));
        }
    }

    /// <summary>
    /// Drives without limit of force that stood and rest go on as soon as they are free to, as where a latch lets go of what it held. Leaves momenta and
    /// matrix for the caller to restore.
    /// </summary>
    /// <param name="batch">Built at the start pose.</param>
    /// <param name="scalars">Its rows.</param>
    /// <param name="conjugateGradient">Solves without the matrix's compliance.</param>
    public static void Wake(LaneBatch<ScalarLane> batch, ActiveSet<ScalarLane> scalars, ConjugateGradient conjugateGradient)
    {
        for (int i = scalars.NextResting(0); i >= 0; i = scalars.NextResting(i + 1))
        {
            double freedom = Freedom(batch, scalars, conjugateGradient, i), atFirst = scalars.Row(i).Pace.RestingFreedom;
            if (double.IsNaN(atFirst))
            {
                scalars.NoteFreedom(i, freedom);
            }
            else if (freedom > MoreFree * atFirst && freedom > LeastFree)
            {
                scalars.Wake(i);
            }
        }
    }

    // Of its own bodies' response to an impulse the way that a drive asks for, what joints and reached limits leave when they answer; those that would have
    // to draw let go.
    private static double Freedom(LaneBatch<ScalarLane> batch, ActiveSet<ScalarLane> scalars, ConjugateGradient conjugateGradient, int drive)
    {
        batch.Work.Active[0] = 1;
        double impulse = scalars.Row(drive).Built.VelocityTarget < 0 ? -1 : 1;
        double own = Impulses<ScalarLane>.ResponseOf(batch, scalars.Row(drive).Block, scalars.Row(drive).Built);
        scalars.HoldReached(StillReached);
        double left;
        do
        {
            RattleStep<ScalarLane>.Factor(batch, false);
            left = impulse * Left(batch, scalars, conjugateGradient, new[] { drive }, drive, impulse)[0];
        }
        while (scalars.LetGoOfDrawing(batch.Work.Solution));

        return left / own;
    }

    // The drive that has the most freedom left, in proportion; of those alike the slowest, in whatever order the joints stand.
    private static int First(List<int> waiting, double[][] left, double[] own, int[] drives, ActiveSet<ScalarLane> scalars)
    {
        int best = -1;
        foreach (int j in waiting)
        {
            if (best < 0 || Compare(j, best) > 0)
            {
                best = j;
            }
        }

        return best;

        int Compare(int a, int b)
        {
            double difference = left[a][a] / own[a] - left[b][b] / own[b];
            double speedA = scalars.Row(drives[a]).Built.VelocityTarget, speedB = scalars.Row(drives[b]).Built.VelocityTarget;
            return Math.Abs(difference) > Alike ? Math.Sign(difference)
                : Math.Abs(speedA) != Math.Abs(speedB) ? Math.Abs(speedB).CompareTo(Math.Abs(speedA))
                : speedB.CompareTo(speedA);
        }
    }

    // Speeds along the drives that an impulse along one of them gives once the rows that hold have answered; their answers stand in Work.Solution.
    private static double[] Left(LaneBatch<ScalarLane> batch, ActiveSet<ScalarLane> scalars, ConjugateGradient conjugateGradient, int[] drives, int drive, double impulse)
    {
        ref readonly ScalarRow row = ref scalars.Row(drive);
        double[] speeds = batch.Work.Solution;
        double[] answer = batch.Work.LastSolution;
        double[] before = Array.ConvertAll(drives, SpeedOf);
        Impulses<ScalarLane>.NegativeSpeeds(batch);
        Array.Copy(speeds, answer, speeds.Length);
        Impulses<ScalarLane>.ApplyRow(batch, row.Block, row.Built, impulse);
        Impulses<ScalarLane>.NegativeSpeeds(batch);
        for (int i = 0; i < speeds.Length; i++)
        {
            speeds[i] -= answer[i];
        }

        conjugateGradient.Solve(false);
        Impulses<ScalarLane>.Apply(batch, speeds);
        double[] after = Array.ConvertAll(drives, SpeedOf);
        for (int i = 0; i < after.Length; i++)
        {
            after[i] -= before[i];
        }

        return after;

        double SpeedOf(int index) => Impulses<ScalarLane>.Speed(batch, scalars.Row(index).Block, scalars.Row(index).Built);
    }
}
