using System;
using Kinefab.Numerics;

namespace Kinefab.Advice.Runs;

/// <summary>How far the bodies of two runs of a scene stand apart.</summary>
internal static class Deviation
{
    /// <summary>The largest of one body, over the samples before one.</summary>
    public static AdviceMeasure Of(SceneRun a, SceneRun b, int body, int until)
    {
        AdviceMeasure worst = default;
        for (int k = 0; k < until; k++)
            worst = AdviceMeasure.Max(worst, At(a, b, body, k));
        return worst;
    }

    /// <summary>At one sample.</summary>
    public static AdviceMeasure At(SceneRun a, SceneRun b, int body, int k)
    {
        Quaterniond turn = a.Rotations[k][body].Conjugate() * b.Rotations[k][body];
        double angle = 2 * Math.Atan2(turn.Vector.Length, Math.Abs(turn.W)) * (180 / Math.PI);
        return new AdviceMeasure((a.Centers[k][body] - b.Centers[k][body]).Length, angle);
    }
}
