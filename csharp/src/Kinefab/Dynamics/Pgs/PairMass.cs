using System.Runtime.CompilerServices;

namespace Kinefab.Dynamics.Pgs;

/// <summary>Inverse masses of a body pair as one joint sees them.</summary>
internal readonly struct PairMass
{
    public readonly double InverseMass0;
    public readonly double InverseMass1;

    /// <summary>Factors on the sqrt-space products, which already hold the inertias.</summary>
    public readonly double InertiaScale0;
    public readonly double InertiaScale1;

    public PairMass(double inverseMass0, double inverseMass1, double inertiaScale0, double inertiaScale1)
    {
        InverseMass0 = inverseMass0;
        InverseMass1 = inverseMass1;
        InertiaScale0 = inertiaScale0;
        InertiaScale1 = inertiaScale1;
    }

    /// <summary>J_a M^-1 J_b^T.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public double Product(in RowVectors a, in RowVectors b) =>
        (a.Linear * b.Linear * (InverseMass0 + InverseMass1) + a.Sqrt0 * b.Sqrt0 * InertiaScale0 + a.Sqrt1 * b.Sqrt1 * InertiaScale1).Sum3;
}
