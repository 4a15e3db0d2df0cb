using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// The numbers of up to Width islands of one shape, side by side: number i of a record stands at i * Width + lane. All
/// arrays are made beforehand; a step only writes into them.
/// </summary>
internal class LaneRecords<V>
    where V : struct, ILane<V>
{
    /// <summary>Numbers of a joint: see <see cref="Frame"/> and <see cref="WorldFrame"/>.</summary>
    public const int JointCount = 48;

    /// <summary>Numbers of a coordinate in <see cref="Turns"/>.</summary>
    public const int TurnCount = 5;

    /// <param name="shape">What all its islands look like.</param>
    /// <param name="workspace">Arrays that hold nothing from step to step, shared by the batches of a shape.</param>
    public LaneRecords(Island shape, Workspace<V> workspace)
    {
        Shape = shape;
        Work = workspace;
        int w = Width;
        Compliance = new double[shape.RowCount * w];
        Members = new int[shape.Bodies.Length * w];
        JointMembers = new int[shape.Blocks.Length * w];
        Models = new JointModel?[shape.Blocks.Length * w];
        Couplings = new CoordinateCoupling?[shape.Blocks.Length * w];
        Bodies = new double[shape.Bodies.Length * BodyLanes.Count * w];
        Joints = new double[shape.Blocks.Length * JointCount * w];
        RowOffsets = new int[shape.Blocks.Length];
        int sides = 0;
        for (int n = 0; n < shape.Blocks.Length; n++)
        {
            RowOffsets[n] = sides;
            sides += shape.Blocks[n].Rows * shape.Blocks[n].Bodies.Length;
        }

        TurnOffsets = new int[shape.Blocks.Length];
        int turns = 0;
        for (int n = 0; n < shape.Blocks.Length; n++)
        {
            int coordinates = shape.Blocks[n].Coupled.Length;
            TurnOffsets[n] = turns * w;
            turns += coordinates > 0 ? 1 + TurnCount * coordinates : 0;
        }

        Turns = new double[turns * w];
        Linear = new double[3 * sides * w];
        Angular = new double[3 * sides * w];
        Matrix = new double[shape.Pattern.Length * w];
        bool isKept = shape.Hubs.Length > 0 || Array.Exists(shape.Blocks, block => block.IsAxisDriven);
        Assembled = isKept ? new double[Matrix.Length] : Array.Empty<double>();
        VelocityImpulses = new double[shape.RowCount * w];
        if (shape.ScalarCount > 0)
        {
            Scalars = new ScalarRows(shape);
        }
    }

    public static int Width => Lane<V>.Width;

    public Island Shape { get; }

    /// <summary>Body b of a lane in the mechanism (or Joint.World), at b * Width + lane.</summary>
    public int[] Members { get; }

    /// <summary>Joint of block n of a lane in the mechanism, at n * Width + lane; not set for couplings.</summary>
    public int[] JointMembers { get; }

    /// <summary>The joint, or the coupling, that a lane has as block n, at n * Width + lane.</summary>
    public JointModel?[] Models { get; }

    public CoordinateCoupling?[] Couplings { get; }

    /// <summary>Records of <see cref="BodyLanes"/>.</summary>
    public double[] Bodies { get; }

    /// <summary>Records of <see cref="JointCount"/>.</summary>
    public double[] Joints { get; }

    /// <summary>Of each coupling of hinges its offset and, for each hinge, its record: see <see cref="CoupledTurns{V}"/>.</summary>
    public double[] Turns { get; }

    /// <summary>Where those of a block begin.</summary>
    public int[] TurnOffsets { get; }

    /// <summary>Linear and angular J: for each block, row and side a vector. Linear is read for <see cref="RowClass.General"/> alone.</summary>
    public double[] Linear { get; }

    public double[] Angular { get; }

    /// <summary>Vectors before each block's in these.</summary>
    public int[] RowOffsets { get; }

    /// <summary>A = J M^-1 J^T, then its factor.</summary>
    public double[] Matrix { get; }

    /// <summary>A before it was factored, for the refinement of what is solved with hubs, and for springs, which answer in the drift alone; empty without both.</summary>
    public double[] Assembled { get; }

    /// <summary>Impulses of the velocity projection, by which the next step starts.</summary>
    public double[] VelocityImpulses { get; }

    /// <summary>What holds nothing from step to step.</summary>
    public Workspace<V> Work { get; }

    /// <summary>Its scalar rows, or null without any.</summary>
    public ScalarRows? Scalars { get; }

    /// <summary>Anchor and three frame axes of a joint in its body 0 or 1, in the joint's record.</summary>
    public static int Frame(int side) => 12 * side;

    /// <summary>Lever (anchor from the centre of mass) and frame axes in the world's axes, where they were last evaluated.</summary>
    public static int WorldFrame(int side) => 24 + 12 * side;

    /// <summary>Index of a number of a body in <see cref="Bodies"/>.</summary>
    public static int Body(int body, int slot) => (body * BodyLanes.Count + slot) * Width;

    /// <summary>Index of a number of a joint in <see cref="Joints"/>.</summary>
    public static int Joint(int block, int slot) => (block * JointCount + slot) * Width;

    /// <summary>Index of the vector of a row's side in <see cref="Linear"/> and <see cref="Angular"/>.</summary>
    public int Row(int block, int row, int side) => 3 * (RowOffsets[block] + row * Shape.Blocks[block].Bodies.Length + side) * Width;

    /// <summary>What the matrix has on the diagonal above J M^-1 J^T, of rigid rows.</summary>
    public double[] Compliance { get; }

    /// <summary>Length of the drift in which its angles are springs, see <see cref="CompliantAngles{V}"/>; else 0.</summary>
    public double CompliantStep { get; set; }

    /// <summary>What the next step takes from those before it.</summary>
    public void Exchange(StateTape tape)
    {
        Array.ForEach(Kept, tape.Array);
        double compliantStep = CompliantStep;
        tape.Value(ref compliantStep);
        CompliantStep = compliantStep;
        Scalars?.Exchange(tape);
    }

    /// <summary>The same of one lane, between steps.</summary>
    public void Exchange(StateTape tape, int lane)
    {
        Array.ForEach(Kept, numbers => tape.Lane(numbers, lane, Width));
        Scalars?.Exchange(tape);
    }

    private double[][] Kept => new[] { Bodies, Joints, Linear, Angular, Matrix, Assembled, VelocityImpulses, Compliance };

    /// <summary>Forgets what earlier steps left behind.</summary>
    public void ClearHistory()
    {
        Array.Clear(VelocityImpulses, 0, VelocityImpulses.Length);
        Scalars?.ClearHistory();
    }

    /// <summary>Nothing is known of steps before, as of another island.</summary>
    public void Reset()
    {
        Array.Clear(VelocityImpulses, 0, VelocityImpulses.Length);
        Scalars?.Reset();
    }
}
