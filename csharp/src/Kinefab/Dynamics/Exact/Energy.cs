using Kinefab.Numerics;

namespace Kinefab.Dynamics.Exact;

/// <summary>Energy of an island on the only lane, J.</summary>
internal static class Energy
{
    /// <summary>Kinetic energy, less the work that the step's constant forces have done since x = 0.</summary>
    public static double Of(Batch<ScalarLane> batch)
    {
        double[] a = batch.Bodies;
        double sum = Kinetic(batch);
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<ScalarLane>.Body(body, 0);
            double work = 0;
            for (int i = 0; i < 3; i++)
            {
                work += a[o + BodySlot.Acceleration + i] * a[o + BodySlot.EndX + i];
            }

            sum -= work / a[o + BodySlot.InverseMass];
        }

        return sum;
    }

    /// <summary>Kinetic energy.</summary>
    public static double Kinetic(Batch<ScalarLane> batch)
    {
        double[] a = batch.Bodies;
        double sum = 0;
        for (int body = 0; body < batch.Shape.MovingBodies; body++)
        {
            int o = Batch<ScalarLane>.Body(body, 0);
            Vector3d w = Impulses<ScalarLane>.AngularVelocity(batch, body);
            double square = 0, turn = 0;
            for (int i = 0; i < 3; i++)
            {
                square += a[o + BodySlot.V + i] * a[o + BodySlot.V + i];
                turn += a[o + BodySlot.L + i] * w[i];
            }

            sum += square / (2 * a[o + BodySlot.InverseMass]) + turn / 2;
        }

        return sum;
    }
}
