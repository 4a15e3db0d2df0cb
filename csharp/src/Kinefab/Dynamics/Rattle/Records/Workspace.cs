using System;
using System.Threading;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>Room for a batch's numbers that do not outlive a step; small, so that it stays in the processor's cache.</summary>
internal sealed class Workspace<V>
    where V : struct, ILane<V>
{
    /// <param name="shape">What the islands look like.</param>
    public Workspace(Island shape)
    {
        int w = Lane<V>.Width;
        int rows = shape.RowCount;
        int sides = 0;
        foreach (RowBlock block in shape.Blocks)
        {
            sides += block.Rows * block.Bodies.Length;
        }

        Response = new double[3 * sides * w];
        Turns = new double[4 * BodyLanes.Count];
        BodiesBefore = shape.ScalarCount > 0 ? new double[shape.Bodies.Length * BodyLanes.Count * w] : Array.Empty<double>();
        Error = new double[rows * w];
        LastError = new double[rows * w];
        Momenta = new double[6 * shape.MovingBodies * w];
        LastAngles = shape.IsInconsistent ? new double[rows * w] : Array.Empty<double>();
        CompliantInertia = new double[w];
        CompliantWork = new double[w];
        Solution = new double[rows * w];
        LastSolution = new double[rows * w];
        Move = new double[rows * w];
        PositionImpulses = new double[rows * w];
        TotalImpulses = new double[rows * w];
        HubResponse = new double[rows * w];
        HubRoots = new double[11 * shape.Hubs.Length * w];
        int unknowns = shape.Hubs.Length > 0 ? shape.Pattern.RowCount * w : 0;
        Right = new double[unknowns];
        Unknowns = new double[unknowns];
        Correction = new double[unknowns];
        Active = new double[w];
        Moved = new double[w];
        Uneven = new double[w];
        FrameVelocity = new double[3 * w];
        MaxError = new double[w];
        MaxChange = new double[w];
        MaxGap = new double[w];
        LastMaxError = new double[w];
        FirstMaxError = new double[w];
        Fastest = new double[w];
        Slowed = new double[w];
        StartKinetic = new double[w];
        Kinetic = new double[w];
        Moving = new double[w];
        Gain = new double[w];
        Leftover = new double[w];
        Reaction = new double[6 * w];
        Rows = shape.HasAssembledRows ? new ConstraintRow[JointModel.MaxRows] : Array.Empty<ConstraintRow>();
    }

    /// <summary>Ends the step early, as <see cref="MultibodySystem.Cancellation"/>.</summary>
    public CancellationToken Cancellation { get; set; }

    /// <summary>Angular J times the inverse inertia, as <see cref="LaneRecords{V}.Angular"/>: of the matrix that was assembled last.</summary>
    public double[] Response { get; }

    /// <summary>A body's record in four lanes, for four bodies of one island that turn side by side.</summary>
    public double[] Turns { get; }

    /// <summary>The bodies' records before a blow; none where there are no scalar rows.</summary>
    public double[] BodiesBefore { get; }

    /// <summary>Velocities and angular momenta of the moving bodies, while others stand in their place: those that impulses give, or those before damping.</summary>
    public double[] Momenta { get; }

    /// <summary>C at the end of the drift, and one iteration before.</summary>
    public double[] Error { get; }

    public double[] LastError { get; }

    /// <summary>C of locked angles that are springs up to where their work is known, and that work since the start of the step, J: see <see cref="CompliantAngles{V}"/>.</summary>
    public double[] LastAngles { get; }

    public double[] CompliantWork { get; }

    /// <summary>Of the only lane, the most that motors and kinematic bodies can have given since the start of the step, J.</summary>
    public double DrivenWork { get; set; }

    /// <summary>Inverse of the largest moment of a body about one of its joints, of each lane, 1/(kg m^2).</summary>
    public double[] CompliantInertia { get; }

    /// <summary>Right-hand side, then impulses.</summary>
    public double[] Solution { get; }

    /// <summary>Solution one iteration before, and what was made of it.</summary>
    public double[] LastSolution { get; }

    public double[] Move { get; }

    /// <summary>Impulses of the drift.</summary>
    public double[] PositionImpulses { get; }

    /// <summary>Impulses of the whole step.</summary>
    public double[] TotalImpulses { get; }

    /// <summary>What each row has of J M^-1 J^T over hubs on the diagonal.</summary>
    public double[] HubResponse { get; }

    /// <summary>Of each hub a root of its inverse mass, and of its inverse inertia in the world the three columns of one and what is rounding.</summary>
    public double[] HubRoots { get; }

    /// <summary>Room to solve with hubs, over the pattern's rows.</summary>
    public double[] Right { get; }

    public double[] Unknowns { get; }

    public double[] Correction { get; }

    /// <summary>1 in lanes that still iterate, else 0.</summary>
    public double[] Active { get; }

    /// <summary>Not 0 in lanes of which a pose is not the one that the last step left.</summary>
    public double[] Moved { get; }

    /// <summary>Not 0 in lanes of which a kinematic body has another velocity than in the last step.</summary>
    public double[] Uneven { get; }

    /// <summary>Of the frame that each lane makes its step in, m/s: see <see cref="MovingFrame{V}"/>.</summary>
    public double[] FrameVelocity { get; }

    /// <summary>Largest error, and largest change of an error, of each lane.</summary>
    public double[] MaxError { get; }

    public double[] MaxChange { get; }

    /// <summary>Largest error one iteration before.</summary>
    public double[] LastMaxError { get; }

    /// <summary>Largest error of the first drift.</summary>
    public double[] FirstMaxError { get; }

    /// <summary>Largest error of a row that is not angular alone, m.</summary>
    public double[] MaxGap { get; }

    /// <summary>Largest angular speed of each lane's moving bodies at the start of the step, rad/s.</summary>
    public double[] Fastest { get; }

    /// <summary>By what share a moving body of each lane was too fast for its largest angular speed at the start of the step; 0: none was.</summary>
    public double[] Slowed { get; }

    /// <summary>Kinetic energy of each lane at the start of the step and at its end, J.</summary>
    public double[] StartKinetic { get; }

    public double[] Kinetic { get; }

    /// <summary>The energy that moves at its end, and what came of nothing in it, as <see cref="EnergyLedger"/> asks for, J.</summary>
    public double[] Moving { get; }

    public double[] Gain { get; }

    /// <summary>What the projection leaves, see <see cref="VelocityProjection{V}"/>.</summary>
    public double[] Leftover { get; }

    /// <summary>Force and torque of one joint.</summary>
    public double[] Reaction { get; }

    /// <summary>What a joint's Prepare wrote last.</summary>
    public ConstraintRow[] Rows { get; }
}
