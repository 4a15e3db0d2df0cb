using System;
using System.Runtime.CompilerServices;

namespace Kinefab.Numerics;

/// <summary>
/// Doubles that go through the same arithmetic side by side. Only operations that are correctly rounded by IEEE 754 are
/// offered (no fused multiply-add, no transcendental), so that a lane's result has the same bits at every width.
/// </summary>
/// <typeparam name="TSelf">The implementing struct.</typeparam>
internal interface ILane<TSelf>
    where TSelf : struct
{
    /// <summary>Number of lanes; the same for every value of the type.</summary>
    int Width { get; }

    /// <summary>Width doubles from the index on, skipping so many lanes' before; the receiver's value does not matter.</summary>
    TSelf Load(double[] array, int index, int skip);

    /// <summary>Writes Width doubles there.</summary>
    void Store(double[] array, int index, int skip);

    /// <summary>For each lane one number of a record of its own: from[records[lane] * stride + column]; the receiver's value does not matter.</summary>
    TSelf Gather(ReadOnlySpan<double> from, ReadOnlySpan<int> records, int stride, int column);

    /// <summary>The same number in every lane; the receiver's value does not matter.</summary>
    TSelf Splat(double value);

    TSelf Add(TSelf other);

    TSelf Subtract(TSelf other);

    TSelf Multiply(TSelf other);

    TSelf Divide(TSelf other);

    TSelf SquareRoot();

    TSelf Absolute();

    /// <summary>
    /// The larger, by one instruction and no branch. Where either is not a number: the other on x86 and netstandard2.1, but not
    /// a number on ARM, whose native instructions hand it on; no caller may depend on it. So too for <see cref="Minimum"/>.
    /// </summary>
    TSelf Maximum(TSelf other);

    TSelf Minimum(TSelf other);

    /// <summary>Lane by lane: the first where the receiver is not 0, the second where it is.</summary>
    TSelf Select(TSelf first, TSelf second);
}

/// <summary>Operators over <see cref="ILane{TSelf}"/>, which netstandard2.1 could not declare in the interface.</summary>
internal readonly struct Lane<V>
    where V : struct, ILane<V>
{
    private readonly V _value;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private Lane(V value) => _value = value;

    /// <summary>Number of lanes.</summary>
    public static int Width
    {
        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        get => default(V).Width;
    }

    /// <summary>The numbers at index + skip * Width. A constant skip is part of the load's address and costs nothing.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Load(double[] array, int index, int skip = 0) => new(default(V).Load(array, index, skip));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public void Store(double[] array, int index, int skip = 0) => _value.Store(array, index, skip);

    /// <inheritdoc cref="ILane{TSelf}.Gather"/>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Gather(ReadOnlySpan<double> from, ReadOnlySpan<int> records, int stride, int column) =>
        new(default(V).Gather(from, records, stride, column));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Splat(double value) => new(default(V).Splat(value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> operator +(Lane<V> a, Lane<V> b) => new(a._value.Add(b._value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> operator -(Lane<V> a, Lane<V> b) => new(a._value.Subtract(b._value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> operator *(Lane<V> a, Lane<V> b) => new(a._value.Multiply(b._value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> operator /(Lane<V> a, Lane<V> b) => new(a._value.Divide(b._value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Sqrt(Lane<V> a) => new(a._value.SquareRoot());

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Abs(Lane<V> a) => new(a._value.Absolute());

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Max(Lane<V> a, Lane<V> b) => new(a._value.Maximum(b._value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Min(Lane<V> a, Lane<V> b) => new(a._value.Minimum(b._value));

    /// <summary>The first where the mask is not 0, the second where it is.</summary>
    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public static Lane<V> Select(Lane<V> mask, Lane<V> first, Lane<V> second) => new(mask._value.Select(first._value, second._value));
}

/// <summary>One lane: a plain double.</summary>
internal readonly struct ScalarLane : ILane<ScalarLane>
{
    private readonly double _value;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private ScalarLane(double value) => _value = value;

    public int Width
    {
        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        get => 1;
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Load(double[] array, int index, int skip) =>
#if NET
        new(Unsafe.Add(ref System.Runtime.InteropServices.MemoryMarshal.GetArrayDataReference(array), (nint)(uint)index + skip));
#else
        new(array[index + skip]);
#endif


    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public void Store(double[] array, int index, int skip) =>
#if NET
        Unsafe.Add(ref System.Runtime.InteropServices.MemoryMarshal.GetArrayDataReference(array), (nint)(uint)index + skip) = _value;
#else
        array[index + skip] = _value;
#endif


    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Gather(ReadOnlySpan<double> from, ReadOnlySpan<int> records, int stride, int column) =>
        new(from[records[0] * stride + column]);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Splat(double value) => new(value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Add(ScalarLane other) => new(_value + other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Subtract(ScalarLane other) => new(_value - other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Multiply(ScalarLane other) => new(_value * other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Divide(ScalarLane other) => new(_value / other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane SquareRoot() => new(Math.Sqrt(_value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Absolute() => new(Math.Abs(_value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Maximum(ScalarLane other) =>
#if NET
        new(double.MaxNative(_value, other._value));
#else
        new(_value > other._value ? _value : other._value);
#endif

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Minimum(ScalarLane other) =>
#if NET
        new(double.MinNative(_value, other._value));
#else
        new(_value < other._value ? _value : other._value);
#endif

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public ScalarLane Select(ScalarLane first, ScalarLane second) => _value != 0 ? first : second;
}
