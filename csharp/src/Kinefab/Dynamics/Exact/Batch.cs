using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// The numbers of up to Width islands of one shape, side by side: number i of a record stands at i * Width + lane. All
/// arrays are made here; a step only writes into them.
/// </summary>
internal sealed class Batch<V>
    where V : struct, ILane<V>
{
    /// <summary>Numbers of a joint: see <see cref="Frame"/> and <see cref="Placed"/>.</summary>
    public const int JointCount = 48;

    /// <summary>A row's part on one body: linear and angular J, and angular J times the inverse inertia.</summary>
    public const int Linear = 0, Angular = 3, Response = 6, SideCount = 9;

    public Batch(Island shape)
    {
        Shape = shape;
        int w = Width;
        Bodies = new double[shape.Bodies.Length * BodySlot.Count * w];
        Joints = new double[shape.Nodes.Length * JointCount * w];
        RowOffsets = new int[shape.Nodes.Length];
        int length = 0;
        for (int n = 0; n < shape.Nodes.Length; n++)
        {
            RowOffsets[n] = length;
            length += shape.Nodes[n].Rows * shape.Nodes[n].Bodies.Length * SideCount;
        }

        int rows = shape.Pattern.RowCount;
        Rows = new double[length * w];
        Matrix = new double[shape.Pattern.Length * w];
        Error = new double[rows * w];
        LastError = new double[rows * w];
        Solution = new double[rows * w];
        LastSolution = new double[rows * w];
        Move = new double[rows * w];
        Half = new double[rows * w];
        First = new double[rows * w];
        Total = new double[rows * w];
        Active = new double[w];
        MaxError = new double[w];
        MaxChange = new double[w];
        MaxGap = new double[w];
        LastMaxError = new double[w];
        FirstMaxError = new double[w];
        Fastest = new double[w];
        Reaction = new double[6 * w];
        if (shape.Laws > 0)
        {
            Laws = new Laws<V>(this);
        }
    }

    public static int Width => Lane<V>.Width;

    public Island Shape { get; }

    /// <summary>Records of <see cref="BodySlot"/>.</summary>
    public double[] Bodies { get; }

    /// <summary>Records of <see cref="JointCount"/>.</summary>
    public double[] Joints { get; }

    /// <summary>J: for each node, row and side a record of <see cref="SideCount"/>.</summary>
    public double[] Rows { get; }

    /// <summary>Where each node's rows begin in <see cref="Rows"/>.</summary>
    public int[] RowOffsets { get; }

    /// <summary>A = J M^-1 J^T, then its factor.</summary>
    public double[] Matrix { get; }

    /// <summary>C at the end of the flight, and one iteration before.</summary>
    public double[] Error { get; }

    public double[] LastError { get; }

    /// <summary>Right-hand side, then impulses.</summary>
    public double[] Solution { get; }

    /// <summary>Solution one iteration before, and what was made of it.</summary>
    public double[] LastSolution { get; }

    public double[] Move { get; }

    /// <summary>Impulses of the velocity projection, by which the next step starts.</summary>
    public double[] Half { get; }

    /// <summary>Impulses of the flight.</summary>
    public double[] First { get; }

    /// <summary>Impulses of the whole step.</summary>
    public double[] Total { get; }

    /// <summary>1 in lanes that still iterate, else 0.</summary>
    public double[] Active { get; }

    /// <summary>Largest error, and largest change of an error, of each lane.</summary>
    public double[] MaxError { get; }

    public double[] MaxChange { get; }

    /// <summary>Largest error one iteration before.</summary>
    public double[] LastMaxError { get; }

    /// <summary>Largest error of the first flight.</summary>
    public double[] FirstMaxError { get; }

    /// <summary>Largest error of a row that is not angular alone, m.</summary>
    public double[] MaxGap { get; }

    /// <summary>Largest angular speed of each lane's moving bodies at the start of the step, rad/s.</summary>
    public double[] Fastest { get; }

    /// <summary>Force and torque of one joint.</summary>
    public double[] Reaction { get; }

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

    /// <summary>Index of a number of a row's side in <see cref="Rows"/>.</summary>
    public int Row(int node, int row, int side, int slot) =>
        (RowOffsets[node] + (row * Shape.Nodes[node].Bodies.Length + side) * SideCount + slot) * Width;

    /// <summary>Forgets what earlier steps left behind.</summary>
    public void ClearHistory()
    {
        Array.Clear(Half, 0, Half.Length);
        Array.Clear(First, 0, First.Length);
        Laws?.ClearHistory();
    }
}
