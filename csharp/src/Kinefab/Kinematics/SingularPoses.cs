using System;

namespace Kinefab.Kinematics;

/// <summary>
/// Tells the poses at which the joints lose a rank from all others: more pivots of J^T J vanish there than at a pose in
/// general position.
/// </summary>
internal sealed class SingularPoses
{
    // Radians, or lengths of the mechanism.
    private const double GeneralStep = 0.05;

    private readonly NewtonSolver _newton;
    private readonly int _regular;

    public SingularPoses(Mechanism mechanism, NewtonSolver newton)
    {
        _newton = newton;
        MechanismState state = mechanism.NewState();
        newton.Close(state);
        _regular = FreeAt(state);
        var step = new double[newton.Motion.Linear.Length];
        for (int i = 0; i < step.Length; i++)
        {
            // Anything without a pattern.
            step[i] = GeneralStep * Math.Sin(12.9898 * (i + 1));
        }

        newton.Motion.Move(state.Poses, step);
        if (newton.Close(state))
        {
            _regular = Math.Min(_regular, FreeAt(state));
        }
    }

    /// <summary>Whether a closed state stands (nearly) at such a pose.</summary>
    public bool Contains(MechanismState state) => FreeAt(state) > _regular;

    /// <summary>Whether the solver's last step, with its drivers, may have led to such a pose or to a dead centre.</summary>
    public bool MayBeNear => _newton.VanishingPivots > Math.Max(0, _regular - _newton.DrivenCount);

    // Of the joints and couplings alone, no limits and no drivers.
    private int FreeAt(MechanismState state)
    {
        _newton.ClearDriven();
        _newton.Motion.Start(state.Poses);
        _newton.Equations.Clear();
        _newton.Equations.AddClosures(state.Poses, state.Values);
        _newton.SolveStep(NewtonSolver.LeastDamping);
        return _newton.VanishedPivots;
    }
}
