using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The compliance on the diagonal of A = J M^-1 J^T, by which redundant rows share their load evenly (least norm) instead of making it
/// singular: 1e-6 of the diagonal for rows with a linear part; for angular ones 1e-4 of what their bodies' largest moments would answer.
/// 1e-3 of the diagonal, where a slender body may turn about its length, is as soft as the body's other turns are free: the iteration closes
/// them slowly, and the projection leaves them speed. Only loops that are not exact need that softness. What the rows are solved for is the
/// true residual, so consistent loops still close to the tolerance. Without loops no row is redundant, and the share would only hide the slow
/// modes of long chains.
/// </summary>
internal static class Regularisation<V>
    where V : struct, ILane<V>
{
    /// <summary>Share of the diagonal that rows with a linear part get.</summary>
    public const double LinearShare = 1e-6;

    // Against rounding alone.
    private const double TreeShare = 1e-12;

    // Least part of the diagonal of which an angular row gets its share: keeps the pivots of needles above rounding.
    private const double LeastPart = 1e-5;

    /// <summary>Adds a block's share to its diagonal, and writes it to <see cref="LaneRecords{V}.Compliance"/> where rows may be redundant.</summary>
    /// <param name="batch">With the block's diagonal, and its rows' response over hubs.</param>
    /// <param name="n">Index of the block.</param>
    /// <param name="block">The block.</param>
    /// <param name="angularShare">For locked angles, of what the largest moments of the block's bodies would answer.</param>
    /// <param name="linearShare">For rows with a linear part, of their diagonal.</param>
    public static void Add(LaneRecords<V> batch, int n, RowBlock block, double angularShare, double linearShare)
    {
        int cell = batch.Shape.Pattern.Diagonal(n) * Lane<V>.Width;
        int row = batch.Shape.Pattern.Rows[n] * Lane<V>.Width;
        if (batch.Shape.IsRedundant)
        {
            Lane<V> least = batch.CompliantStep > 0 ? Lane<V>.Load(batch.Work.CompliantInertia, 0)
                : batch.Shape.Loops == LoopConsistency.Exact ? LeastResponse(batch, block)
                : Lane<V>.Splat(double.PositiveInfinity);
            Lane<V> still = batch.Shape.LockedInertiaBodies.Length > 0 ? Lane<V>.Splat(LeastPart) * LeastResponse(batch, block) : Lane<V>.Splat(0);
            AddToLoops(batch, block, row, cell, least, still, angularShare, linearShare);
        }
        else
        {
            AddToTree(batch, block, row, cell);
        }
    }

    private static void AddToTree(LaneRecords<V> batch, RowBlock block, int row, int cell)
    {
        int w = Lane<V>.Width;
        Lane<V> share = Lane<V>.Splat(TreeShare);
        for (int i = 0; i < block.BilateralCount; i++, row += w, cell += (block.Rows + 1) * w)
        {
            Lane<V> diagonal = Lane<V>.Load(batch.Matrix, cell);
            (diagonal + share * (diagonal + Lane<V>.Load(batch.Work.HubResponse, row))).Store(batch.Matrix, cell);
        }
    }

    // What the largest moments of a block's bodies would answer.
    private static Lane<V> LeastResponse(LaneRecords<V> batch, RowBlock block)
    {
        Lane<V> least = Lane<V>.Splat(0);
        foreach (int body in block.Bodies)
        {
            least += Lane<V>.Load(batch.Bodies, LaneRecords<V>.Body(body, BodyLanes.LeastInverseInertia));
        }

        return least;
    }

    // Least is infinite where angular rows get their share of the whole diagonal. One about an axis about which its bodies do not turn has nothing but
    // rounding there, and gets that of a response that is still one.
    private static void AddToLoops(LaneRecords<V> batch, RowBlock block, int row, int cell, Lane<V> least, Lane<V> still, double angularShare, double linearShare)
    {
        double[] matrix = batch.Matrix;
        int w = Lane<V>.Width;
        for (int i = 0; i < block.BilateralCount; i++, row += w, cell += (block.Rows + 1) * w)
        {
            bool isAngular = block.Classes[i] == RowClass.Angular;
            Lane<V> diagonal = Lane<V>.Load(matrix, cell);
            Lane<V> response = diagonal + Lane<V>.Load(batch.Work.HubResponse, row);
            Lane<V> slow = !isAngular ? response : batch.CompliantStep > 0 ? least : Lane<V>.Max(still, Lane<V>.Min(response, Lane<V>.Max(least, Lane<V>.Splat(LeastPart) * response)));
            Lane<V> compliance = Lane<V>.Splat(isAngular ? angularShare : linearShare) * slow;
            compliance.Store(batch.Compliance, row);
            (diagonal + compliance).Store(matrix, cell);
        }
    }
}
