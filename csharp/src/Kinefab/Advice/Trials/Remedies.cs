using System.Collections.Generic;
using System.Linq;
using System.Threading;
using Kinefab.Advice.Changes;
using Kinefab.Advice.Runs;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Validation;

namespace Kinefab.Advice.Trials;

/// <summary>The changes that may be tried on a scene; null where a scene has nothing of the kind.</summary>
internal sealed class Remedies
{
    private static readonly int[] Divisors = { 2, 4 };
    private static readonly int[] Factors = { 2, 4, 8 };

    /// <summary>What may be tried.</summary>
    /// <param name="scene">As it stands.</param>
    /// <param name="world">Its world at the start.</param>
    /// <param name="islands">Of that world.</param>
    /// <param name="run">The scene as Unity moves it.</param>
    /// <param name="mechanism">Null in a scene of too many joints to count rows in, as is its mobility.</param>
    /// <param name="mobility">The mechanism's.</param>
    /// <param name="cancellation">Ends the counts that changes need early, with an OperationCanceledException.</param>
    public Remedies(ValidScene scene, World world, IReadOnlyList<RunIsland> islands, SceneRun run, Mechanism? mechanism, MobilityReport? mobility, CancellationToken cancellation)
    {
        if (mechanism is not null && mobility is MobilityReport counted)
        {
            ClosuresWhole = ClosureRows.Whole(scene, mechanism, counted, out int notLocked, cancellation);
            ClosuresMinimal = ClosureRows.Minimal(scene, world.Joints.Count, counted, out int notFreed, cancellation);
            RowsUntried = notLocked + notFreed;
        }

        PreprocessingOff = JointSettings.PreprocessingOff(scene, world);
        InertiasRaised = BodySettings.RaiseInertias(scene, world);
        MassesRaised = BodySettings.RaiseMasses(scene, world);
        MassesScaled = BodySettings.ScaleMasses(scene, world);
        SmallerSteps = Divisors.Select(n => ProjectSettings.FixedTimestep(scene, n)).ToArray();
        Change?[] iterations = Factors.Select(n => ProjectSettings.SolverIterations(scene, n)).ToArray();
        Change?[][] ladders =
        {
            new[] { JointSettings.ExtendedLimits(scene, world, run) },
            new[] { ClosuresWhole },
            new[] { ClosuresMinimal },
            new[] { PreprocessingOff },
            new[] { JointSettings.Projection(scene, world, islands) },
            iterations,
            SmallerSteps,
            new[] { InertiasRaised },
            new[] { MassesRaised },
            new[] { MassesScaled },
        };
        Ladders = ladders.Select(ladder => ladder.OfType<Change>().ToArray()).Where(ladder => ladder.Length > 0).ToArray();
    }

    public Change? ClosuresWhole { get; }

    public Change? ClosuresMinimal { get; }

    /// <summary>Rows of loops that were neither locked nor freed, since there are too many.</summary>
    public int RowsUntried { get; }

    public Change? PreprocessingOff { get; }

    public Change? InertiasRaised { get; }

    public Change? MassesRaised { get; }

    public Change? MassesScaled { get; }

    /// <summary>A half and a quarter of the scene's.</summary>
    public Change[] SmallerSteps { get; }

    /// <summary>Against trouble of any cause; of each ladder the next change is only tried while the one before is not enough.</summary>
    public IReadOnlyList<Change[]> Ladders { get; }
}
