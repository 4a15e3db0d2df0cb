using System;
using System.Collections.Generic;

namespace Kinefab.Document;

/// <summary>A joint between the Rigidbody of its own GameObject and another one, or the world.</summary>
public abstract record Joint : Component
{
    private protected Joint()
    {
    }

    /// <summary>Of the joint in the source: what stays when it is renamed; null when it is not told.</summary>
    [Since(1)]
    public string? Id { get; init; }

    /// <summary>The user's own name for the joint in the source; null when it has none.</summary>
    [Since(1)]
    public string? Name { get; init; }

    /// <summary>Id of the source's part on the own side, where it moves with the own body and another GameObject has the Rigidbody; null: this one.</summary>
    [Since(1)]
    public string? Part { get; init; }

    /// <summary>Id of the source's part on the connected side, likewise; null: that of <see cref="ConnectedBody"/>.</summary>
    [Since(1)]
    public string? ConnectedPart { get; init; }

    /// <summary>False: the source has it and switches it off; it holds nothing, as if it were not there. No joint of Unity's can be so.</summary>
    [Since(1)]
    public bool Enabled { get; init; } = true;

    /// <summary>Index of the GameObject whose Rigidbody is connected; null: the world.</summary>
    public int? ConnectedBody { get; init; }

    /// <summary>N; infinite: unbreakable.</summary>
    public double BreakForce { get; init; } = double.PositiveInfinity;

    /// <summary>N m; infinite: unbreakable.</summary>
    public double BreakTorque { get; init; } = double.PositiveInfinity;

    /// <summary>Whether the two bodies collide with each other.</summary>
    public bool EnableCollision { get; init; }

    /// <summary>PhysX's preprocessing; off helps over-constrained set-ups.</summary>
    public bool EnablePreprocessing { get; init; } = true;

    /// <summary>Scale on the INVERSE mass and inertia of the own body.</summary>
    public double MassScale { get; init; } = 1;

    /// <summary>Scale on the INVERSE mass and inertia of the connected body.</summary>
    public double ConnectedMassScale { get; init; } = 1;

    /// <summary>Source constraints or joints that this one comes from.</summary>
    public IReadOnlyList<string> Because { get; init; } = Array.Empty<string>();

    /// <summary>Closes a loop: the spanning tree does not need it.</summary>
    public bool Closure { get; init; }

    /// <summary>False where the component only approximates the source's relation.</summary>
    public bool Exact { get; init; } = true;

    /// <summary>What it holds its body to, and what breaks it.</summary>
    private protected string Ends =>
        Line($"to {(ConnectedBody is int body ? $"object {body}" : "the world")}{(BreakForce < double.PositiveInfinity ? Line($", breaks at {BreakForce} N") : "")}{(BreakTorque < double.PositiveInfinity ? Line($", breaks at {BreakTorque} N m") : "")}{(Closure ? ", closes a loop" : "")}");
}
