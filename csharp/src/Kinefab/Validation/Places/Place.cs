using Kinefab.Diagnostics;
using Kinefab.Json;

namespace Kinefab.Validation;

/// <summary>
/// Where in the document a rule looks: <c>/collection/index</c>, or one component of a GameObject.
/// The pointer becomes text only when something is reported.
/// </summary>
internal readonly struct Place
{
    private readonly Findings findings;
    private readonly string collection;
    private readonly int index;
    private readonly int component;

    /// <summary>An item of one of the document's lists, or with a negative index a single object of the document.</summary>
    internal Place(Findings findings, string collection, int index = -1, int component = -1)
    {
        this.findings = findings;
        this.collection = collection;
        this.index = index;
        this.component = component;
    }

    /// <summary>Reports about a field (a relative pointer; empty: the whole object).</summary>
    internal void Report(string field, string code, params (string Name, string Value)[] values) =>
        findings.Add(Pointer(field), code, values);

    internal string Pointer(string field)
    {
        string pointer = "/" + collection;
        if (index >= 0)
            pointer += "/" + Invariant.Text(index);
        if (component >= 0)
            pointer += "/components/" + Invariant.Text(component);
        return field.Length == 0 ? pointer : pointer + "/" + field;
    }
}
