using System;
using System.Collections.Generic;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Which joints of an island lie on loops, and on which: the biconnected components of the graph of bodies and joints, all that does not move being
/// one body. Loops that share a body alone, or are linked by open chains, are apart.
/// Source: Hopcroft and Tarjan 1973, Algorithm 447; with a stack of its own, since chains may be long.
/// </summary>
internal sealed class JointLoops
{
    private readonly List<(int Block, int Body)>[] _joints;
    private readonly int[] _depths;
    private readonly int[] _lowest;
    private readonly bool[] _isTaken;
    private readonly List<int> _open = new();
    private readonly List<int[]> _found = new();

    private JointLoops(Island island)
    {
        int fixedBody = island.MovingBodies;
        _joints = new List<(int Block, int Body)>[fixedBody + 1];
        for (int body = 0; body < _joints.Length; body++)
        {
            _joints[body] = new List<(int Block, int Body)>();
        }

        for (int n = 0; n < island.Blocks.Length; n++)
        {
            if (island.Blocks[n].Joint != null)
            {
                int one = Math.Min(island.Blocks[n].Bodies[0], fixedBody), other = Math.Min(island.Blocks[n].Bodies[1], fixedBody);
                _joints[one].Add((n, other));
                _joints[other].Add((n, one));
            }
        }

        _depths = new int[_joints.Length];
        _lowest = new int[_joints.Length];
        _isTaken = new bool[island.Blocks.Length];
    }

    /// <summary>Of each loop, or of loops that share more than one body, the island's blocks in ascending order.</summary>
    public static List<int[]> Of(Island island)
    {
        var loops = new JointLoops(island);
        for (int body = 0; body < loops._joints.Length; body++)
        {
            if (loops._depths[body] == 0)
            {
                loops.Search(body);
            }
        }

        return loops._found;
    }

    // Depth first: a body from which no joint leads back above the one that it was reached from ends a component there.
    private void Search(int root)
    {
        var path = new Stack<(int Body, int Next, int FirstOpen)>();
        Enter(path, root, 1, 0);
        while (path.Count > 0)
        {
            (int body, int next, int firstOpen) = path.Pop();
            if (next < _joints[body].Count)
            {
                path.Push((body, next + 1, firstOpen));
                (int block, int other) = _joints[body][next];
                if (_isTaken[block])
                {
                    continue;
                }

                _isTaken[block] = true;
                _open.Add(block);
                if (_depths[other] == 0)
                {
                    Enter(path, other, _depths[body] + 1, _open.Count - 1);
                }
                else
                {
                    _lowest[body] = Math.Min(_lowest[body], _depths[other]);
                }
            }
            else if (path.Count > 0)
            {
                int above = path.Peek().Body;
                _lowest[above] = Math.Min(_lowest[above], _lowest[body]);
                if (_lowest[body] >= _depths[above])
                {
                    Close(firstOpen);
                }
            }
        }
    }

    private void Enter(Stack<(int Body, int Next, int FirstOpen)> path, int body, int depth, int firstOpen)
    {
        _depths[body] = depth;
        _lowest[body] = depth;
        path.Push((body, 0, firstOpen));
    }

    // A joint alone is no loop.
    private void Close(int firstOpen)
    {
        int[] blocks = _open.GetRange(firstOpen, _open.Count - firstOpen).ToArray();
        _open.RemoveRange(firstOpen, blocks.Length);
        if (blocks.Length > 1)
        {
            Array.Sort(blocks);
            _found.Add(blocks);
        }
    }
}
