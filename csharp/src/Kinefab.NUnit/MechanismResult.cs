using System.Collections.Generic;
using NUnit.Framework.Constraints;

namespace Kinefab.NUnit;

/// <summary>What came of a constraint, with the lines that a failure shows below "But was".</summary>
internal sealed class MechanismResult : ConstraintResult
{
    private readonly string _expected;
    private readonly string _found;
    private readonly IReadOnlyList<string> _details;

    /// <summary>A result.</summary>
    /// <param name="constraint">Whose.</param>
    /// <param name="actual">What was tested.</param>
    /// <param name="isSuccess">Whether it holds.</param>
    /// <param name="found">What was found instead, in a sentence with units.</param>
    /// <param name="details">The series, or the findings.</param>
    public MechanismResult(IConstraint constraint, object? actual, bool isSuccess, string found, IReadOnlyList<string>? details = null)
        : base(constraint, actual, isSuccess)
    {
        _expected = constraint.Description;
        _found = found;
        _details = details ?? [];
    }

    /// <inheritdoc/>
    public override void WriteMessageTo(MessageWriter writer)
    {
        writer.WriteLine($"  Expected: {_expected}");
        writer.WriteLine($"  But was:  {_found}");
        foreach (string line in _details)
            writer.WriteLine($"    {line}");
    }
}
