using Kinefab.Joints;

namespace Kinefab.Dynamics.Rattle;

/// <summary>What ties a row's impulse to its speed.</summary>
internal enum LawKind : byte
{
    /// <summary>Nothing: the row is not there.</summary>
    None,

    /// <summary>Spring and damper within force limits: drives, hinge springs, soft limits.</summary>
    Spring,

    /// <summary>A speed held within force limits.</summary>
    Motor,

    /// <summary>C stays positive by an impulse that is not negative.</summary>
    HardLimit,
}

/// <summary>Where on its piecewise-linear law a row stands.</summary>
internal enum Segment : byte
{
    /// <summary>The impulse is fixed, at a bound or at 0.</summary>
    Clamped,

    /// <summary>The impulse follows from the speed.</summary>
    Sloped,
}

/// <summary>What a law is in the matrix.</summary>
internal enum Hold : byte
{
    /// <summary>An identity row.</summary>
    None,

    /// <summary>A row like a locked axis's.</summary>
    Rigid,

    /// <summary>A row with a spring's compliance.</summary>
    Compliant,
}

/// <summary>
/// One row with a monotone piecewise-linear law. Impulse p is what the flight gets of it.
/// Spring: the force -k C + d (vT - v) is taken at the share Theta of the step, C = C0 + Theta h v, and its impulse
/// l = h (d vT - k C0) - Gamma v, Gamma = h (d + Theta h k), is given by Theta before the flight and the rest after it:
/// Theta = 1/2 is the implicit midpoint rule, second order and without numerical damping; Theta = 1 is implicit Euler.
/// </summary>
internal struct Law
{
    public LawKind Kind;
    public Segment Segment;

    /// <summary>J, and C at the pose of the last Build.</summary>
    public ConstraintRow Row;

    /// <summary>Whether Prepare wrote the row at that pose.</summary>
    public bool IsWritten;

    /// <summary>J and C at the end of the flight.</summary>
    public ConstraintRow End;

    /// <summary>Whether Prepare wrote that row where it was last asked.</summary>
    public bool HasEnd;

    /// <summary>What the factored matrix has of it.</summary>
    public Hold Hold;

    /// <summary>C at the start of the step.</summary>
    public double C0;

    /// <summary>Speed of the row at the start of the step.</summary>
    public double StartSpeed;

    public double Theta;
    public double Gamma;

    /// <summary>Impulse of a spring at v = 0.</summary>
    public double Rest;

    /// <summary>By how much a spring that the step is too long to follow holds its speed at the flight's, see <see cref="SpringAnswer"/>.</summary>
    public double Grip;

    /// <summary>That speed, by the impulse that the spring gave at it; NaN of one at its limit.</summary>
    public double Held;

    /// <summary>Bounds of the whole step's impulse.</summary>
    public double Low;
    public double High;

    /// <summary>Impulse before the flight, and after it.</summary>
    public double First;
    public double Second;

    /// <summary>Change of First when it came to its bound, until the momenta have it.</summary>
    public double Jump;

    /// <summary>Work of a spring without potential since the account was opened, J.</summary>
    public double Work;

    /// <summary>Node, row in the node and row in the vectors.</summary>
    public int Node;
    public int NodeRow;
    public int Index;

    /// <summary>What the row is to the step that begins at the pose where it was written.</summary>
    public readonly LawKind FindKind()
    {
        if (!IsWritten)
        {
            return LawKind.None;
        }

        if (Row.Has(RowFlags.Spring))
        {
            bool isIdle = Row.Stiffness == 0 && Row.Damping == 0;
            return isIdle || (Row.Has(RowFlags.Limit) && C0 >= 0) ? LawKind.None : LawKind.Spring;
        }

        return Row.Has(RowFlags.Limit) ? LawKind.HardLimit : LawKind.Motor;
    }

    /// <summary>What the matrix is to have of it.</summary>
    public readonly Hold FindHold() =>
        Segment == Segment.Clamped || !IsWritten ? Hold.None
        : Kind == LawKind.Spring ? Hold.Compliant
        : Hold.Rigid;

    /// <param name="h">Step, s.</param>
    /// <param name="areForces">Whether the bounds of the joint's drives are forces, not impulses.</param>
    public void SetBounds(double h, bool areForces)
    {
        bool isForce = areForces && Row.Has(RowFlags.HasDriveLimit);
        Low = Row.Minimum * (isForce ? h : 1);
        High = Row.Maximum * (isForce ? h : 1);
    }

    /// <param name="h">Step, s.</param>
    /// <param name="response">J M^-1 J^T, 1/kg or 1/(kg m^2).</param>
    /// <param name="isImplicit">Whether the whole impulse acts before the flight (implicit Euler).</param>
    public void SetSpring(double h, double response, bool isImplicit)
    {
        double perMass = Row.Has(RowFlags.AccelerationSpring) && response > 0 ? 1 / response : 1;
        double k = Row.Stiffness * perMass;
        double d = Row.Damping * perMass;

        // Half the step's stiffness and damping against the inertia that they move, at most: where the step is too long to
        // follow the spring, its share goes from the midpoint's towards implicit Euler's, so that it decays and does not ring.
        double z = h * (d + h * k) * response;
        Theta = isImplicit ? 1 : z < 1 ? 0.5 : 1 - 0.5 / z;
        Grip = isImplicit || z <= 1 ? 0 : (z * z - 1) / response;
        Gamma = h * (d + Theta * h * k);
        Rest = h * (d * Row.VelocityTarget - k * C0);
    }
}

/// <summary>What a law brings into a step from the one before: all else follows from the rows that are built at its start.</summary>
internal readonly struct LawHistory
{
    public readonly double First;
    public readonly Segment Segment;
    public readonly double Work;

    public LawHistory(in Law law)
    {
        First = law.First;
        Segment = law.Segment;
        Work = law.Work;
    }
}
