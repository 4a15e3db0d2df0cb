using System;
using System.Runtime.CompilerServices;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// A = J M^-1 J^T of the built rows, regularised: a share of each diagonal is added to it, 1e-6 for rows with a linear
/// part and 1e-3 for angular ones, so that redundant rows share their load evenly (least norm) instead of making A
/// singular. What they are solved for is the true residual, so consistent loops still close to the tolerance.
/// </summary>
internal static class ResponseMatrix<V>
    where V : struct, ILane<V>
{
    /// <summary>Share added to the diagonal for anchors, and for locked angles in RATTLE steps.</summary>
    public const double LinearShare = 1e-6;
    public const double AngularShare = 1e-3;

    /// <summary>World inverse inertias from R and the principal moments.</summary>
    public static void InverseInertias(Batch<V> batch)
    {
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            InverseInertia(batch.Bodies, body);
        }
    }

    // R I^-1 R^T.
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void InverseInertia(double[] a, int body)
    {
        int w = Lane<V>.Width;
        int r = Batch<V>.Body(body, BodySlot.R);
        LaneVector<V> inverse = LaneVector<V>.Load(a, Batch<V>.Body(body, BodySlot.InverseInertia));
        LaneVector<V> x = LaneVector<V>.Load(a, r);
        LaneVector<V> y = LaneVector<V>.Load(a, r + 3 * w);
        LaneVector<V> z = LaneVector<V>.Load(a, r + 6 * w);
        LaneVector<V> sx = LaneVector<V>.Scale(inverse, x);
        LaneVector<V> sy = LaneVector<V>.Scale(inverse, y);
        int o = Batch<V>.Body(body, BodySlot.WorldInverse);
        LaneVector<V>.Dot(sx, x).Store(a, o);
        LaneVector<V>.Dot(sy, y).Store(a, o + w);
        LaneVector<V>.Dot(LaneVector<V>.Scale(inverse, z), z).Store(a, o + 2 * w);
        LaneVector<V>.Dot(sx, y).Store(a, o + 3 * w);
        LaneVector<V>.Dot(sx, z).Store(a, o + 4 * w);
        LaneVector<V>.Dot(sy, z).Store(a, o + 5 * w);
    }

    /// <summary>Fills the responses of all rows, the matrix and its diagonal from J and the bodies' inverse inertias.</summary>
    public static void Assemble(Batch<V> batch, double angularShare)
    {
        Array.Clear(batch.Matrix, 0, batch.Matrix.Length);
        for (int n = 0; n < batch.Shape.Nodes.Length; n++)
        {
            Node node = batch.Shape.Nodes[n];
            for (int side = 0; side < node.Bodies.Length; side++)
            {
                if (node.Bodies[side] < batch.Shape.MovingBodies)
                {
                    Responses(batch, n, node, side);
                    AddDiagonal(batch, n, node, side);
                }
            }

            Regularise(batch, n, node, angularShare);
        }

        foreach (Island.Link link in batch.Shape.Links)
        {
            AddLink(batch, link);
        }
    }

    /// <summary>The world inverse inertia of a body times a vector.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static LaneVector<V> Turn(double[] bodies, int inverse, LaneVector<V> v)
    {
        int w = Lane<V>.Width;
        Lane<V> xy = Lane<V>.Load(bodies, inverse + 3 * w);
        Lane<V> xz = Lane<V>.Load(bodies, inverse + 4 * w);
        Lane<V> yz = Lane<V>.Load(bodies, inverse + 5 * w);
        return new LaneVector<V>(
            Lane<V>.Load(bodies, inverse) * v.X + xy * v.Y + xz * v.Z,
            xy * v.X + Lane<V>.Load(bodies, inverse + w) * v.Y + yz * v.Z,
            xz * v.X + yz * v.Y + Lane<V>.Load(bodies, inverse + 2 * w) * v.Z);
    }

    private static void Responses(Batch<V> batch, int n, Node node, int side)
    {
        double[] rows = batch.Rows;
        int w = Lane<V>.Width;
        int inverse = Batch<V>.Body(node.Bodies[side], BodySlot.WorldInverse);
        int stride = node.Bodies.Length * Batch<V>.SideCount * w;
        int o = batch.Row(n, 0, side, 0);
        for (int i = 0; i < node.Rows; i++, o += stride)
        {
            Turn(batch.Bodies, inverse, LaneVector<V>.Load(rows, o + Batch<V>.Angular * w)).Store(rows, o + Batch<V>.Response * w);
        }
    }

    private static void AddDiagonal(Batch<V> batch, int n, Node node, int side)
    {
        double[] rows = batch.Rows;
        double[] matrix = batch.Matrix;
        int w = Lane<V>.Width;
        Lane<V> inverseMass = Lane<V>.Load(batch.Bodies, Batch<V>.Body(node.Bodies[side], BodySlot.InverseMass));
        int stride = node.Bodies.Length * Batch<V>.SideCount * w;
        int first = batch.Row(n, 0, side, 0);
        int block = batch.Shape.Pattern.Diagonal(n) * w;
        for (int i = 0; i < node.Rows; i++)
        {
            int oi = first + i * stride;
            LaneVector<V> response = LaneVector<V>.Load(rows, oi + Batch<V>.Response * w);
            int cell = block + i * node.Rows * w;
            for (int j = 0; j <= i; j++, cell += w)
            {
                int oj = first + j * stride;
                Lane<V> s = Lane<V>.Load(matrix, cell)
                    + LaneVector<V>.Dot(response, LaneVector<V>.Load(rows, oj + Batch<V>.Angular * w));
                AddLinear(ref s, rows, inverseMass, node.Classes[i], oi, side, node.Classes[j], oj, side);
                s.Store(matrix, cell);
            }
        }
    }

    private static void AddLink(Batch<V> batch, in Island.Link link)
    {
        double[] rows = batch.Rows;
        double[] matrix = batch.Matrix;
        int w = Lane<V>.Width;
        Lane<V> inverseMass = Lane<V>.Load(batch.Bodies, Batch<V>.Body(link.Body, BodySlot.InverseMass));
        Node later = batch.Shape.Nodes[link.Later];
        Node earlier = batch.Shape.Nodes[link.Earlier];
        int strideI = later.Bodies.Length * Batch<V>.SideCount * w;
        int strideJ = earlier.Bodies.Length * Batch<V>.SideCount * w;
        int firstI = batch.Row(link.Later, 0, link.LaterSide, 0);
        int firstJ = batch.Row(link.Earlier, 0, link.EarlierSide, 0);
        int cell = link.Block * w;
        for (int i = 0; i < later.Rows; i++)
        {
            int oi = firstI + i * strideI;
            LaneVector<V> response = LaneVector<V>.Load(rows, oi + Batch<V>.Response * w);
            for (int j = 0; j < earlier.Rows; j++, cell += w)
            {
                int oj = firstJ + j * strideJ;
                Lane<V> s = Lane<V>.Load(matrix, cell)
                    + LaneVector<V>.Dot(response, LaneVector<V>.Load(rows, oj + Batch<V>.Angular * w));
                AddLinear(ref s, rows, inverseMass, later.Classes[i], oi, link.LaterSide, earlier.Classes[j], oj, link.EarlierSide);
                s.Store(matrix, cell);
            }
        }
    }

    // Adds the linear parts' product over the mass.
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private static void AddLinear(
        ref Lane<V> sum, double[] rows, Lane<V> inverseMass, RowClass classI, int oi, int sideI, RowClass classJ, int oj, int sideJ)
    {
        if (classI == RowClass.Angular || classJ == RowClass.Angular)
        {
            return;
        }

        int w = Lane<V>.Width;
        if (classI != RowClass.General && classJ != RowClass.General)
        {
            if (classI == classJ)
            {
                sum = sideI == sideJ ? sum + inverseMass : sum - inverseMass;
            }
        }
        else if (classI == RowClass.General && classJ == RowClass.General)
        {
            sum += inverseMass * LaneVector<V>.Dot(LaneVector<V>.Load(rows, oi), LaneVector<V>.Load(rows, oj));
        }
        else
        {
            int unitSide = classI == RowClass.General ? sideJ : sideI;
            int component = classI == RowClass.General ? oi + (int)classJ * w : oj + (int)classI * w;
            Lane<V> product = inverseMass * Lane<V>.Load(rows, component);
            sum = unitSide == 0 ? sum + product : sum - product;
        }
    }

    private static void Regularise(Batch<V> batch, int n, Node node, double angularShare)
    {
        double[] matrix = batch.Matrix;
        int w = Lane<V>.Width;
        int block = batch.Shape.Pattern.Diagonal(n);
        int row = batch.Shape.Pattern.Rows[n];
        for (int i = 0; i < node.Rows; i++)
        {
            int cell = (block + i * (node.Rows + 1)) * w;
            Lane<V> s = Lane<V>.Load(matrix, cell);
            s.Store(batch.Diagonal, (row + i) * w);
            if (i < node.RigidRows)
            {
                double share = node.Classes[i] == RowClass.Angular ? angularShare : LinearShare;
                (s * Lane<V>.Splat(1 + share)).Store(matrix, cell);
            }
        }
    }
}
