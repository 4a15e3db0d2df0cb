using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>How many parts a step is to be cut into up front: where bodies turn far, or where tension makes them stiff.</summary>
internal static class StepLimit
{
    // Geometric stiffness against inertia, times h^2, above which RATTLE is given shorter steps: half of what a leapfrog is stable below.
    private const double MostStiffness = 2;

    // Largest turn of a body in a step, radians.
    private const double MostTurn = 0.5;

    /// <summary>Up to 1 a plain RATTLE step of dt will do; above, it takes as many shorter ones.</summary>
    /// <param name="stiffness">Largest <see cref="BodyLanes.Stiffness"/>.</param>
    /// <param name="speed">Largest angular speed, rad/s.</param>
    /// <param name="dt">Step, s.</param>
    public static double Of(double stiffness, double speed, double dt) =>
        Math.Max(dt * Math.Sqrt(stiffness / MostStiffness), dt * speed / MostTurn);

    /// <summary>That of an island on the only lane, by its momenta and the stiffness that was last measured.</summary>
    public static double Of(LaneBatch<ScalarLane> batch, double dt)
    {
        double fastest = 0;
        double square = 0;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, 0);
            square = Math.Max(square, Impulses<ScalarLane>.AngularVelocity(batch, body).LengthSquared);
            FreeMotion<ScalarLane>.SphericalHalfRate(batch.Bodies, o, batch.Shape.RotationSplittings[body]).Store(batch.Work.Fastest, 0);
            fastest = Math.Max(fastest, batch.Work.Fastest[0]);
        }

        return Of(Stiffest(batch, 0), Math.Max(fastest, Math.Sqrt(square)), dt);
    }

    /// <summary>Largest <see cref="BodyLanes.Stiffness"/> of a lane.</summary>
    public static double Stiffest<V>(LaneBatch<V> batch, int lane)
        where V : struct, ILane<V>
    {
        double stiffest = 0;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            stiffest = Math.Max(stiffest, batch.Bodies[LaneBatch<V>.Body(body, BodyLanes.Stiffness) + lane]);
        }

        return stiffest;
    }
}
