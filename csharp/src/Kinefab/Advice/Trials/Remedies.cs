using System.Collections.Generic;
using System.Linq;
using Kinefab.Advice.Changes;
using Kinefab.Kinematics;

namespace Kinefab.Advice.Trials;

/// <summary>The changes that may be tried on a scene; null where a scene has nothing of the kind.</summary>
internal sealed class Remedies
{
    private static readonly int[] Divisors = { 2, 4 };
    private static readonly int[] Factors = { 2, 4, 8 };

    public Remedies(Examination e, Mechanism? mechanism)
    {
        if (mechanism is not null && e.Mobility is MobilityReport counted)
        {
            ClosuresWhole = ClosureRows.Whole(e.Scene, mechanism, counted, out int notLocked);
            ClosuresMinimal = ClosureRows.Minimal(e.Scene, e.World.Joints.Count, counted, out int notFreed);
            RowsUntried = notLocked + notFreed;
        }

        PreprocessingOff = JointSettings.PreprocessingOff(e.Scene, e.World);
        InertiasRaised = BodySettings.RaiseInertias(e.Scene, e.World);
        MassesRaised = BodySettings.RaiseMasses(e.Scene, e.World);
        MassesScaled = BodySettings.ScaleMasses(e.Scene, e.World);
        SmallerSteps = Divisors.Select(n => ProjectSettings.FixedTimestep(e.Scene, n)).ToArray();
        Change?[] iterations = Factors.Select(n => ProjectSettings.SolverIterations(e.Scene, n)).ToArray();
        Change?[][] ladders =
        {
            new[] { ClosuresWhole },
            new[] { ClosuresMinimal },
            new[] { PreprocessingOff },
            new[] { JointSettings.Projection(e.Scene, e.World, e.Islands) },
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
