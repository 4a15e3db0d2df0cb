using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>How <see cref="Flight{V}"/> splits a body's rotation: which principal axis gives the sphere, which axes differ from it.</summary>
internal readonly struct Spin
{
    /// <summary>Axis of the middle moment, and the other two in cyclic order after it.</summary>
    public readonly int Sphere;
    public readonly int First;
    public readonly int Second;

    /// <summary>Whether the moments about these differ from the middle one; where only one does, it is the first.</summary>
    public readonly bool IsFirstOther;
    public readonly bool IsSecondOther;

    /// <param name="inverse">Inverse principal moments, 1/(kg m^2).</param>
    public Spin(Vector3d inverse)
    {
        Sphere = 0;
        for (int axis = 0; axis < 3; axis++)
        {
            double next = inverse[(axis + 1) % 3] - inverse[axis];
            double last = inverse[(axis + 2) % 3] - inverse[axis];
            if (next * last <= 0 && (next != 0 || last == 0))
            {
                Sphere = axis;
                break;
            }
        }

        First = (Sphere + 1) % 3;
        Second = (Sphere + 2) % 3;
        IsFirstOther = inverse[First] != inverse[Sphere];
        IsSecondOther = inverse[Second] != inverse[Sphere];
    }

    public bool Equals(Spin other) =>
        Sphere == other.Sphere && IsFirstOther == other.IsFirstOther && IsSecondOther == other.IsSecondOther;
}
