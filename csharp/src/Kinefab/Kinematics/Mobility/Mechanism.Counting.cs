using System;
using System.Collections.Generic;
using System.Threading;

namespace Kinefab.Kinematics;

/// <content>Mobility in one call: apart, since its analysis knows the mechanism.</content>
public sealed partial class Mechanism
{
    /// <summary>Counts what the joints leave free, as <see cref="MobilityAnalysis.Of"/>.</summary>
    /// <param name="progress">Told the share of the loops that is done, 0 to 1; null: nobody is.</param>
    /// <param name="cancellation">Ends the analysis early.</param>
    /// <returns>The count of the whole and of each island.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    /// <example><code>
    /// Assert.That(Mechanism.Load("lever.kinefab").CountMobility().Mobility, Is.EqualTo(1));
    /// </code></example>
    public MobilityReport CountMobility(IProgress<double>? progress = null, CancellationToken cancellation = default) =>
        MobilityAnalysis.Of(this, progress, cancellation);

    /// <summary>
    /// Coordinates that together tell where everything stands, one for each freedom: what a slider or a motor is wanted for. Those that the
    /// scene drives come before others, hinges and slides at what holds the mechanism before those inside it, and no angle of a ball in a
    /// loop. What moves as nothing but a spin between two balls, or hangs on no joint, has none.
    /// </summary>
    /// <param name="cancellation">Ends the analysis early.</param>
    /// <returns>Indices into <see cref="Coordinates"/>, rising.</returns>
    /// <exception cref="OperationCanceledException">It was cancelled.</exception>
    public IReadOnlyList<int> ChooseFreedoms(CancellationToken cancellation = default) => FreedomChoice.Of(this, cancellation);
}
