#if NET
using System;
using System.Runtime.CompilerServices;
using System.Runtime.Intrinsics;

namespace Kinefab.Numerics;

/// <summary>Four lanes (AVX2; elsewhere two of 128 bits).</summary>
internal readonly struct Lane4 : ILane<Lane4>
{
    private readonly Vector256<double> _value;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private Lane4(Vector256<double> value) => _value = value;

    public int Width
    {
        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        get => 4;
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Load(double[] array, int index, int skip) =>
        new(Vector256.LoadUnsafe(ref System.Runtime.InteropServices.MemoryMarshal.GetArrayDataReference(array), (nuint)(uint)index + (nuint)(4 * skip)));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public void Store(double[] array, int index, int skip) =>
        _value.StoreUnsafe(ref System.Runtime.InteropServices.MemoryMarshal.GetArrayDataReference(array), (nuint)(uint)index + (nuint)(4 * skip));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Gather(ReadOnlySpan<double> from, ReadOnlySpan<int> records, int stride, int column) =>
        new(Vector256.Create(
            from[records[0] * stride + column], from[records[1] * stride + column],
            from[records[2] * stride + column], from[records[3] * stride + column]));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Splat(double value) => new(Vector256.Create(value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Add(Lane4 other) => new(_value + other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Subtract(Lane4 other) => new(_value - other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Multiply(Lane4 other) => new(_value * other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Divide(Lane4 other) => new(_value / other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 SquareRoot() => new(Vector256.Sqrt(_value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Absolute() => new(Vector256.Abs(_value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Maximum(Lane4 other) => new(Vector256.MaxNative(_value, other._value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Minimum(Lane4 other) => new(Vector256.MinNative(_value, other._value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane4 Select(Lane4 first, Lane4 second) =>
        new(Vector256.ConditionalSelect(Vector256.Equals(_value, Vector256<double>.Zero), second._value, first._value));
}

/// <summary>Eight lanes (AVX-512).</summary>
internal readonly struct Lane8 : ILane<Lane8>
{
    private readonly Vector512<double> _value;

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    private Lane8(Vector512<double> value) => _value = value;

    public int Width
    {
        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        get => 8;
    }

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Load(double[] array, int index, int skip) =>
        new(Vector512.LoadUnsafe(ref System.Runtime.InteropServices.MemoryMarshal.GetArrayDataReference(array), (nuint)(uint)index + (nuint)(8 * skip)));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public void Store(double[] array, int index, int skip) =>
        _value.StoreUnsafe(ref System.Runtime.InteropServices.MemoryMarshal.GetArrayDataReference(array), (nuint)(uint)index + (nuint)(8 * skip));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Gather(ReadOnlySpan<double> from, ReadOnlySpan<int> records, int stride, int column) =>
        new(Vector512.Create(
            from[records[0] * stride + column], from[records[1] * stride + column],
            from[records[2] * stride + column], from[records[3] * stride + column],
            from[records[4] * stride + column], from[records[5] * stride + column],
            from[records[6] * stride + column], from[records[7] * stride + column]));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Splat(double value) => new(Vector512.Create(value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Add(Lane8 other) => new(_value + other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Subtract(Lane8 other) => new(_value - other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Multiply(Lane8 other) => new(_value * other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Divide(Lane8 other) => new(_value / other._value);

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 SquareRoot() => new(Vector512.Sqrt(_value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Absolute() => new(Vector512.Abs(_value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Maximum(Lane8 other) => new(Vector512.MaxNative(_value, other._value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Minimum(Lane8 other) => new(Vector512.MinNative(_value, other._value));

    [MethodImpl(MethodImplOptions.AggressiveInlining)]
    public Lane8 Select(Lane8 first, Lane8 second) =>
        new(Vector512.ConditionalSelect(Vector512.Equals(_value, Vector512<double>.Zero), second._value, first._value));
}
#endif
