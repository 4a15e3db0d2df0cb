using System;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// Tells the poses at which the joints lose a rank from all others: more freedoms are left over there than at a pose in
/// general position. A freedom is left over where a pivot of J^T J + mu I is nothing but mu.
/// </summary>
internal sealed class RankDeficiency
{
    // Radians, or lengths of the mechanism.
    private const double GeneralStep = 0.05;

    // A singular value s makes a pivot of about s^2 + mu: the two tell s from 0 down to 1e-4.
    private const double Damping = 1e-7;
    private const double LessDamping = 1e-9;
    private const double LeastShrink = 10;

    private readonly NewtonSolver _newton;
    private readonly double[] _pivots;
    private readonly int _regular;

    public RankDeficiency(Mechanism mechanism, NewtonSolver newton)
    {
        _newton = newton;
        _pivots = new double[newton.Motion.Linear.Length];
        MechanismState state = mechanism.NewState();
        newton.Close(state);
        _regular = FreeAt(state);
        var step = new double[_pivots.Length];
        for (int i = 0; i < step.Length; i++)
        {
            // Anything without a pattern.
            step[i] = GeneralStep * Trigonometry.Sin(12.9898 * (i + 1));
        }

        newton.Motion.Move(state.Poses, step);
        if (newton.Close(state))
        {
            _regular = Math.Min(_regular, FreeAt(state));
        }
    }

    /// <summary>Whether a closed state stands (nearly) at such a pose.</summary>
    public bool Contains(MechanismState state) => FreeAt(state) > _regular;

    // By the joints and couplings alone, no limits and no drivers.
    private int FreeAt(MechanismState state)
    {
        _newton.ClearDriven();
        _newton.Motion.Start(state.Poses);
        Solve(state, Damping);
        _newton.Pivots.CopyTo(_pivots);
        Solve(state, LessDamping);
        ReadOnlySpan<double> pivots = _newton.Pivots;
        int free = _newton.Spare;
        for (int i = 0; i < pivots.Length; i++)
        {
            free += _pivots[i] > LeastShrink * pivots[i] ? 1 : 0;
        }

        return free;
    }

    private void Solve(MechanismState state, double damping)
    {
        _newton.Equations.Clear();
        _newton.Equations.AddClosures(state.Poses, state.Values);
        _newton.SolveStep(damping);
    }
}
