using System;
using System.Globalization;

namespace Kinefab.Tests;

/// <summary>Numbers as half of the world writes them, until it is disposed of: 2,5. The runtime of the tests may have no other culture than the invariant one.</summary>
internal sealed class CommaCulture : IDisposable
{
    private readonly CultureInfo _before = CultureInfo.CurrentCulture;

    public CommaCulture()
    {
        var comma = (CultureInfo)CultureInfo.InvariantCulture.Clone();
        comma.NumberFormat.NumberDecimalSeparator = ",";
        CultureInfo.CurrentCulture = comma;
    }

    public void Dispose() => CultureInfo.CurrentCulture = _before;
}
