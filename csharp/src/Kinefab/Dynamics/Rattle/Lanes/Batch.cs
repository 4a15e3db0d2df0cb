using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The numbers of up to Width islands of one shape, side by side: number i of a record stands at i * Width + lane. All
/// arrays are made beforehand; a step only writes into them.
/// </summary>
internal sealed class Batch<V>
    where V : struct, ILane<V>
{
    /// <summary>Numbers of a joint: see <see cref="Frame"/> and <see cref="Placed"/>.</summary>
    public const int JointCount = 48;

    /// <param name="shape">What all its islands look like.</param>
    /// <param name="workspace">Arrays that hold nothing from step to step, shared by the batches of a shape.</param>
    public Batch(Island shape, Workspace<V> workspace)
    {
        Shape = shape;
        Work = workspace;
        int w = Width;
        AngularShare = shape.Fit switch
        {
            LoopFit.Inexact => ResponseMatrix<V>.InexactShare,
            LoopFit.Loose => ResponseMatrix<V>.LooseShare,
            _ => ResponseMatrix<V>.AngularShare,
        };
        Compliance = new double[shape.Pattern.RowCount * w];
        Members = new int[shape.Bodies.Length * w];
        JointMembers = new int[shape.Nodes.Length * w];
        Bodies = new double[shape.Bodies.Length * BodySlot.Count * w];
        Joints = new double[shape.Nodes.Length * JointCount * w];
        RowOffsets = new int[shape.Nodes.Length];
        int sides = 0;
        for (int n = 0; n < shape.Nodes.Length; n++)
        {
            RowOffsets[n] = sides;
            sides += shape.Nodes[n].Rows * shape.Nodes[n].Bodies.Length;
        }

        Linear = new double[3 * sides * w];
        Angular = new double[3 * sides * w];
        Matrix = new double[shape.Pattern.Length * w];
        Half = new double[shape.Pattern.RowCount * w];
        if (shape.Laws > 0)
        {
            Laws = new Laws<V>(this);
        }
    }

    public static int Width => Lane<V>.Width;

    public Island Shape { get; }

    /// <summary>Body b of a lane in the mechanism (or Joint.World), at b * Width + lane.</summary>
    public int[] Members { get; }

    /// <summary>Joint of node n of a lane in the mechanism, at n * Width + lane; not set for couplings.</summary>
    public int[] JointMembers { get; }

    /// <summary>Records of <see cref="BodySlot"/>.</summary>
    public double[] Bodies { get; }

    /// <summary>Records of <see cref="JointCount"/>.</summary>
    public double[] Joints { get; }

    /// <summary>Linear and angular J: for each node, row and side a vector. Linear is read for <see cref="RowClass.General"/> alone.</summary>
    public double[] Linear { get; }

    public double[] Angular { get; }

    /// <summary>Vectors before each node's in these.</summary>
    public int[] RowOffsets { get; }

    /// <summary>A = J M^-1 J^T, then its factor.</summary>
    public double[] Matrix { get; }

    /// <summary>Impulses of the velocity projection, by which the next step starts.</summary>
    public double[] Half { get; }

    /// <summary>What holds nothing from step to step.</summary>
    public Workspace<V> Work { get; }

    /// <summary>Rows with a law, or null without any.</summary>
    public Laws<V>? Laws { get; }

    /// <summary>Anchor and three frame axes of a joint in its body 0 or 1, in the joint's record.</summary>
    public static int Frame(int side) => 12 * side;

    /// <summary>Lever (anchor from the centre of mass) and frame axes in the world's axes, where they were last evaluated.</summary>
    public static int Placed(int side) => 24 + 12 * side;

    /// <summary>Index of a number of a body in <see cref="Bodies"/>.</summary>
    public static int Body(int body, int slot) => (body * BodySlot.Count + slot) * Width;

    /// <summary>Index of a number of a joint in <see cref="Joints"/>.</summary>
    public static int Joint(int node, int slot) => (node * JointCount + slot) * Width;

    /// <summary>Index of the vector of a row's side in <see cref="Linear"/> and <see cref="Angular"/>.</summary>
    public int Row(int node, int row, int side) => 3 * (RowOffsets[node] + row * Shape.Nodes[node].Bodies.Length + side) * Width;

    /// <summary>Share added to the diagonal of angular rows in RATTLE steps.</summary>
    public double AngularShare { get; }

    /// <summary>What the matrix has on the diagonal above J M^-1 J^T, of rigid rows.</summary>
    public double[] Compliance { get; }

    /// <summary>Step for which its angles are springs, see <see cref="SoftAngles{V}"/>; 0 where they are rigid.</summary>
    public double SoftStep { get; set; }

    /// <summary>What the next step takes from those before it.</summary>
    public void Exchange(StateTape tape)
    {
        tape.Array(Bodies);
        tape.Array(Joints);
        tape.Array(Linear);
        tape.Array(Angular);
        tape.Array(Matrix);
        tape.Array(Half);
        tape.Array(Compliance);
        double softStep = SoftStep;
        tape.Value(ref softStep);
        SoftStep = softStep;
        Laws?.Exchange(tape);
    }

    /// <summary>Forgets what earlier steps left behind.</summary>
    public void ClearHistory()
    {
        Array.Clear(Half, 0, Half.Length);
        Laws?.ClearHistory();
    }
}
