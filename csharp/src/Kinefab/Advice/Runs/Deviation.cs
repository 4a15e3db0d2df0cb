using System;
using System.Collections.Generic;
using System.Linq;
using Kinefab.Dynamics;
using Kinefab.Numerics;

namespace Kinefab.Advice.Runs;

/// <summary>How far the bodies of two runs of a scene stand apart; for an island that falls, beside its centre of mass.</summary>
internal sealed class Deviation
{
    private readonly SceneRun _a;
    private readonly SceneRun _b;
    private readonly RunIsland _island;
    private readonly IReadOnlyList<WorldBody> _bodies;

    public Deviation(SceneRun a, SceneRun b, RunIsland island, IReadOnlyList<WorldBody> bodies)
    {
        _a = a;
        _b = b;
        _island = island;
        _bodies = bodies;
    }

    /// <summary>Of each body of the island at one sample, in the island's order.</summary>
    public AdviceMeasure[] At(int k)
    {
        // Falling is none of the joints' affair, and every time-stepping has its own error in it.
        Vector3d fall = _island.IsFloating ? Center(_a.Centers[k]) - Center(_b.Centers[k]) : Vector3d.Zero;
        return Array.ConvertAll(_island.Bodies, body =>
        {
            Quaterniond turn = _a.Rotations[k][body].Conjugate() * _b.Rotations[k][body];
            double angle = 2 * Trigonometry.Atan2(turn.Vector.Length, Math.Abs(turn.W)) * (180 / Math.PI);
            return new AdviceMeasure((_a.Centers[k][body] - _b.Centers[k][body] - fall).Length, angle);
        });
    }

    /// <summary>The largest of each body over the samples before one.</summary>
    public AdviceMeasure[] Worst(int until)
    {
        var worst = new AdviceMeasure[_island.Bodies.Length];
        for (int k = 0; k < until; k++)
        {
            AdviceMeasure[] here = At(k);
            for (int i = 0; i < worst.Length; i++)
                worst[i] = AdviceMeasure.Max(worst[i], here[i]);
        }

        return worst;
    }

    private Vector3d Center(Vector3d[] centers)
    {
        Vector3d sum = Vector3d.Zero;
        foreach (int body in _island.Bodies)
            sum += centers[body] * _bodies[body].Settings.Mass;
        return sum * (1 / _island.Bodies.Sum(b => _bodies[b].Settings.Mass));
    }
}
