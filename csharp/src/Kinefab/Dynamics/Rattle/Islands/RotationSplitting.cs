using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>How <see cref="FreeMotion{V}"/> splits a body's rotation: which principal axis gives the sphere, which axes differ from it.</summary>
internal readonly struct RotationSplitting
{
    /// <summary>Axis of the middle moment, and the other two in cyclic order after it.</summary>
    public readonly int Spherical;
    public readonly int AxisA;
    public readonly int AxisB;

    /// <summary>Whether the moments about these differ from the middle one; where only one does, it is the first.</summary>
    public readonly bool IsADistinct;
    public readonly bool IsBDistinct;

    /// <param name="inverse">Inverse principal moments, 1/(kg m^2).</param>
    public RotationSplitting(Vector3d inverse)
    {
        Spherical = 0;
        for (int axis = 0; axis < 3; axis++)
        {
            double next = inverse[(axis + 1) % 3] - inverse[axis];
            double last = inverse[(axis + 2) % 3] - inverse[axis];
            if (next * last <= 0 && (next != 0 || last == 0))
            {
                Spherical = axis;
                break;
            }
        }

        AxisA = (Spherical + 1) % 3;
        AxisB = (Spherical + 2) % 3;
        IsADistinct = inverse[AxisA] != inverse[Spherical];
        IsBDistinct = inverse[AxisB] != inverse[Spherical];
    }

    public bool Equals(RotationSplitting other) =>
        Spherical == other.Spherical && IsADistinct == other.IsADistinct && IsBDistinct == other.IsBDistinct;
}
