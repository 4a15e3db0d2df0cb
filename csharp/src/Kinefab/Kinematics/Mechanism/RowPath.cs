using System.Collections.Generic;

namespace Kinefab.Kinematics;

/// <summary>The bodies whose freedoms one row depends on, and where each one's entries stand in the packed row.</summary>
internal sealed class RowPath
{
    public readonly int[] Bodies;

    /// <summary>+1 where the body's motion adds to that of the row's body 0, -1 where it adds to body 1's.</summary>
    public readonly double[] Signs;

    /// <summary>For each body its first entry; one more: their number.</summary>
    public readonly int[] Starts;

    public RowPath(IReadOnlyList<int> bodies, IReadOnlyList<double> signs, int[] freedoms)
    {
        Bodies = new int[bodies.Count];
        Signs = new double[bodies.Count];
        Starts = new int[bodies.Count + 1];
        for (int k = 0; k < Bodies.Length; k++)
        {
            Bodies[k] = bodies[k];
            Signs[k] = signs[k];
            Starts[k + 1] = Starts[k] + freedoms[bodies[k]];
        }
    }

    /// <summary>Entries of the packed row.</summary>
    public int Width => Starts[Bodies.Length];

    /// <summary>The path of the relative motion of two bodies.</summary>
    public static RowPath Between(KinematicTree tree, int body0, int body1)
    {
        var bodies = new List<int>();
        var signs = new List<double>();
        tree.Between(body0, body1, bodies, signs);
        return new RowPath(bodies, signs, tree.Freedoms);
    }

    /// <summary>All bodies of some paths, each once; the signs hold for the first path that has the body.</summary>
    public static RowPath Union(IEnumerable<RowPath> paths, int[] freedoms)
    {
        var bodies = new List<int>();
        var signs = new List<double>();
        var seen = new HashSet<int>();
        foreach (RowPath path in paths)
        {
            for (int k = 0; k < path.Bodies.Length; k++)
            {
                if (seen.Add(path.Bodies[k]))
                {
                    bodies.Add(path.Bodies[k]);
                    signs.Add(path.Signs[k]);
                }
            }
        }

        return new RowPath(bodies, signs, freedoms);
    }
}
