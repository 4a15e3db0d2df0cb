using System;
using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// A = J M^-1 J^T of the built rows, with a compliance on its diagonal (<see cref="Regularisation{V}"/>); hubs, bodies that many blocks
/// touch, stay in the matrix (<see cref="HubNodes{V}"/>).
/// </summary>
internal static class DelassusMatrix<V>
    where V : struct, ILane<V>
{
    /// <summary>Share of what the largest moments answer that is added for locked angles in RATTLE steps.</summary>
    public const double AngularShare = 1e-4;

    /// <summary>The same of loops that a file has rounded.</summary>
    public const double RoundedShare = 1e-3;

    private const int HingeRows = 5;

    /// <summary>The same in loops whose axes are off, while they are found: softer than a misalignment, harder than a freedom.</summary>
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
        int r = LaneRecords<V>.Body(body, BodyLanes.R);
        LaneVector<V> inverse = LaneVector<V>.Load(a, LaneRecords<V>.Body(body, BodyLanes.InverseInertia));
        LaneVector<V> x = LaneVector<V>.Load(a, r);
        LaneVector<V> y = LaneVector<V>.Load(a, r, 3);
        LaneVector<V> z = LaneVector<V>.Load(a, r, 6);
        LaneVector<V> sx = LaneVector<V>.Scale(inverse, x);
        LaneVector<V> sy = LaneVector<V>.Scale(inverse, y);
        int o = LaneRecords<V>.Body(body, BodyLanes.WorldInverse);
        LaneVector<V>.Dot(sx, x).Store(a, o);
        LaneVector<V>.Dot(sy, y).Store(a, o, 1);
        LaneVector<V>.Dot(LaneVector<V>.Scale(inverse, z), z).Store(a, o, 2);
        LaneVector<V>.Dot(sx, y).Store(a, o, 3);
        LaneVector<V>.Dot(sx, z).Store(a, o, 4);
        LaneVector<V>.Dot(sy, z).Store(a, o, 5);
    }

    /// <summary>Fills the responses of all rows, the matrix from J and the bodies' inverse inertias.</summary>
    public static void Assemble(LaneRecords<V> batch, double angularShare, double linearShare = Regularisation<V>.LinearShare)
    {
        Array.Clear(batch.Matrix, 0, batch.Matrix.Length);
        if (batch.Shape.Hubs.Length > 0)
        {
            HubNodes<V>.Add(batch);
        }

        for (int n = 0; n < batch.Shape.Blocks.Length; n++)
        {
            RowBlock block = batch.Shape.Blocks[n];
            for (int side = 0; side < block.Bodies.Length; side++)
            {
                if (block.Bodies[side] < batch.Shape.MovingBodies)
                {
                    AddSide(batch, n, block, side);
                }
            }

            Regularisation<V>.Add(batch, n, block, angularShare, linearShare);
        }

        foreach (IslandMatrix.BodyLink link in batch.Shape.BodyLinks)
        {
            AddLink(batch, link);
        }
    }

    /// <summary>Keeps the matrix as it is.</summary>
    public static void Keep(LaneRecords<V> batch) => Array.Copy(batch.Matrix, batch.Assembled, batch.Assembled.Length);

    /// <summary>Replaces the matrix by its factor, after all that stands on its diagonal was added.</summary>
    public static void Factor(LaneRecords<V> batch)
    {
        if (batch.Shape.Hubs.Length > 0)
        {
            Keep(batch);
        }

        BlockCholesky<V>.Factor(batch.Shape.Pattern, batch.Matrix, batch.Work.Cancellation);
    }

    /// <summary>Replaces a vector over the rows by what the factored matrix makes of it, A^-1 b.</summary>
    public static void Solve(LaneRecords<V> batch, double[] rows)
    {
        if (batch.Shape.Hubs.Length == 0)
        {
            BlockCholesky<V>.Solve(batch.Shape.Pattern, batch.Matrix, rows);
            return;
        }

        Workspace<V> work = batch.Work;
        int length = batch.Shape.RowCount * Lane<V>.Width;
        Array.Copy(rows, work.Right, length);
        Array.Clear(work.Right, length, work.Right.Length - length);
        IterativeRefinement<V>.Solve(batch.Shape.Pattern, batch.Assembled, batch.Matrix, work.Right, work.Unknowns, work.Correction);
        Array.Copy(work.Unknowns, rows, length);
    }

    // The responses of one body to the rows of a block, and what they add to the block's own cells; that of a hub does not.
    private static void AddSide(LaneRecords<V> batch, int n, RowBlock block, int side)
    {
        int w = Lane<V>.Width;
        int body = block.Bodies[side];
        int inverse = LaneRecords<V>.Body(body, BodyLanes.WorldInverse);
        int stride = 3 * block.Bodies.Length * w;
        int first = batch.Row(n, 0, side);
        int cell = batch.Shape.Pattern.Diagonal(n) * w;
        bool isHub = batch.Shape.IsHub(body);
        if (block.IsPointJoint && !isHub)
        {
            AddAnchor(batch, body, first, cell, block.Rows * w);
            for (int i = 3; i < block.Rows; i++)
            {
                AddTurn(batch, body, first, first + i * stride, cell + i * block.Rows * w);
            }

            return;
        }

        for (int i = 0; i < block.Rows; i++)
        {
            int o = first + i * stride;
            LaneVector<V>.Transform(batch.Bodies, inverse, 0, LaneVector<V>.Load(batch.Angular, o)).Store(batch.Work.Response, o);
            if (!isHub)
            {
                AddRotations(batch, first, i, block, first, i + 1, block, cell + i * block.Rows * w);
            }
        }

        if (!isHub)
        {
            AddInverseMasses(batch, body, block, side, first, block, side, first, cell, true);
        }
    }

    // The same of the three rows of an anchor, r x e for e = x, y, z: their responses are I^-1 (r x e), by the columns of I^-1, and the products of a
    // response q with them are q x r. The factor does not read what stands above the triangle.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void AddAnchor(LaneRecords<V> batch, int body, int o, int cell, int line)
    {
        double[] a = batch.Bodies;
        double[] matrix = batch.Matrix;
        double[] responses = batch.Work.Response;
        int at = LaneRecords<V>.Body(body, 0);
        LaneVector<V> r = BilateralRows<V>.BuiltLever(batch.Angular, o);
        Lane<V> mass = Lane<V>.Load(a, at, BodyLanes.InverseMass);
        Lane<V> xy = Lane<V>.Load(a, at, BodyLanes.WorldInverse + 3), xz = Lane<V>.Load(a, at, BodyLanes.WorldInverse + 4), yz = Lane<V>.Load(a, at, BodyLanes.WorldInverse + 5);
        var x = new LaneVector<V>(Lane<V>.Load(a, at, BodyLanes.WorldInverse), xy, xz);
        var y = new LaneVector<V>(xy, Lane<V>.Load(a, at, BodyLanes.WorldInverse + 1), yz);
        var z = new LaneVector<V>(xz, yz, Lane<V>.Load(a, at, BodyLanes.WorldInverse + 2));
        LaneVector<V> q = r.Z * y - r.Y * z;
        q.Store(responses, o);
        (Lane<V>.Load(matrix, cell) + (q.Y * r.Z - q.Z * r.Y) + mass).Store(matrix, cell);
        cell += line;
        q = r.X * z - r.Z * x;
        q.Store(responses, o, 6);
        (Lane<V>.Load(matrix, cell) + (q.Y * r.Z - q.Z * r.Y)).Store(matrix, cell);
        (Lane<V>.Load(matrix, cell, 1) + (q.Z * r.X - q.X * r.Z) + mass).Store(matrix, cell, 1);
        cell += line;
        q = r.Y * x - r.X * y;
        q.Store(responses, o, 12);
        LaneVector<V> product = LaneVector<V>.Cross(q, r);
        (Lane<V>.Load(matrix, cell) + product.X).Store(matrix, cell);
        (Lane<V>.Load(matrix, cell, 1) + product.Y).Store(matrix, cell, 1);
        (Lane<V>.Load(matrix, cell, 2) + product.Z + mass).Store(matrix, cell, 2);
    }

    // And of one of its turns, which stand behind them.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void AddTurn(LaneRecords<V> batch, int body, int o, int turn, int cell)
    {
        double[] rows = batch.Angular;
        double[] matrix = batch.Matrix;
        int w = Lane<V>.Width;
        LaneVector<V> q = LaneVector<V>.Transform(batch.Bodies, LaneRecords<V>.Body(body, 0), BodyLanes.WorldInverse, LaneVector<V>.Load(rows, turn));
        q.Store(batch.Work.Response, turn);
        (LaneVector<V>.Load(matrix, cell) + LaneVector<V>.Cross(q, BilateralRows<V>.BuiltLever(rows, o))).Store(matrix, cell);
        int to = cell + 3 * w;
        for (int other = o + 18 * w; other <= turn; other += 6 * w, to += w)
        {
            (Lane<V>.Load(matrix, to) + LaneVector<V>.Dot(q, LaneVector<V>.Load(rows, other))).Store(matrix, to);
        }
    }

    private static void AddLink(LaneRecords<V> batch, in IslandMatrix.BodyLink link)
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

    // The same for all rows of the first block where the second is an anchor; the two turns of a hinge stay in registers.
    [MethodImpl(MethodImplOptions.NoInlining)]
    private static void AddPointRotations(LaneRecords<V> batch, int firstI, RowBlock blockI, int firstJ, RowBlock blockJ, int cell)
    {
        double[] rows = batch.Angular;
        double[] matrix = batch.Matrix;
        int w = Lane<V>.Width;
        int strideI = 3 * blockI.Bodies.Length * w;
        bool isHinge = blockJ.Rows >= HingeRows;
        LaneVector<V> r = BilateralRows<V>.BuiltLever(rows, firstJ);
        LaneVector<V> turn3 = isHinge ? LaneVector<V>.Load(rows, firstJ, 18) : r;
        LaneVector<V> turn4 = isHinge ? LaneVector<V>.Load(rows, firstJ, 24) : r;
        for (int i = 0; i < blockI.Rows; i++, firstI += strideI, cell += blockJ.Rows * w)
        {
            LaneVector<V> q = LaneVector<V>.Load(batch.Work.Response, firstI);
            (LaneVector<V>.Load(matrix, cell) + LaneVector<V>.Cross(q, r)).Store(matrix, cell);
            int j = 3;
            if (isHinge)
            {
                (Lane<V>.Load(matrix, cell, 3) + LaneVector<V>.Dot(q, turn3)).Store(matrix, cell, 3);
                (Lane<V>.Load(matrix, cell, 4) + LaneVector<V>.Dot(q, turn4)).Store(matrix, cell, 4);
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
}
