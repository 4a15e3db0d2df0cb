using System;
using Kinefab.Dynamics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>A mechanism of tests/reference/dynamics: how it is built, driven and read.</summary>
internal sealed class BenchmarkMechanism
{
    public BenchmarkMechanism(string id, MechanismBuilder builder, Func<MultibodySystem, (string Quantity, double Value)[]> read)
    {
        Id = id;
        MultibodySystem = builder.Build();
        Read = read;
    }

    public string Id { get; }

    public MultibodySystem MultibodySystem { get; }

    public Func<MultibodySystem, (string Quantity, double Value)[]> Read { get; }

    /// <summary>Called before every step, for forces.</summary>
    public Action<MultibodySystem> Drive { get; set; } = _ => { };
}
