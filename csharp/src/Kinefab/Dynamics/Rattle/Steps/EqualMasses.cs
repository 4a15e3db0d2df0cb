using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Another metric in which to close a pose: all bodies of 1 kg, each with its own radii of gyration. In that of their own masses the least move is that of the
/// gram beside the tonne, also where it closes next to nothing: beside a singular pose, where C = -a x^2 - b y with x the gram's way and y the tonne's, the
/// iteration jumps to and fro over x = 0, while the tonne closes it by C / b at once.
/// </summary>
internal sealed class EqualMasses
{
    // An inverse mass, and three inverse moments behind it; the least of these stands elsewhere.
    private const int Together = 4;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly double[] _own;

    public EqualMasses(LaneBatch<ScalarLane> batch)
    {
        _batch = batch;
        _own = new double[(Together + 1) * batch.Shape.MovingBodies];
    }

    /// <summary>The bodies have one mass until <see cref="TakeBack"/>.</summary>
    public void Apply()
    {
        double[] a = _batch.Bodies;
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int own = (Together + 1) * body, at = LaneBatch<ScalarLane>.Body(body, BodyLanes.InverseMass), least = LaneBatch<ScalarLane>.Body(body, BodyLanes.LeastInverseInertia);
            Array.Copy(a, at, _own, own, Together);
            _own[own + Together] = a[least];
            double mass = 1 / a[at];
            for (int i = 0; i < Together; i++)
            {
                a[at + i] *= mass;
            }

            a[least] *= mass;
        }
    }

    /// <summary>They have their own again.</summary>
    public void TakeBack()
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int own = (Together + 1) * body;
            Array.Copy(_own, own, _batch.Bodies, LaneBatch<ScalarLane>.Body(body, BodyLanes.InverseMass), Together);
            _batch.Bodies[LaneBatch<ScalarLane>.Body(body, BodyLanes.LeastInverseInertia)] = _own[own + Together];
        }

        DelassusMatrix<ScalarLane>.InverseInertias(_batch);
    }
}
