using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Document;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Picks joint coordinates that together tell where everything stands, as many as there are finite motions: block by block, each
/// coordinate that moves in a way that those before it do not (Gram-Schmidt on their rates in the block's velocities).
/// </summary>
internal sealed class FreedomChoice
{
    // Share of a coordinate's rate that earlier ones must leave it; the second where the first leaves freedoms without any.
    private static readonly double[] LeastShares = { 1e-3, 1e-8 };

    private const int None = -2;

    private readonly Mechanism _mechanism;
    private readonly MechanismState _state;
    private readonly IndependentLinkages _parts;

    // For each joint its unlocked coordinates, and those of them that turn.
    private readonly int[] _free;
    private readonly int[] _turns;

    private FreedomChoice(Mechanism mechanism, CancellationToken cancellation)
    {
        _mechanism = mechanism;
        var newton = new NewtonSolver(mechanism.Linkage, cancellation);
        _state = mechanism.NewState();
        newton.Close(_state);
        newton.Motion.Start(_state.Poses);
        var blocks = new FreedomBlocks(mechanism.Linkage, newton.Firsts, newton.Motion.Linear.Length);
        _parts = new IndependentLinkages(mechanism.Linkage, blocks, newton.Firsts);
        _free = new int[mechanism.Joints.Length];
        _turns = new int[mechanism.Joints.Length];
        foreach (MechanismCoordinate coordinate in mechanism.Coordinates)
        {
            _free[coordinate.Joint] += coordinate.IsLocked ? 0 : 1;
            _turns[coordinate.Joint] += coordinate.IsLocked || !coordinate.IsAngle ? 0 : 1;
        }
    }

    /// <summary>Indices of coordinates, rising.</summary>
    public static IReadOnlyList<int> Of(Mechanism mechanism, CancellationToken cancellation)
    {
        var choice = new FreedomChoice(mechanism, cancellation);
        var chosen = new List<int>();
        var tied = new List<int>?[choice._parts.Count];
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

        for (int b = 0; b < tied.Length; b++)
        {
            cancellation.ThrowIfCancellationRequested();
            if (tied[b] is List<int> coordinates)
                chosen.AddRange(choice.Independent(coordinates, choice._parts.Make(b, choice._state.Poses), cancellation));
        }

        chosen.Sort();
        return chosen;
    }

    // -1: no loop and no coupling touches it.
    private int BlockOf(int coordinate)
    {
        foreach (int body in _mechanism.Rows.Joints[_mechanism.Coordinates[coordinate].Joint].Bodies)
        {
            if (_mechanism.Tree.Freedoms[body] > 0)
                return _parts.BlockOf(body);
        }

        return None;
    }

    private List<int> Independent(List<int> coordinates, IndependentLinkage part, CancellationToken cancellation)
    {
        var loop = new LoopMobility(part, _state, cancellation);
        var newton = new NewtonSolver(part.Linkage, cancellation);
        Pose[] poses = part.StateOf(_state).Poses;
        newton.Motion.Start(poses);
        var chosen = new List<int>();
        HashSet<int> looped = Looped(part);
        int[] order = coordinates.Where(i => Holds(part, i) && !IsInABall(i, looped)).OrderBy(Rank).ThenBy(i => i).ToArray();
        double[][] rates = Array.ConvertAll(order, i => Rates(i, Array.BinarySearch(part.Joints, _mechanism.Coordinates[i].Joint), newton, poses, loop.Here.Basis));
        var before = new List<double[]>();
        foreach (double least in LeastShares)
        {
            for (int k = 0; k < order.Length && chosen.Count < loop.Finite; k++)
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

    private double[] Rates(int coordinate, int joint, NewtonSolver newton, Pose[] poses, IReadOnlyList<double[]> motions)
    {
        MechanismCoordinate own = _mechanism.Coordinates[coordinate];
        Joints.JointModel rows = own.JointRows;
        own.Evaluate(Linkage.PoseOf(rows.Body0, _state.Poses), Linkage.PoseOf(rows.Body1, _state.Poses), _state.Values[coordinate], out Joints.ConstraintRow row);
        return motions.Select(motion => newton.Equations.Rate(joint, row, poses, motion)).ToArray();
    }

    // A joint that holds nothing belongs to no block: others tell what its coordinates do.
    private bool Holds(IndependentLinkage part, int coordinate) => Array.BinarySearch(part.Joints, _mechanism.Coordinates[coordinate].Joint) >= 0;

    // The angles of a ball in a loop are what is left to a rod that spins idly. A ball that couplings alone tie turns what hangs on it.
    private bool IsInABall(int coordinate, HashSet<int> looped)
    {
        MechanismCoordinate own = _mechanism.Coordinates[coordinate];
        return own.IsAngle && _turns[own.Joint] == 3 && looped.Contains(own.Joint);
    }

    // The joints of a part's loops, by the mechanism's index.
    private static HashSet<int> Looped(IndependentLinkage part)
    {
        var looped = new HashSet<int>();
        KinematicTree tree = part.Linkage.Tree;
        foreach (int closure in tree.Closures)
        {
            looped.Add(part.Joints[closure]);
            foreach (int body in part.Linkage.Rows.Joints[closure].Bodies)
            {
                if (tree.TreeJoints[body] >= 0)
                {
                    looped.Add(part.Joints[tree.TreeJoints[body]]);
                }
            }
        }

        return looped;
    }

    // What drives comes first, then hinges and slides that hold to what the block hangs on.
    private (bool Passive, bool Closure, bool IsOneOfSeveral, bool Inside) Rank(int coordinate)
    {
        MechanismCoordinate own = _mechanism.Coordinates[coordinate];
        Joints.JointModel joint = own.JointRows;
        int block = BlockOf(coordinate);
        bool inside = IsInside(joint.Body0) && IsInside(joint.Body1);
        return (!IsDriven(own), _mechanism.Tree.ChildOf[own.Joint] < 0, _free[own.Joint] > 1, inside);

        bool IsInside(int body) => _mechanism.Tree.Moving(body) is >= 0 and int moving && _parts.BlockOf(moving) == block;
    }

    private bool IsDriven(MechanismCoordinate coordinate) =>
        _mechanism.Scene.Document.GameObjects[coordinate.GameObject].Components[coordinate.Component] switch
        {
            HingeJoint hinge => (hinge.UseMotor && hinge.Motor.Force > 0) || (hinge.UseSpring && hinge.Spring.Spring > 0),
            ConfigurableJoint joint => (coordinate.Coordinate switch
            {
                Coordinate.X => joint.XDrive,
                Coordinate.Y => joint.YDrive,
                Coordinate.Z => joint.ZDrive,
                _ when joint.RotationDriveMode == RotationDriveMode.Slerp => joint.SlerpDrive,
                Coordinate.AngularX => joint.AngularXDrive,
                _ => joint.AngularYZDrive,
            }).IsActive,
            ArticulationBody link => (coordinate.Coordinate switch
            {
                Coordinate.AngularY => link.YDrive,
                Coordinate.AngularZ => link.ZDrive,
                _ => link.XDrive,
            }).IsActive,
            _ => false,
        };
}
