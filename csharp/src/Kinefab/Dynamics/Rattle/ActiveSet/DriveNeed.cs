using System;
using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>How much a drive without limit of force may need: more than that would be no answer to what stops it, see <see cref="ScalarRow.BoundForce"/>.</summary>
internal sealed class DriveNeed<V>
    where V : struct, ILane<V>
{
    // By how much the levers of a loop, and gears, may multiply what reaches a drive. More makes the answer of a drive that stalls so large that steps fail.
    private const double MostByLevers = 30;
    private const double MostByGears = 1e3;

    // By how much one joint's angles, whose axes are not at right angles, may work against each other.
    private const double MostBySkew = 4;

    // What is reckoned of speeds and loads, this many times.
    private const double Margin = 4;

    private readonly LaneRecords<V> _batch;
    private readonly ScalarRows _scalars;
    private readonly ScalarRow[] _rows;

    /// <param name="batch">One island, on the only lane.</param>
    /// <param name="scalars">Its scalar rows.</param>
    public DriveNeed(LaneRecords<V> batch, ScalarRows scalars)
    {
        _batch = batch;
        _scalars = scalars;
        _rows = scalars.Rows;
    }

    /// <summary>
    /// The most impulse that a drive can need in a part of a step, whatever way its island takes: to start, stop or turn round all bodies as one, which is
    /// a matter of the whole step, by itself or as other drives ask for, and to hold out against springs, other drives, loads and what turns. Of a chain no
    /// more reaches it; levers and gears may multiply it. In loops what the bodies have beside the speeds that are asked for does not count: where a dead
    /// point throws them about, each step would throw them farther.
    /// </summary>
    /// <param name="drive">Its row.</param>
    /// <param name="h">Length of the part, s.</param>
    public double MostImpulse(in ScalarRow drive, double h)
    {
        const double mostAcceleration = 1e3;
        bool isAngular = drive.Built.Has(RowFlags.Angular);
        double speed = Math.Abs(drive.AskedSpeed(h));
        double inertia = MostInertia(drive, out double reach), load = 0, weights = 0;
        Vector3d anchor = Anchor(drive);
        FindOthers(drive, out double turning, out double moving);
        double fastestTurn = turning + (isAngular ? speed : 0), fastest = moving + (isAngular ? 0 : speed);
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            double own = Inverse(_batch.Bodies[o + BodyLanes.InverseMass]);
            double weight = isAngular ? own * Length(o + BodyLanes.EndX, anchor) : own;
            weights += weight;
            load += weight * Length(o + BodyLanes.Acceleration) + (isAngular ? Length(o + BodyLanes.Torque) : 0);
            fastestTurn = _batch.Shape.HasJointLoops ? fastestTurn : Math.Max(fastestTurn, Impulses<V>.AngularVelocity(_batch, body).Length);
            fastest = _batch.Shape.HasJointLoops ? fastest : Math.Max(fastest, Length(o + BodyLanes.V));
        }

        // Towards the axes about which it turns, and as it slides while it turns.
        load += weights * fastestTurn * (fastestTurn * reach + 2 * fastest) + (isAngular ? inertia * fastestTurn * fastestTurn : 0);
        double others = isAngular ? inertia * turning + weights * moving : inertia * (moving + turning * reach);
        double start = Math.Max(0, Margin * (inertia * (speed + Math.Abs(drive.StartSpeed)) + others) - Math.Abs(_batch.Work.TotalImpulses[drive.Index]));
        double force = Margin * (load + Levers * Opposed(drive, h, speed, reach)) + inertia * mostAcceleration * Math.Sqrt(drive.Pace.Share);
        return ByGears(reach) * (isAngular && AreAskew(drive) ? MostBySkew : 1) * (start + force * h);
    }

    /// <summary>
    /// The most that the pivot of a drive's row comes to away from dead points, kg or kg m^2: what the mechanism is to a drive that moves it, by all bodies
    /// as one, levers and gears.
    /// </summary>
    public double MostPivot(in ScalarRow drive) => ByGears(0) * MostInertia(drive, out _) * (IsCoupledAmongOthers(drive) ? MostBySkew : 1);

    /// <summary>How far from a drive's joint the farthest body is, m.</summary>
    public double FarthestBody(in ScalarRow drive)
    {
        Vector3d anchor = Anchor(drive);
        double reach = 0;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            reach = Math.Max(reach, Length(LaneRecords<V>.Body(body, BodyLanes.EndX), anchor));
        }

        return reach;
    }

    // Whether the joint has other angular drives without limit of force: its angles do not turn about axes at right angles, and what one asks for the others
    // undo.
    private bool AreAskew(in ScalarRow drive)
    {
        bool areAskew = false;
        int first = _scalars.First(drive.Block);
        for (int i = first; i < first + _batch.Shape.Blocks[drive.Block].ScalarCount; i++)
        {
            areAskew |= _rows[i].IsEndlessDrive && _rows[i].Built.Has(RowFlags.Angular) && _rows[i].Index != drive.Index;
        }

        return areAskew;
    }

    // How fast the other drives without limit of force and the kinematic bodies turn the island, rad/s, and move it, m/s: as they are asked to and as they do.
    private void FindOthers(in ScalarRow drive, out double turning, out double moving)
    {
        turning = 0;
        moving = 0;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow other = ref _rows[i];
            double speed = other.IsEndlessDrive && !other.Drive.IsHeld && other.Index != drive.Index ? Math.Abs(other.Built.VelocityTarget) + Math.Abs(Impulses<V>.Speed(_batch, other.Block, other.Built)) : 0;
            turning += other.Built.Has(RowFlags.Angular) ? speed : 0;
            moving += other.Built.Has(RowFlags.Angular) ? 0 : speed;
        }

        for (int body = _batch.Shape.MovingBodies; body < _batch.Shape.Bodies.Length; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            turning += _batch.Shape.IsStatic[body] ? 0 : Length(o + BodyLanes.W);
            moving += _batch.Shape.IsStatic[body] ? 0 : Length(o + BodyLanes.V);
        }
    }

    private double Levers => _batch.Shape.HasLoops ? MostByLevers : 1;

    // The most that a mechanism away from its dead points is to a drive that moves it, kg or kg m^2, but for gears: all bodies as one. reach: how far the
    // farthest is from the drive's joint, m.
    private double MostInertia(in ScalarRow drive, out double reach)
    {
        Vector3d anchor = Anchor(drive);
        double mass = 0, moments = 0;
        reach = 0;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneRecords<V>.Body(body, 0);
            double own = Inverse(_batch.Bodies[o + BodyLanes.InverseMass]), arm = Length(o + BodyLanes.EndX, anchor);
            reach = Math.Max(reach, arm);
            mass += own;
            moments += own * arm * arm + Inverse(_batch.Bodies[o + BodyLanes.LeastInverseInertia]);
        }

        double levers = Levers;
        return drive.Built.Has(RowFlags.Angular) ? moments : levers > 1 && reach > 0 ? mass + levers * moments / (reach * reach) : mass;
    }

    private Vector3d Anchor(in ScalarRow drive) =>
        LaneTransfer<V>.ReadPose(_batch, _batch.Shape.Blocks[drive.Block].Bodies[0], 0).Point(_batch.Models[drive.Block]!.Frame0.Position);

    private double Length(int number, Vector3d from = default) => (LaneTransfer<V>.ReadVector(_batch.Bodies, number) - from).Length;

    // Whether a coupling holds an angle of a drive's joint that turns about other axes too: of coupled angles, whose axes are not at right angles, one may turn
    // much where the other turns little.
    private bool IsCoupledAmongOthers(in ScalarRow drive) => _batch.Models[drive.Block] is D6Joint { IsCoupledAmongOthers: true };

    // By how much gears may multiply an inertia, by the square of their ratios, or a load, by less. reach: of angles, by which they compare with ways, m.
    private double ByGears(double reach)
    {
        double product = 1;
        foreach (CoordinateCoupling? coupling in _batch.Couplings)
        {
            double least = double.PositiveInfinity, most = 0;
            for (int i = 0; coupling != null && i < coupling.Factors.Length; i++)
            {
                double factor = Math.Abs(coupling.Factors[i]);
                factor /= coupling.Coordinates[i].IsAngle && reach > 0 ? reach : 1;
                least = factor > 0 ? Math.Min(least, factor) : least;
                most = Math.Max(most, factor);
            }

            product *= most > least ? most / least * (most / least) : 1;
        }

        return Math.Min(product, MostByGears);
    }

    // What springs and the drives whose force has a limit may hold against a drive, N or N m of its own.
    private double Opposed(in ScalarRow drive, double h, double speed, double reach)
    {
        double sum = 0;
        for (int i = 0; i < _rows.Length; i++)
        {
            ref ScalarRow other = ref _rows[i];
            bool isSpring = other.Built.Has(RowFlags.Spring);
            if (!other.IsActive || other.Index == drive.Index || !(isSpring || (other.Built.Has(RowFlags.Drive) && !other.IsEndless)))
            {
                continue;
            }

            double gain = other.Built.Has(RowFlags.AccelerationSpring) ? Inverse(Impulses<V>.ResponseOf(_batch, other.Block, other.Built)) : 1;
            double way = Math.Abs(other.Built.GeometricError) + Margin * h * speed;
            double force = isSpring
                ? gain * (other.Built.Stiffness * way + other.Built.Damping * (Math.Abs(other.StartSpeed) + Margin * speed))
                : Math.Max(other.Built.Maximum, -other.Built.Minimum);
            bool turns = other.Built.Has(RowFlags.Angular), isAngular = drive.Built.Has(RowFlags.Angular);
            sum += turns == isAngular || reach == 0 ? force : turns ? force / reach : force * reach;
        }

        return sum;
    }

    private static double Inverse(double number) => number > 0 ? 1 / number : 0;
}
