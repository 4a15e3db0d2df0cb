using Kinefab.Numerics;

namespace Kinefab.Dynamics.Pgs;

/// <summary>Change of a body's velocity since the start of the solve, the angular part in sqrt(I)-space.</summary>
internal struct BodyDelta
{
    public Double4 Linear;
    public Double4 Angular;
}
