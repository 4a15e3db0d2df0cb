using System;
using System.Globalization;
using System.Runtime.InteropServices;
using System.Threading;
using Kinefab.Diagnostics;
using Kinefab.Document;
using Kinefab.Json;

namespace Kinefab.Validation;

/// <summary>Buffers: that they are the ones the scene was written with, and hold what meshes say they hold.</summary>
internal static class BufferRules
{
    /// <summary>Whether a buffer can be used at all.</summary>
    internal static bool Check(SceneBuffer buffer, in Place at, CancellationToken cancellation)
    {
        NumberRules.AtLeast(at, "byteLength", buffer.ByteLength, 0);
        bool named = Sha256(buffer.Sha256, "sha256", at);
        if (buffer.Uri is string uri && !BufferUri.IsSafe(uri))
        {
            at.Report("uri", DiagnosticCodes.BufferUriUnsafe, ("uri", uri));
            return false;
        }

        return Present(buffer, at) && named && SameBytes(buffer, at, cancellation);
    }

    /// <summary>64 lower-case hexadecimal digits.</summary>
    internal static bool Sha256(string text, string field, in Place at)
    {
        bool valid = text.Length == 64;
        foreach (char c in text)
            valid &= c is (>= '0' and <= '9') or (>= 'a' and <= 'f');
        if (!valid)
            at.Report(field, DiagnosticCodes.Sha256Invalid);
        return valid;
    }

    /// <summary>Whether an accessor, if there is one, stays inside its buffer, on a multiple of 4.</summary>
    internal static bool Accessor(Accessor? accessor, long byteCount, bool[] usable, SceneDocument document, string field, in Place at)
    {
        if (accessor is null)
            return true;
        if (!NumberRules.Reference(at, field + "/buffer", accessor.Buffer, "buffers", document.Buffers.Count))
            return false;
        if (accessor.Offset < 0 || accessor.Offset % 4 != 0)
        {
            at.Report(field + "/offset", DiagnosticCodes.BufferMisaligned, ("offset", Invariant.Text(accessor.Offset)));
            return false;
        }

        long length = document.Buffers[accessor.Buffer].ByteLength;
        if (byteCount > length - accessor.Offset)
        {
            at.Report(
                field,
                DiagnosticCodes.BufferOverrun,
                ("end", ((ulong)accessor.Offset + (ulong)byteCount).ToString(CultureInfo.InvariantCulture)), // beyond a long where the offset is absurd
                ("length", Invariant.Text(length)));
            return false;
        }

        return usable[accessor.Buffer];
    }

    /// <summary>Every index names a vertex.</summary>
    internal static void IndexRange(Mesh mesh, ReadOnlySpan<byte> indices, in Place at)
    {
        uint largest = mesh.IndexFormat == IndexFormat.UInt16
            ? Largest(MemoryMarshal.Cast<byte, ushort>(indices))
            : Largest(MemoryMarshal.Cast<byte, uint>(indices));
        if (largest >= mesh.VertexCount)
            at.Report("indices", DiagnosticCodes.MeshIndexRange, ("index", Invariant.Text(largest)), ("count", Invariant.Text(mesh.VertexCount)));
    }

    /// <summary>Positions are numbers: NaN breaks Unity's bounds and hulls.</summary>
    internal static void FinitePositions(ReadOnlySpan<byte> positions, in Place at)
    {
        ReadOnlySpan<uint> bits = MemoryMarshal.Cast<byte, uint>(positions);
        for (int i = 0; i < bits.Length; i++)
        {
            const uint exponent = 0x7F800000;
            if ((bits[i] & exponent) == exponent)
            {
                at.Report("positions", DiagnosticCodes.MeshPositionNotFinite, ("vertex", Invariant.Text(i / 3)));
                return;
            }
        }
    }

    private static bool Present(SceneBuffer buffer, in Place at)
    {
        long found = buffer.Data?.Length ?? buffer.FoundLength;
        if (found < 0)
        {
            at.Report(buffer.Uri is null ? "" : "uri", DiagnosticCodes.BufferMissing, ("uri", buffer.Uri ?? "of this file"), ("detail", buffer.Fault ?? "nobody gave its bytes"));
            return false;
        }

        if (found == buffer.ByteLength)
            return true;
        at.Report("byteLength", DiagnosticCodes.BufferSize, ("found", Invariant.Text(found)), ("expected", Invariant.Text(buffer.ByteLength)));
        return false;
    }

    private static bool SameBytes(SceneBuffer buffer, in Place at, CancellationToken cancellation)
    {
        if (SceneBuffer.Hash(buffer.Data!.Value.Span, cancellation) == buffer.Sha256)
            return true;
        at.Report("sha256", DiagnosticCodes.BufferSha256, ("uri", buffer.Uri ?? "What lies in this file"));
        return false;
    }

    private static uint Largest(ReadOnlySpan<ushort> values)
    {
        ushort largest = 0;
        foreach (ushort value in values)
            largest = Math.Max(largest, value);
        return largest;
    }

    private static uint Largest(ReadOnlySpan<uint> values)
    {
        uint largest = 0;
        foreach (uint value in values)
            largest = Math.Max(largest, value);
        return largest;
    }
}
