using System;
using System.Threading;

namespace Kinefab.Kinematics;

/// <content>Sweeps in one call: apart, since a sweep knows its mechanism.</content>
public sealed partial class Mechanism
{
    /// <summary>
    /// Takes a coordinate from one value to another in equal steps, from the exported pose, and keeps every state. What the mechanism
    /// does is no error: where it is stopped, <see cref="SweepResult.Stop"/> says by what.
    /// </summary>
    /// <param name="coordinate">Such as Shaft or Lever/Crank:1.angle, see <see cref="TryFindCoordinate"/>.</param>
    /// <param name="from">Degrees or metres from the exported pose; driven to first.</param>
    /// <param name="to">Degrees or metres from the exported pose.</param>
    /// <param name="steps">At least 1; one state more is kept.</param>
    /// <param name="progress">Told the number of steps done after each; null: nobody is.</param>
    /// <param name="cancellation">Ends the sweep early.</param>
    /// <returns>A state for each value reached, the first at the start; where the motion ended early, why.</returns>
    /// <exception cref="ArgumentException">No coordinate answers to the name, or several do (the message says which there are).</exception>
    /// <exception cref="ArgumentOutOfRangeException">A value is no finite number, or farther than <see cref="MechanismCoordinate.Farthest"/>, or there is not
    /// even 1 step.</exception>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    /// <example><code>
    /// SweepResult sweep = Mechanism.Load("lever.kinefab").Sweep("Shaft", 0, 360, 72);
    /// double stroke = sweep["Slide"].Max() - sweep["Slide"].Min();
    /// Pose bar = sweep.Pose("BarC:1", 36);
    /// </code></example>
    public SweepResult Sweep(string coordinate, double from, double to, int steps = 72, IProgress<int>? progress = null, CancellationToken cancellation = default)
    {
        int index = CoordinateNamed(coordinate);
        return new Sweep(new PositionSolver(this, cancellation)).Run(NewState(), index, from, to, steps, progress, cancellation);
    }
}
