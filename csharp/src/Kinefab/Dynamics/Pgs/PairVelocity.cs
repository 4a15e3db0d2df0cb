using System;
using System.Runtime.CompilerServices;

namespace Kinefab.Dynamics.Pgs;

/// <summary>The velocities of a joint's two bodies while its rows are solved. Source: DySolverConstraints.cpp, solve1D.</summary>
internal ref struct PairVelocity
{
    public Double4 Linear0;
    public Double4 Angular0;
    public Double4 Linear1;
    public Double4 Angular1;

    public PairVelocity(Double4 linear0, Double4 angular0, Double4 linear1, Double4 angular1)
    {
        Linear0 = linear0;
        Angular0 = angular0;
        Linear1 = linear1;
        Angular1 = angular1;
    }

    /// <summary>Any rows, one after the other: lambda = clamp(i lambda + m Cdot + constant).</summary>
    public void SolveInTurn(Span<PgsRow> rows, in PairMass mass)
    {
        for (int i = 0; i < rows.Length; i++)
        {
            ref PgsRow row = ref rows[i];
            double impulse = row.ImpulseMultiplier * row.Impulse + row.VelocityMultiplier * Velocity(row) + row.Constant;
            impulse = Math.Min(row.Maximum, Math.Max(row.Minimum, impulse));
            double delta = impulse - row.Impulse;
            row.Impulse = impulse;
            Apply(row.Linear * delta, row.Sqrt0 * delta, row.Sqrt1 * delta, mass);
        }
    }

    /// <summary>Equalities that are mass-orthogonal: none changes another's Cdot, so all see the velocities from before.</summary>
    public void SolveTogether(Span<PgsRow> rows, in PairMass mass)
    {
        Double4 relative = Linear0 - Linear1;
        Double4 before0 = Angular0;
        Double4 before1 = Angular1;
        Double4 linear = default;
        Double4 angular0 = default;
        Double4 angular1 = default;
        for (int i = 0; i < rows.Length; i++)
        {
            ref PgsRow row = ref rows[i];
            double velocity = (row.Linear * relative + row.Sqrt0 * before0 - row.Sqrt1 * before1).Sum3;
            double delta = row.VelocityMultiplier * velocity + row.Constant;
            row.Impulse += delta;
            linear += row.Linear * delta;
            angular0 += row.Sqrt0 * delta;
            angular1 += row.Sqrt1 * delta;
        }

        Apply(linear, angular0, angular1, mass);
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private readonly double Velocity(in PgsRow row) => (row.Linear * (Linear0 - Linear1) + row.Sqrt0 * Angular0 - row.Sqrt1 * Angular1).Sum3;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private void Apply(Double4 linear, Double4 angular0, Double4 angular1, in PairMass mass)
    {
        Linear0 += linear * mass.InverseMass0;
        Linear1 -= linear * mass.InverseMass1;
        Angular0 += angular0 * mass.InertiaScale0;
        Angular1 -= angular1 * mass.InertiaScale1;
    }
}
