using System.Linq;
using Kinefab.Dynamics.Rattle;
using Kinefab.Joints;
using Kinefab.Numerics;
using NUnit.Framework;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Loops that hang together by one body or by open chains are told apart; all that does not move is one body.</summary>
internal sealed class JointLoopsTests
{
    // Hinges between bodies that are given by number, -1 the world; the joints of each loop.
    [TestCase("-1 0, 0 1, 1 2", "")]
    [TestCase("-1 0, 0 1, 1 2, 2 -1", "0 1 2 3")]
    [TestCase("0 1, 1 2, 2 0", "0 1 2")]
    [TestCase("0 1, 0 1", "0 1")]
    [TestCase("-1 0, 0 1, 1 2, 2 0, 2 3, 3 4, 4 5, 5 3", "1 2 3; 5 6 7")]
    [TestCase("-1 0, 0 1, 1 -1, 0 2, 2 3, 3 0", "0 1 2; 3 4 5")]
    [TestCase("-1 0, 0 -1, 0 1, 1 2, 2 0", "0 1; 2 3 4")]
    [TestCase("0 1, 1 2, 2 3, 3 0, 1 3, 3 4", "0 1 2 3 4")]
    public void Of_Joints_LoopsApart(string joints, string loops)
    {
        int[][] pairs = joints.Split(", ").Select(pair => pair.Split(' ').Select(int.Parse).ToArray()).ToArray();
        var b = new MechanismBuilder();
        for (int body = 0; body <= pairs.Max(pair => pair.Max()); body++)
        {
            b.Bar(new Vector3d(body, 0, 0), new Vector3d(body + 1, 0, 0), 1);
        }

        foreach (int[] pair in pairs)
        {
            b.Hinge(pair[0] < 0 ? JointModel.World : pair[0], pair[1] < 0 ? JointModel.World : pair[1], Vector3d.Zero, Vector3d.UnitZ);
        }

        Island island = IslandFinder.Find(b.Build()).Single();
        Assert.That(string.Join("; ", JointLoops.Of(island).Select(loop => string.Join(' ', loop)).OrderBy(loop => loop)), Is.EqualTo(loops));
    }
}
