using System;
using System.Collections.Generic;
using BenchmarkDotNet.Attributes;
using Kinefab.Kinematics;
using Kinefab.Validation;

namespace Kinefab.Bench;

/// <summary>From a valid scene to its mobility report: what dotnet kinefab mobility does after loading.</summary>
[MemoryDiagnoser]
public class MobilityBenchmark
{
    private ValidScene _scene = null!;

    /// <summary>What is counted.</summary>
    [ParamsSource(nameof(Kinds))]
    public string Scene { get; set; } = "";

    /// <summary>About its number of joints.</summary>
    [Params(2000, 2000 * MobilityScenes.Growth)]
    public int Joints { get; set; }

    /// <summary>Names of the scenes.</summary>
    public static IEnumerable<string> Kinds => MobilityScenes.Kinds.Keys;

    /// <summary>Makes the scene.</summary>
    [GlobalSetup]
    public void Make() =>
        _scene = SceneValidator.Validate(MobilityScenes.Kinds[Scene](Joints)).Scene ?? throw new InvalidOperationException("The benchmark's scene is not valid.");

    /// <summary>A call.</summary>
    [Benchmark]
    public MobilityReport Mobility() => MobilityAnalysis.Of(Mechanism.Create(_scene));
}
