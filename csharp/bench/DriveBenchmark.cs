using System;
using System.Collections.Generic;
using BenchmarkDotNet.Attributes;
using Kinefab.Kinematics;
using Kinefab.Validation;

namespace Kinefab.Bench;

/// <summary>One warm drive call of 2 degrees, as a hand on a lever makes them: there and back over 40 degrees.</summary>
[MemoryDiagnoser]
public class DriveBenchmark
{
    private const int Coordinate = 0;
    private const double Step = 2;
    private const double Range = 40;

    private PositionSolver _solver = null!;
    private MechanismState _state = null!;
    private double _phase;

    /// <summary>What is driven.</summary>
    [ParamsSource(nameof(Scenes))]
    public string Scene { get; set; } = "";

    /// <summary>Names of the mechanisms.</summary>
    public static IEnumerable<string> Scenes => DriveScenes.All.Keys;

    /// <summary>Makes the mechanism.</summary>
    [GlobalSetup]
    public void Make()
    {
        ValidScene scene = SceneValidator.Validate(DriveScenes.All[Scene]()).Scene ?? throw new InvalidOperationException("The benchmark's scene is not valid.");
        Mechanism mechanism = Mechanism.Create(scene);
        _solver = new PositionSolver(mechanism);
        _state = mechanism.NewState();
        _phase = 0;
    }

    /// <summary>A call.</summary>
    [Benchmark]
    public DriveResult Drive()
    {
        _phase = (_phase + Step) % (2 * Range);
        DriveResult result = _solver.Drive(_state, Coordinate, _phase < Range ? _phase : 2 * Range - _phase);
        if (!result.Converged)
            throw new InvalidOperationException($"{Scene}: {result.Status}");
        return result;
    }
}
