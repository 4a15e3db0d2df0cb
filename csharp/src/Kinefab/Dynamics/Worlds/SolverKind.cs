namespace Kinefab.Dynamics;

/// <summary>How a <see cref="World"/> moves.</summary>
public enum SolverKind
{
    /// <summary>As Unity does: projected Gauss-Seidel with PhysX 4.1's rows, iteration counts, drift and softness.</summary>
    Unity,

    /// <summary>As the mechanism truly moves: loops stay closed and energy is kept.</summary>
    Exact,
}
