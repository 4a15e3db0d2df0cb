using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// The freedoms of the tree, split into those that loops and couplings tie together. Ranks of different blocks add, so each
/// is decomposed by itself; what no row touches is free.
/// </summary>
internal sealed class FreedomBlocks
{
    /// <summary>Splits the freedoms of a linkage.</summary>
    /// <param name="linkage">Whose.</param>
    /// <param name="firsts">For each body the column of its first freedom.</param>
    /// <param name="freedoms">Number of freedoms.</param>
    public FreedomBlocks(Linkage linkage, int[] firsts, int freedoms)
    {
        var sets = new DisjointSets(linkage.BodyCount);
        var touched = new bool[linkage.BodyCount];
        foreach (int joint in linkage.Tree.Closures)
        {
            if (MotionSubspace.Rows(linkage.Joints[joint]) > 0)
            {
                Tie(linkage.Rows.Joints[joint]);
            }
        }

        foreach (RowPath path in linkage.Rows.Couplings)
        {
            Tie(path);
        }

        BlockOf = new int[freedoms];
        var blocks = new List<List<int>>();
        var blockOfSet = new Dictionary<int, int>();
        foreach (int body in linkage.Tree.Order)
        {
            for (int i = 0; i < linkage.Tree.Freedoms[body]; i++)
            {
                int column = firsts[body] + i;
                BlockOf[column] = -1;
                if (!touched[body])
                {
                    continue;
                }

                if (!blockOfSet.TryGetValue(sets.Find(body), out int block))
                {
                    block = blocks.Count;
                    blockOfSet.Add(sets.Find(body), block);
                    blocks.Add(new List<int>());
                }

                BlockOf[column] = block;
                blocks[block].Add(column);
            }
        }

        Columns = blocks;

        void Tie(RowPath path)
        {
            foreach (int body in path.Bodies)
            {
                touched[body] = true;
                sets.Join(path.Bodies[0], body);
            }
        }
    }

    /// <summary>For each block its columns.</summary>
    public IReadOnlyList<IReadOnlyList<int>> Columns { get; }

    /// <summary>For each freedom its block, or -1.</summary>
    public int[] BlockOf { get; }
}
