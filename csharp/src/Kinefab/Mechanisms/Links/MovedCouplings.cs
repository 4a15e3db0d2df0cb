using System;
using System.Collections.Generic;
using Kinefab.Document;

namespace Kinefab.Mechanisms;

/// <summary>Couplings whose joints stand elsewhere now.</summary>
internal static class MovedCouplings
{
    /// <summary>The same relation between the same motions.</summary>
    internal static Coupling Of(Coupling coupling, Func<JointCoordinate, JointCoordinate> now)
    {
        var terms = new List<CouplingTerm>();
        foreach (CouplingTerm term in coupling.Terms)
            terms.Add(term with { Coordinate = now(term.Coordinate) });
        return coupling with { A = coupling.A is JointCoordinate a ? now(a) : null, B = now(coupling.B), Terms = terms };
    }
}
