using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Threading;
using Kinefab.Advice;
using Kinefab.Document;
using Kinefab.Dynamics;
using Kinefab.Kinematics;
using Kinefab.Validation;
using NUnit.Framework;

namespace Kinefab.Tests.Packaging;

/// <summary>What reads, counts, moves along a way, or runs can be ended early, whatever scene it is given. A single step or pose cannot.</summary>
public sealed class CancellationTests
{
    // What such calls give back.
    private static readonly HashSet<Type> Results = new()
    {
        typeof(SceneReading), typeof(SceneValidation), typeof(ValidScene), typeof(MobilityReport), typeof(SweepResult), typeof(RunResult), typeof(AdviceReport),
        typeof((RangeLimit, RangeLimit)),
    };

    [Test]
    public void PublicCalls_ThatMayTakeLong_CanBeCancelled()
    {
        MethodInfo[] calls = typeof(World).Assembly.GetExportedTypes()
            .SelectMany(type => type.GetMethods(BindingFlags.Public | BindingFlags.Instance | BindingFlags.Static | BindingFlags.DeclaredOnly))
            .Where(method => !method.IsSpecialName && Results.Contains(method.ReturnType))
            .ToArray();
        Assert.That(calls.Select(call => call.ReturnType).Distinct(), Is.EquivalentTo(Results));
        Assert.That(calls.Where(call => call.GetParameters().All(p => p.ParameterType != typeof(CancellationToken))).Select(call => $"{call.DeclaringType}.{call}"), Is.Empty);
    }
}
