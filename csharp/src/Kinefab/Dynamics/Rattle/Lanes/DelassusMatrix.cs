using System;
using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// A = J M^-1 J^T of the built rows, regularised: a compliance is added to each diagonal, so that redundant rows share their
/// load evenly (least norm) instead of making A singular: 1e-6 of it for rows with a linear part; for angular ones 1e-4 of
/// what their bodies' largest moments would answer. 1e-3 of the diagonal, where a slender body may turn about its length,
/// is as soft as the body's other turns are free: the iteration closes them slowly, and the projection leaves them speed.
/// Only loops that are not exact need that softness. What the rows are solved for is the true residual, so consistent loops still
/// close to the tolerance. Without loops no row is redundant, and the share would only hide the slow modes of long chains.
/// </summary>
internal static class DelassusMatrix<V>
    where V : struct, ILane<V>
{
    /// <summary>Share added to the diagonal for anchors, and for locked angles in RATTLE steps: of exact loops, and of loose ones.</summary>
    private const double LinearShare = 1e-6;
    public const double AngularShare = 1e-4;
    public const double RoundedShare = 1e-3;

    private const int HingeRows = 5;

    // Against rounding alone.
    private const double TreeShare = 1e-12;

    // Least part of the diagonal of which an angular row gets its share: keeps the pivots of needles above rounding.
    private const double LeastPart = 1e-5;

    /// <summary>The same in loops whose axes are off: softer than a misalignment, harder than a freedom.</summary>
    public const double InconsistentShare = 0.1;

    /// <summary>The same in their projection, in which their angles take no part.</summary>
    public const double UnconstrainedShare = 1e9;

    /// <summary>World inverse inertias from R and the principal moments.</summary>
    public static void InverseInertias(LaneRecords<V> batch)
    {
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            InverseInertia(batch.Bodies, body);
        }
    }

    // R I^-1 R^T. By itself: within its callers there is more to inline than the compiler does.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void InverseInertia(double[] a, int body)
    {
        int w = Lane<V>.Width;
        int r = LaneRecords<V>.Body(body, BodyLanes.R);
        LaneVector<V> inverse = LaneVector<V>.Load(a, LaneRecords<V>.Body(body, BodyLanes.InverseInertia));
        LaneVector<V> x = LaneVector<V>.Load(a, r);
        LaneVector<V> y = LaneVector<V>.Load(a, r + 3 * w);
        LaneVector<V> z = LaneVector<V>.Load(a, r + 6 * w);
        LaneVector<V> sx = LaneVector<V>.Scale(inverse, x);
        LaneVector<V> sy = LaneVector<V>.Scale(inverse, y);
        int o = LaneRecords<V>.Body(body, BodyLanes.WorldInverse);
        LaneVector<V>.Dot(sx, x).Store(a, o);
        LaneVector<V>.Dot(sy, y).Store(a, o + w);
        LaneVector<V>.Dot(LaneVector<V>.Scale(inverse, z), z).Store(a, o + 2 * w);
        LaneVector<V>.Dot(sx, y).Store(a, o + 3 * w);
        LaneVector<V>.Dot(sx, z).Store(a, o + 4 * w);
        LaneVector<V>.Dot(sy, z).Store(a, o + 5 * w);
    }

    /// <summary>Fills the responses of all rows, the matrix from J and the bodies' inverse inertias.</summary>
    public static void Assemble(LaneRecords<V> batch, double angularShare, double linearShare = LinearShare)
    {
        Array.Clear(batch.Matrix, 0, batch.Matrix.Length);
        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            for (int side = 0; side < block.Bodies.Length; side++)
            {
                if (block.Bodies[side] < batch.Shape.MovingBodies)
                {
                    Responses(batch, n, block, side);
                    AddDiagonal(batch, n, block, side);
                }
            }

            Regularise(batch, n, block, angularShare, linearShare);
        }

        foreach (Island.Link link in batch.Shape.Links)
        {
            AddLink(batch, link);
        }
    }

    private static void Responses(LaneRecords<V> batch, int n, RowBlock block, int side)
    {
        int w = Lane<V>.Width;
        int inverse = LaneRecords<V>.Body(block.Bodies[side], BodyLanes.WorldInverse);
        int stride = 3 * block.Bodies.Length * w;
        int o = batch.Row(n, 0, side);
        int i = 0;
        if (block.IsPointJoint)
        {
            PointResponses(batch, inverse, o);
            i = 3;
            o += 3 * stride;
        }

        for (; i < block.Rows; i++, o += stride)
        {
            LaneVector<V>.Transform(batch.Bodies, inverse, LaneVector<V>.Load(batch.Angular, o)).Store(batch.Work.Response, o);
        }
    }

    // I^-1 (r x e) for e = x, y, z, by the columns of I^-1.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void PointResponses(LaneRecords<V> batch, int inverse, int o)
    {
        double[] a = batch.Bodies;
        double[] responses = batch.Work.Response;
        int w = Lane<V>.Width;
        LaneVector<V> r = BilateralRows<V>.BuiltLever(batch.Angular, o);
        Lane<V> xy = Lane<V>.Load(a, inverse + 3 * w), xz = Lane<V>.Load(a, inverse + 4 * w), yz = Lane<V>.Load(a, inverse + 5 * w);
        var x = new LaneVector<V>(Lane<V>.Load(a, inverse), xy, xz);
        var y = new LaneVector<V>(xy, Lane<V>.Load(a, inverse + w), yz);
        var z = new LaneVector<V>(xz, yz, Lane<V>.Load(a, inverse + 2 * w));
        (r.Z * y - r.Y * z).Store(responses, o);
        (r.X * z - r.Z * x).Store(responses, o + 6 * w);
        (r.Y * x - r.X * y).Store(responses, o + 12 * w);
    }

    private static void AddDiagonal(LaneRecords<V> batch, int n, RowBlock block, int side)
    {
        int first = batch.Row(n, 0, side);
        int cell = batch.Shape.Pattern.Diagonal(n) * Lane<V>.Width;
        if (block.IsPointJoint)
        {
            AddPointRotations(batch, first, block, first, block, cell);
        }
        else
        {
            for (int i = 0; i < block.Rows; i++)
            {
                AddRotations(batch, first, i, block, first, i + 1, block, cell + i * block.Rows * Lane<V>.Width);
            }
        }

        AddInverseMasses(batch, block.Bodies[side], block, side, first, block, side, first, cell, true);
    }

    private static void AddLink(LaneRecords<V> batch, in Island.Link link)
    {
        RowBlock later = batch.Shape.Blocks[link.Later];
        RowBlock earlier = batch.Shape.Blocks[link.Earlier];
        int firstI = batch.Row(link.Later, 0, link.LaterSide);
        int firstJ = batch.Row(link.Earlier, 0, link.EarlierSide);
        int cell = link.Block * Lane<V>.Width;
        if (earlier.IsPointJoint)
        {
            AddPointRotations(batch, firstI, later, firstJ, earlier, cell);
        }
        else
        {
            for (int i = 0; i < later.Rows; i++)
            {
                AddRotations(batch, firstI, i, later, firstJ, earlier.Rows, earlier, cell + i * earlier.Rows * Lane<V>.Width);
            }
        }

        AddInverseMasses(batch, link.Body, later, link.LaterSide, firstI, earlier, link.EarlierSide, firstJ, cell, false);
    }

    // Adds the products of a row's response with the angular parts of the first count rows of a block to neighbouring cells.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void AddRotations(LaneRecords<V> batch, int firstI, int i, RowBlock blockI, int firstJ, int count, RowBlock blockJ, int cell)
    {
        double[] rows = batch.Angular;
        double[] matrix = batch.Matrix;
        int w = Lane<V>.Width;
        LaneVector<V> response = LaneVector<V>.Load(batch.Work.Response, firstI + 3 * i * blockI.Bodies.Length * w);
        int stride = 3 * blockJ.Bodies.Length * w;
        for (int end = cell + count * w; cell < end; cell += w, firstJ += stride)
        {
            (Lane<V>.Load(matrix, cell) + LaneVector<V>.Dot(response, LaneVector<V>.Load(rows, firstJ))).Store(matrix, cell);
        }
    }

    // The same for all rows of the first block where the second is an anchor: the products of q with r x e for e = x, y, z are
    // q x r; the two turns of a hinge stay in registers. Of a block with itself the factor does not read what stands above the
    // triangle.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void AddPointRotations(LaneRecords<V> batch, int firstI, RowBlock blockI, int firstJ, RowBlock blockJ, int cell)
    {
        double[] rows = batch.Angular;
        double[] matrix = batch.Matrix;
        int w = Lane<V>.Width;
        int strideI = 3 * blockI.Bodies.Length * w;
        bool isHinge = blockJ.Rows >= HingeRows;
        LaneVector<V> r = BilateralRows<V>.BuiltLever(rows, firstJ);
        LaneVector<V> turn3 = isHinge ? LaneVector<V>.Load(rows, firstJ + 18 * w) : r;
        LaneVector<V> turn4 = isHinge ? LaneVector<V>.Load(rows, firstJ + 24 * w) : r;
        for (int i = 0; i < blockI.Rows; i++, firstI += strideI, cell += blockJ.Rows * w)
        {
            LaneVector<V> q = LaneVector<V>.Load(batch.Work.Response, firstI);
            (LaneVector<V>.Load(matrix, cell) + LaneVector<V>.Cross(q, r)).Store(matrix, cell);
            int j = 3;
            if (isHinge)
            {
                (Lane<V>.Load(matrix, cell + 3 * w) + LaneVector<V>.Dot(q, turn3)).Store(matrix, cell + 3 * w);
                (Lane<V>.Load(matrix, cell + 4 * w) + LaneVector<V>.Dot(q, turn4)).Store(matrix, cell + 4 * w);
                j = HingeRows;
            }

            for (; j < blockJ.Rows; j++)
            {
                Lane<V> product = LaneVector<V>.Dot(q, LaneVector<V>.Load(rows, firstJ + 6 * j * w));
                (Lane<V>.Load(matrix, cell + j * w) + product).Store(matrix, cell + j * w);
            }
        }
    }

    // Adds the products of the linear parts over the mass; the lower triangle alone of a block with itself.
    private static void AddInverseMasses(
        LaneRecords<V> batch, int body, RowBlock blockI, int sideI, int firstI, RowBlock blockJ, int sideJ, int firstJ, int cell, bool isTriangle)
    {
        double[] matrix = batch.Matrix;
        int w = Lane<V>.Width;
        Lane<V> inverseMass = Lane<V>.Load(batch.Bodies, LaneRecords<V>.Body(body, BodyLanes.InverseMass));
        if (blockI.LinearMask == 7 && blockJ.LinearMask == 7)
        {
            Lane<V> share = sideI == sideJ ? inverseMass : Lane<V>.Splat(0) - inverseMass;
            for (int i = 0; i < 3; i++)
            {
                int at = cell + i * (blockJ.Rows + 1) * w;
                (Lane<V>.Load(matrix, at) + share).Store(matrix, at);
            }
        }

        if (!blockI.HasGeneralRows && !blockJ.HasGeneralRows)
        {
            return;
        }

        int strideI = 3 * blockI.Bodies.Length * w;
        int strideJ = 3 * blockJ.Bodies.Length * w;
        for (int i = 0; i < blockI.Rows; i++)
        {
            int end = isTriangle ? i + 1 : blockJ.Rows;
            for (int j = 0; j < end; j++)
            {
                int at = cell + (i * blockJ.Rows + j) * w;
                RowClass classI = blockI.Classes[i];
                RowClass classJ = blockJ.Classes[j];
                if (classI == RowClass.General && classJ == RowClass.General)
                {
                    AddProduct(batch, inverseMass, firstI + i * strideI, firstJ + j * strideJ, at);
                }
                else if (classI == RowClass.General && classJ != RowClass.Angular)
                {
                    AddComponent(batch, inverseMass, firstI + i * strideI + (int)classJ * w, sideJ, at);
                }
                else if (classJ == RowClass.General && classI != RowClass.Angular)
                {
                    AddComponent(batch, inverseMass, firstJ + j * strideJ + (int)classI * w, sideI, at);
                }
            }
        }
    }

    private static void AddProduct(LaneRecords<V> batch, Lane<V> inverseMass, int oi, int oj, int cell)
    {
        Lane<V> product = inverseMass * LaneVector<V>.Dot(LaneVector<V>.Load(batch.Linear, oi), LaneVector<V>.Load(batch.Linear, oj));
        (Lane<V>.Load(batch.Matrix, cell) + product).Store(batch.Matrix, cell);
    }

    // Of a general row with one along an axis of the world, which is reversed on side 1.
    private static void AddComponent(LaneRecords<V> batch, Lane<V> inverseMass, int component, int side, int cell)
    {
        Lane<V> product = inverseMass * Lane<V>.Load(batch.Linear, component);
        Lane<V> sum = Lane<V>.Load(batch.Matrix, cell);
        (side == 0 ? sum + product : sum - product).Store(batch.Matrix, cell);
    }

    private static void Regularise(LaneRecords<V> batch, int n, RowBlock block, double angularShare, double linearShare)
    {
        int cell = batch.Shape.Pattern.Diagonal(n) * Lane<V>.Width;
        if (batch.Shape.IsRedundant)
        {
            int row = batch.Shape.Pattern.Rows[n] * Lane<V>.Width;
            Lane<V> least = batch.Shape.Loops == LoopConsistency.Exact ? LeastResponse(batch, block) : Lane<V>.Splat(double.PositiveInfinity);
            RegulariseLoops(batch, block, row, cell, least, angularShare, linearShare);
        }
        else
        {
            RegulariseTree(batch.Matrix, block, cell);
        }
    }

    private static void RegulariseTree(double[] matrix, RowBlock block, int cell)
    {
        int w = Lane<V>.Width;
        Lane<V> share = Lane<V>.Splat(TreeShare);
        for (int i = 0; i < block.BilateralCount; i++, cell += (block.Rows + 1) * w)
        {
            Lane<V> response = Lane<V>.Load(matrix, cell);
            (response + share * response).Store(matrix, cell);
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

    // Least is infinite where angular rows get their share of the whole diagonal.
    private static void RegulariseLoops(LaneRecords<V> batch, RowBlock block, int row, int cell, Lane<V> least, double angularShare, double linearShare)
    {
        double[] matrix = batch.Matrix;
        int w = Lane<V>.Width;
        for (int i = 0; i < block.BilateralCount; i++, row += w, cell += (block.Rows + 1) * w)
        {
            bool isAngular = block.Classes[i] == RowClass.Angular;
            Lane<V> response = Lane<V>.Load(matrix, cell);
            Lane<V> slow = isAngular ? Lane<V>.Min(response, Lane<V>.Max(least, Lane<V>.Splat(LeastPart) * response)) : response;
            Lane<V> compliance = Lane<V>.Splat(isAngular ? angularShare : linearShare) * slow;
            compliance.Store(batch.Compliance, row);
            (response + compliance).Store(matrix, cell);
        }
    }
}
