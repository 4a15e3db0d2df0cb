using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Document;

namespace Kinefab.Kinematics;

/// <summary>
/// Picks joint coordinates that together tell where everything stands, as many as there are finite motions: block by block, each
/// coordinate that moves in a way that those before it do not (Gram-Schmidt on their rates in the block's velocities).
/// </summary>
internal sealed class FreedomChoice
{
    // Share of a coordinate's rate that earlier ones must leave it; the second where the first leaves freedoms without any.
    private static readonly double[] LeastShares = { 1e-3, 1e-8 };

    private readonly Mechanism _mechanism;
    private readonly NewtonSolver _newton;
    private readonly MechanismState _state;
    private readonly FreedomBlocks _blocks;
    private readonly IndependentLinkages _parts;

    private FreedomChoice(Mechanism mechanism)
    {
        _mechanism = mechanism;
        _newton = new NewtonSolver(mechanism.Linkage);
        _state = mechanism.NewState();
        _newton.Close(_state);
        _newton.Motion.Start(_state.Poses);
        _blocks = new FreedomBlocks(mechanism.Linkage, _newton.Firsts, _newton.Motion.Linear.Length);
        _parts = new IndependentLinkages(mechanism.Linkage, _blocks, _newton.Firsts);
    }

    /// <summary>Indices of coordinates, rising.</summary>
    public static IReadOnlyList<int> Of(Mechanism mechanism, CancellationToken cancellation)
    {
        var choice = new FreedomChoice(mechanism);
        var chosen = new List<int>();
        var tied = new List<int>[choice._parts.Count];
        for (int i = 0; i < mechanism.Coordinates.Count; i++)
        {
            int block = choice.BlockOf(i);
            if (mechanism.Coordinates[i].IsLocked || block == None)
                continue;
            if (block < 0)
                chosen.Add(i);
            else
                (tied[block] ??= new List<int>()).Add(i);
        }

        if (tied.Any(coordinates => coordinates is not null))
        {
            var velocities = new VelocitySpace(mechanism.Linkage, choice._newton, choice._blocks, choice._state);
            List<double[]>[] motions = choice.ByBlock(velocities.Basis);
            for (int b = 0; b < tied.Length; b++)
            {
                cancellation.ThrowIfCancellationRequested();
                if (tied[b] is not null)
                    chosen.AddRange(choice.Independent(tied[b], motions[b], new LoopMobility(choice._parts.Make(b, choice._state.Poses), choice._state, cancellation).Finite));
            }
        }

        chosen.Sort();
        return chosen;
    }

    private const int None = -2;

    // -1: no loop and no coupling touches it.
    private int BlockOf(int coordinate)
    {
        int[] bodies = _mechanism.Rows.Joints[_mechanism.Coordinates[coordinate].Joint].Bodies;
        foreach (int body in bodies)
        {
            if (_mechanism.Tree.Freedoms[body] > 0)
                return _parts.BlockOf(body);
        }

        return None;
    }

    private List<double[]>[] ByBlock(IReadOnlyList<double[]> basis)
    {
        var found = new List<double[]>[_parts.Count];
        foreach (double[] motion in basis)
        {
            int block = _blocks.BlockOf[Array.FindIndex(motion, entry => entry != 0)];
            (found[block] ??= new List<double[]>()).Add(motion);
        }

        return found;
    }

    private List<int> Independent(List<int> coordinates, List<double[]>? motions, int count)
    {
        var chosen = new List<int>();
        if (motions is null)
            return chosen;
        int[] order = coordinates.Where(i => !IsInABall(i)).OrderBy(Rank).ThenBy(i => i).ToArray();
        double[][] rates = Array.ConvertAll(order, i => Rates(i, motions));
        var before = new List<double[]>();
        foreach (double least in LeastShares)
        {
            for (int k = 0; k < order.Length && chosen.Count < count; k++)
            {
                if (chosen.Contains(order[k]))
                    continue;
                double[] left = (double[])rates[k].Clone();
                foreach (double[] unit in before)
                {
                    double share = left.Zip(unit, (a, b) => a * b).Sum();
                    left = left.Zip(unit, (a, b) => a - share * b).ToArray();
                }

                double size = Math.Sqrt(left.Sum(entry => entry * entry));
                if (size > least)
                {
                    chosen.Add(order[k]);
                    before.Add(Array.ConvertAll(left, entry => entry / size));
                }
            }
        }

        return chosen;
    }

    private double[] Rates(int coordinate, List<double[]> motions)
    {
        MechanismCoordinate own = _mechanism.Coordinates[coordinate];
        Joints.JointModel joint = own.JointRows;
        own.Evaluate(Linkage.PoseOf(joint.Body0, _state.Poses), Linkage.PoseOf(joint.Body1, _state.Poses), _state.Values[coordinate], out Joints.ConstraintRow row);
        return motions.Select(motion => _newton.Equations.Rate(own.Joint, row, _state.Poses, motion)).ToArray();
    }

    // The angles of a ball in a loop are what is left to a rod that spins idly.
    private bool IsInABall(int coordinate)
    {
        int joint = _mechanism.Coordinates[coordinate].Joint;
        return _mechanism.Coordinates[coordinate].IsAngle
            && _parts.Movers(BlockOf(coordinate)).Count > 1
            && _mechanism.Coordinates.Count(c => c.Joint == joint && c.IsAngle && !c.IsLocked) == 3;
    }

    // What drives comes first, then hinges and slides that hold to what the block hangs on.
    private (bool Passive, bool Closure, bool IsOneOfSeveral, bool Inside) Rank(int coordinate)
    {
        MechanismCoordinate own = _mechanism.Coordinates[coordinate];
        Joints.JointModel joint = own.JointRows;
        int block = BlockOf(coordinate);
        bool inside = IsInside(joint.Body0) && IsInside(joint.Body1);
        return (!IsDriven(own), _mechanism.Tree.ChildOf[own.Joint] < 0, _mechanism.Coordinates.Count(c => c.Joint == own.Joint && !c.IsLocked) > 1, inside);

        bool IsInside(int body) => _mechanism.Tree.Moving(body) is >= 0 and int moving && _parts.BlockOf(moving) == block;
    }

    private bool IsDriven(MechanismCoordinate coordinate) =>
        _mechanism.Scene.Document.GameObjects[coordinate.GameObject].Components[coordinate.Component] switch
        {
            HingeJoint hinge => (hinge.UseMotor && hinge.Motor.Force > 0) || (hinge.UseSpring && hinge.Spring.Spring > 0),
            ConfigurableJoint joint => IsActive(coordinate.Coordinate switch
            {
                Coordinate.X => joint.XDrive,
                Coordinate.Y => joint.YDrive,
                Coordinate.Z => joint.ZDrive,
                _ when joint.RotationDriveMode == RotationDriveMode.Slerp => joint.SlerpDrive,
                Coordinate.AngularX => joint.AngularXDrive,
                _ => joint.AngularYZDrive,
            }),
            ArticulationBody link => (coordinate.Coordinate switch
            {
                Coordinate.AngularY => link.YDrive,
                Coordinate.AngularZ => link.ZDrive,
                _ => link.XDrive,
            }).IsActive,
            _ => false,
        };

    private static bool IsActive(JointDrive drive) => drive.MaximumForce > 0 && (drive.PositionSpring > 0 || drive.PositionDamper > 0);
}
