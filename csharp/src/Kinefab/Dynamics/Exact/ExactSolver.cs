using System;
using System.Collections.Generic;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>
/// Solves each island of a mechanism directly: maximal coordinates, one block-sparse factorisation a step, closed to
/// the tolerance at position level, so that the mechanism's true motion is known.
/// </summary>
internal sealed class ExactSolver : ISolver
{
    private readonly Mechanism _mechanism;
    private readonly List<IslandGroup> _groups = new();

    /// <summary>A solver for the mechanism as it stands.</summary>
    /// <param name="mechanism">Bodies and joints.</param>
    /// <param name="maxWidth">Most islands to solve side by side; the result does not depend on it.</param>
    public ExactSolver(Mechanism mechanism, int maxWidth = int.MaxValue)
    {
        _mechanism = mechanism;
        List<Island> rest = Island.Find(mechanism, mechanism.Joints);
        while (rest.Count > 0)
        {
            Island shape = rest[0];
            List<Island> alike = rest.FindAll(i => ReferenceEquals(i, shape) || i.HasShapeOf(shape));
            rest.RemoveAll(alike.Contains);
            Group(alike, maxWidth);
        }
    }

    /// <inheritdoc/>
    public void Step(double dt)
    {
        foreach (IslandGroup group in _groups)
        {
            group.Step(dt);
        }

        Array.Clear(_mechanism.Bodies.Forces, 0, _mechanism.Bodies.Count);
        Array.Clear(_mechanism.Bodies.Torques, 0, _mechanism.Bodies.Count);
    }

    private void Group(List<Island> islands, int maxWidth)
    {
        const double tolerance = 1e-9;
#if NET
        if (maxWidth >= 8 && islands.Count >= 8 && System.Runtime.Intrinsics.Vector512.IsHardwareAccelerated)
        {
            int whole = islands.Count / 8 * 8;
            _groups.Add(new IslandGroup<Lane8>(_mechanism, islands.GetRange(0, whole), tolerance));
            islands.RemoveRange(0, whole);
        }

        if (maxWidth >= 4 && islands.Count >= 2 && System.Runtime.Intrinsics.Vector256.IsHardwareAccelerated)
        {
            _groups.Add(new IslandGroup<Lane4>(_mechanism, islands, tolerance));
            return;
        }
#endif
        if (islands.Count > 0)
        {
            _groups.Add(new IslandGroup<ScalarLane>(_mechanism, islands, tolerance));
        }
    }
}
