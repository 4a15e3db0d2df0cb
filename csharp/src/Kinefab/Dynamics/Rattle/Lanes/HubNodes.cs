using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Hubs as nodes of the matrix: [., J W; W^T J^T, -1] with W W^T = M^-1 of the hub, whose Schur complement is J M^-1 J^T over it, see
/// <see cref="Island.Hubs"/>.
/// </summary>
internal static class HubNodes<V>
    where V : struct, ILane<V>
{
    // The numbers of a hub's roots: of the inverse mass, and three columns of that of the inverse inertia, then the least.
    private const int RootCount = 11;

    // Share of the trace of an inverse inertia under which what is left of it is rounding: of an axis of infinite moment. A row along one has as
    // much on its diagonal, as it has by rounding where the body is eliminated: with less, the rounding of its speed were a large impulse.
    private const double LeastRoot = 1e-15;

    /// <summary>The hubs' own cells, and those of the blocks that touch them; clears and fills <see cref="Workspace{V}.HubResponse"/>.</summary>
    public static void Add(LaneRecords<V> batch)
    {
        Island shape = batch.Shape;
        int w = Lane<V>.Width;
        Array.Clear(batch.Work.HubResponse, 0, batch.Work.HubResponse.Length);
        for (int hub = 0; hub < shape.Hubs.Length; hub++)
        {
            WriteRoots(batch, shape.Hubs[hub], RootCount * hub * w);
            int diagonal = shape.Pattern.Diagonal(shape.Blocks.Length + hub);
            for (int i = 0; i < IslandMatrix.HubRows; i++)
            {
                Lane<V>.Splat(-1).Store(batch.Matrix, (diagonal + i * (IslandMatrix.HubRows + 1)) * w);
            }
        }

        foreach (IslandMatrix.HubLink link in shape.HubLinks)
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
    private static void AddHub(LaneRecords<V> batch, in IslandMatrix.HubLink link)
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
        for (int i = 0; i < block.Rows; i++, o += stride, row += w, diagonal += (block.Rows + 1) * w, cell += link.IsHubLater ? w : IslandMatrix.HubRows * w)
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
}
