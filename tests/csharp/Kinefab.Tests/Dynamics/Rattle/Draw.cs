using System;
using Kinefab.Numerics;

namespace Kinefab.Tests.Dynamics.Rattle;

/// <summary>Numbers by chance, the same for a seed, as generators of scenes draw them.</summary>
internal sealed class Draw
{
    private readonly Random _random;

    public Draw(int seed) => _random = new Random(seed);

    /// <summary>From 0 on, below a number.</summary>
    public int Below(int end) => _random.Next(end);

    /// <summary>From one number on, below another.</summary>
    public int From(int first, int end) => _random.Next(first, end);

    /// <summary>Whether it is the one case of so many.</summary>
    public bool One(int of) => _random.Next(of) == 0;

    /// <summary>Evenly.</summary>
    public double Between(double low, double high) => low + (high - low) * _random.NextDouble();

    /// <summary>Ten to a power between two.</summary>
    public double Power(double low, double high) => Math.Pow(10, Between(low, high));

    /// <summary>Each component between a size and its negative.</summary>
    public Vector3d Vector(double size) => new(Between(-size, size), Between(-size, size), Between(-size, size));

    /// <summary>Any rotation.</summary>
    public Quaterniond Turn() => new Quaterniond(Between(-1, 1), Between(-1, 1), Between(-1, 1), Between(-1, 1)).Normalized();
}
