using Kinefab.Numerics;

namespace Kinefab.Dynamics.Articulations;

/// <summary>Rows of joints that hold one link to the world: PhysX solves them on the way through the tree, right after the link's own.</summary>
internal interface ILinkRows
{
    /// <summary>Whether a link has any.</summary>
    bool Has(int link);

    /// <summary>Solves them once.</summary>
    /// <param name="link">Which.</param>
    /// <param name="change">Change of its motion in the sweeps since the last flush; takes what the rows add.</param>
    /// <param name="impulse">Impulses on it in this visit; takes what the rows add.</param>
    /// <returns>Whether any gave something.</returns>
    bool Solve(int link, ref Twist change, ref Wrench impulse);
}
