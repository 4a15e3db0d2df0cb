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
/// Hubs, bodies that many blocks touch, stay in the matrix: see <see cref="Island.Hubs"/>.
/// </summary>
internal static class DelassusMatrix<V>
    where V : struct, ILane<V>
{
    // Share added to the diagonal for anchors.
    private const double LinearShare = 1e-6;

    /// <summary>Share of what the largest moments answer that is added for locked angles in RATTLE steps.</summary>
    public const double AngularShare = 1e-4;

    /// <summary>The same of loops that a file has rounded.</summary>
    public const double RoundedShare = 1e-3;

    private const int HingeRows = 5;

    // A hub's unknowns, and the numbers of its roots.
    private const int HubRows = 6;
    private const int RootCount = 11;

    // Share of the trace of an inverse inertia under which what is left of it is rounding: of an axis of infinite moment. A row along one has as
    // much on its diagonal, as it has by rounding where the body is eliminated: with less, the rounding of its speed were a large impulse.
    private const double LeastRoot = 1e-15;

    // Against rounding alone.
    private const double TreeShare = 1e-12;

    // Least part of the diagonal of which an angular row gets its share: keeps the pivots of needles above rounding.
    private const double LeastPart = 1e-5;

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
    public static void Assemble(LaneRecords<V> batch, double angularShare, double linearShare = LinearShare)
    {
        Array.Clear(batch.Matrix, 0, batch.Matrix.Length);
        if (batch.Shape.Hubs.Length > 0)
        {
            AddHubs(batch);
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

            Regularise(batch, n, block, angularShare, linearShare);
        }

        foreach (Island.Link link in batch.Shape.Links)
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

    private static void AddHubs(LaneRecords<V> batch)
    {
        Island shape = batch.Shape;
        int w = Lane<V>.Width;
        Array.Clear(batch.Work.HubResponse, 0, batch.Work.HubResponse.Length);
        for (int hub = 0; hub < shape.Hubs.Length; hub++)
        {
            WriteRoots(batch, shape.Hubs[hub], RootCount * hub * w);
            int diagonal = shape.Pattern.Diagonal(shape.Blocks.Length + hub);
            for (int i = 0; i < HubRows; i++)
            {
                Lane<V>.Splat(-1).Store(batch.Matrix, (diagonal + i * (HubRows + 1)) * w);
            }
        }

        foreach (Island.HubLink link in shape.HubLinks)
        {
            AddHub(batch, link);
        }
    }

    // Of the mass, and of the inverse inertia three columns, by Cholesky's rule with the largest pivot first: 0 for an infinite moment.
    private static void WriteRoots(LaneRecords<V> batch, int body, int to)
    {
        int w = Lane<V>.Width;
        int inverse = LaneRecords<V>.Body(body, BodyLanes.WorldInverse);
        Lane<V>.Sqrt(Lane<V>.Load(batch.Bodies, LaneRecords<V>.Body(body, BodyLanes.InverseMass))).Store(batch.Work.HubRoots, to);
        LaneVector<V> diagonal = LaneVector<V>.Load(batch.Bodies, inverse), off = LaneVector<V>.Load(batch.Bodies, inverse, 3);
        var x = new LaneVector<V>(diagonal.X, off.X, off.Y);
        var y = new LaneVector<V>(off.X, diagonal.Y, off.Z);
        var z = new LaneVector<V>(off.Y, off.Z, diagonal.Z);
        Lane<V> least = Lane<V>.Splat(LeastRoot) * (x.X + y.Y + z.Z);
        for (int column = 0; column < 3; column++)
        {
            to += column == 0 ? w : 3 * w;
            LaneVector<V> root = Root(x, y, z, least);
            root.Store(batch.Work.HubRoots, to);
            x -= root.X * root;
            y -= root.Y * root;
            z -= root.Z * root;
        }

        least.Store(batch.Work.HubRoots, to, 3);
    }

    // The column of the largest diagonal entry over its root.
    private static LaneVector<V> Root(LaneVector<V> x, LaneVector<V> y, LaneVector<V> z, Lane<V> least)
    {
        Lane<V> largest = Lane<V>.Max(x.X, y.Y);
        LaneVector<V> column = LaneVector<V>.Select(largest - y.Y, x, y);
        largest = Lane<V>.Max(largest, z.Z);
        column = LaneVector<V>.Select(largest - z.Z, column, z);
        Lane<V> zero = Lane<V>.Splat(0);
        return LaneVector<V>.Select(Lane<V>.Max(largest - least, zero), (Lane<V>.Splat(1) / Lane<V>.Sqrt(largest)) * column, new LaneVector<V>(zero, zero, zero));
    }

    // J W of one block's rows over a hub.
    private static void AddHub(LaneRecords<V> batch, in Island.HubLink link)
    {
        double[] roots = batch.Work.HubRoots;
        int w = Lane<V>.Width;
        RowBlock block = batch.Shape.Blocks[link.Node];
        int stride = 3 * block.Bodies.Length * w;
        int o = batch.Row(link.Node, 0, link.Side);
        int r = RootCount * link.Hub * w;
        int row = batch.Shape.Pattern.Rows[link.Node] * w;
        int cell = link.Block * w;
        int step = (link.IsHubLater ? block.Rows : 1) * w;
        int diagonal = batch.Shape.Pattern.Diagonal(link.Node) * w;
        for (int i = 0; i < block.Rows; i++, o += stride, row += w, diagonal += (block.Rows + 1) * w, cell += link.IsHubLater ? w : HubRows * w)
        {
            LaneVector<V> linear = Lane<V>.Load(roots, r) * LinearPart(batch, block, i, link.Side, o);
            LaneVector<V> angular = LaneVector<V>.Load(batch.Angular, o);
            var turned = new LaneVector<V>(
                LaneVector<V>.Dot(LaneVector<V>.Load(roots, r, 1), angular),
                LaneVector<V>.Dot(LaneVector<V>.Load(roots, r, 4), angular),
                LaneVector<V>.Dot(LaneVector<V>.Load(roots, r, 7), angular));
            linear.X.Store(batch.Matrix, cell);
            linear.Y.Store(batch.Matrix, cell + step);
            linear.Z.Store(batch.Matrix, cell + 2 * step);
            turned.X.Store(batch.Matrix, cell + 3 * step);
            turned.Y.Store(batch.Matrix, cell + 4 * step);
            turned.Z.Store(batch.Matrix, cell + 5 * step);
            Lane<V> rounding = Lane<V>.Load(roots, r, 10) * LaneVector<V>.Dot(angular, angular);
            (Lane<V>.Load(batch.Matrix, diagonal) + rounding).Store(batch.Matrix, diagonal);
            Lane<V> response = LaneVector<V>.Dot(linear, linear) + LaneVector<V>.Dot(turned, turned);
            (Lane<V>.Load(batch.Work.HubResponse, row) + response).Store(batch.Work.HubResponse, row);
        }
    }

    private static LaneVector<V> LinearPart(LaneRecords<V> batch, RowBlock block, int row, int side, int at)
    {
        if (block.Classes[row] == RowClass.General)
        {
            return LaneVector<V>.Load(batch.Linear, at);
        }

        Lane<V> zero = Lane<V>.Splat(0);
        Lane<V> one = Lane<V>.Splat(side == 0 ? 1 : -1);
        RowClass along = block.Classes[row];
        return new LaneVector<V>(along == RowClass.UnitX ? one : zero, along == RowClass.UnitY ? one : zero, along == RowClass.UnitZ ? one : zero);
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

    private static void Regularise(LaneRecords<V> batch, int n, RowBlock block, double angularShare, double linearShare)
    {
        int cell = batch.Shape.Pattern.Diagonal(n) * Lane<V>.Width;
        int row = batch.Shape.Pattern.Rows[n] * Lane<V>.Width;
        if (batch.Shape.IsRedundant)
        {
            Lane<V> least = batch.CompliantStep > 0 ? Lane<V>.Load(batch.Work.CompliantInertia, 0)
                : batch.Shape.Loops == LoopConsistency.Exact ? LeastResponse(batch, block)
                : Lane<V>.Splat(double.PositiveInfinity);
            Lane<V> still = batch.Shape.LockedInertiaBodies.Length > 0 ? Lane<V>.Splat(LeastPart) * LeastResponse(batch, block) : Lane<V>.Splat(0);
            RegulariseLoops(batch, block, row, cell, least, still, angularShare, linearShare);
        }
        else
        {
            RegulariseTree(batch, block, row, cell);
        }
    }

    private static void RegulariseTree(LaneRecords<V> batch, RowBlock block, int row, int cell)
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
    private static void RegulariseLoops(LaneRecords<V> batch, RowBlock block, int row, int cell, Lane<V> least, Lane<V> still, double angularShare, double linearShare)
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
