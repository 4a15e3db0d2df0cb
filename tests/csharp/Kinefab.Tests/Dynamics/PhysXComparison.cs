using System;
using System.Collections.Generic;
using Kinefab.Dynamics;
using Kinefab.Dynamics.Pgs;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics;

/// <summary>Largest differences between our run of a scenario and PhysX's.</summary>
/// <param name="Position">Metres.</param>
/// <param name="Angle">Radians.</param>
/// <param name="Range">Largest distance of any body from its start, metres.</param>
/// <param name="Turn">Largest angle of any body from its start, radians.</param>
/// <param name="Broken">Steps in which our joints broke.</param>
internal sealed record PhysXComparison(double Position, double Angle, double Range, double Turn, IReadOnlyList<int> Broken)
{
    public static PhysXComparison Run(Scenario scenario)
    {
        MultibodySystem mechanism = scenario.Build();
        var solver = new PgsSolver(mechanism);
        double position = 0;
        double angle = 0;
        double range = 0;
        double turn = 0;
        var broken = new List<int>();
        for (int step = 1; step <= scenario.Steps; step++)
        {
            int whole = Whole(mechanism);
            scenario.Drive(mechanism, step * scenario.Dt);
            solver.Step(scenario.Dt);
            for (int i = Whole(mechanism); i < whole; i++)
            {
                broken.Add(step);
            }

            if (step % scenario.Sample != 0)
            {
                continue;
            }

            for (int body = 0; body < mechanism.Bodies.Count; body++)
            {
                Pose expected = scenario.Expected(body, step / scenario.Sample - 1);
                Pose actual = mechanism.Bodies.Poses[body];
                position = Max(position, (actual.Position - expected.Position).Length);
                angle = Max(angle, AngleBetween(actual.Rotation, expected.Rotation));
                Pose first = scenario.Start(body);
                range = Math.Max(range, (expected.Position - first.Position).Length);
                turn = Math.Max(turn, AngleBetween(expected.Rotation, first.Rotation));
            }
        }

        return new PhysXComparison(position, angle, range, turn, broken);
    }

    private static double AngleBetween(Quaterniond a, Quaterniond b) => 2 * Math.Asin(Math.Min(1, (a.Conjugate() * b).Vector.Length));

    // Unlike Math.Max of a comparison, keeps a NaN.
    private static double Max(double a, double b) => double.IsNaN(b) || b > a ? b : a;

    private static int Whole(MultibodySystem mechanism)
    {
        int whole = 0;
        foreach (Kinefab.Joints.JointModel joint in mechanism.Joints)
        {
            whole += joint.IsBroken ? 0 : 1;
        }

        return whole;
    }
}
