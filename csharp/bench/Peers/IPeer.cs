using System;
using Kinefab.Dynamics;

namespace Kinefab.Bench.Peers;

/// <summary>One engine with one scene in it: hinges, driven or free, between bodies and the world, no contacts, no damping, no sleep.</summary>
internal interface IPeer : IDisposable
{
    /// <summary>Moves the scene on, on the thread that calls.</summary>
    /// <param name="dt">s.</param>
    void Step(double dt);

    /// <summary>Writes poses and velocities to the bodies that the scene was made from, which judge drift and energy.</summary>
    void Write(Bodies bodies);
}

/// <summary>This library's own solvers in the same place.</summary>
internal sealed class KinefabPeer : IPeer
{
    private readonly ISolver _solver;

    public KinefabPeer(ISolver solver) => _solver = solver;

    public void Step(double dt) => _solver.Step(dt);

    public void Write(Bodies bodies)
    {
    }

    public void Dispose()
    {
    }
}
