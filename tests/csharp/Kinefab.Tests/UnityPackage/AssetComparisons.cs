using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using NUnit.Framework;
using Unity = UnityEngine;

namespace Kinefab.Tests.UnityPackage;

/// <summary>A mesh of the package against one of Unity's files.</summary>
internal static class MeshComparison
{
    public static void Same(string path, Unity.Mesh to, string at)
    {
        PrefabFile.Record from = PrefabFile.Read(path).Documents.Values.Single();
        at = $"{at} {System.IO.Path.GetFileName(path)}";
        int count = Int(from, "m_VertexData.m_VertexCount");
        Assert.That(to.vertexCount, Is.EqualTo(count), at);
        byte[] data = Convert.FromHexString(from["m_VertexData._typelessdata"]);
        Assert.That(to.vertices.SelectMany(v => new[] { v.x, v.y, v.z }), Is.EqualTo(Channel(from, data, 0, count)), at);
        if (Channel(from, data, 1, count) is { Length: > 0 } normals)
            Assert.That(to.normals.SelectMany(v => new[] { v.x, v.y, v.z }), Is.EqualTo(normals), at);
        Assert.That(to.tangents.SelectMany(v => new[] { v.x, v.y, v.z, v.w }), Is.EqualTo(Channel(from, data, 2, count)), at);
        Assert.That(to.colors.SelectMany(v => new[] { v.r, v.g, v.b, v.a }), Is.EqualTo(Channel(from, data, 3, count)), at);
        for (int set = 0; set < 8; set++)
        {
            List<Unity.Vector2> uv = [];
            to.GetUVs(set, uv);
            Assert.That(uv.SelectMany(v => new[] { v.x, v.y }), Is.EqualTo(Channel(from, data, 4 + set, count)), at);
        }

        byte[] indices = Convert.FromHexString(from["m_IndexBuffer"]);
        int width = from["m_IndexFormat"] == "0" ? 2 : 4;
        int[] all = [.. Enumerable.Range(0, indices.Length / width).Select(i => width == 2 ? BitConverter.ToUInt16(indices, 2 * i) : BitConverter.ToInt32(indices, 4 * i))];
        int start = 0;
        for (int i = 0; i < to.subMeshCount; i++)
        {
            int size = Int(from, $"m_SubMeshes.{i}.indexCount");
            Assert.That(to.GetTriangles(i), Is.EqualTo(all.Skip(start).Take(size)), at);
            start += size;
        }

        Assert.That(start, Is.EqualTo(all.Length), at);
    }

    private static float[] Channel(PrefabFile.Record from, byte[] data, int channel, int count)
    {
        int width = Int(from, $"m_VertexData.m_Channels.{channel}.dimension"), offset = Int(from, $"m_VertexData.m_Channels.{channel}.offset");
        if (width == 0 || count == 0)
            return [];
        int stride = data.Length / count;
        return [.. Enumerable.Range(0, count * width).Select(i => BitConverter.ToSingle(data, i / width * stride + offset + 4 * (i % width)))];
    }

    private static int Int(PrefabFile.Record from, string field) => int.Parse(from[field], CultureInfo.InvariantCulture);
}

/// <summary>A physics material of the package against one of Unity's files.</summary>
internal static class PhysicsMaterialComparison
{
    private static readonly string[] Fields = ["dynamicFriction", "staticFriction", "bounciness", "frictionCombine", "bounceCombine"];

    public static void Same(string path, Unity.PhysicsMaterial to, string at)
    {
        PrefabFile.Record from = PrefabFile.Read(path).Documents.Values.Single();
        double[] expected = [.. Fields.Select(f => double.Parse(from.Fields.GetValueOrDefault(f) ?? from[$"m_{char.ToUpperInvariant(f[0])}{f[1..]}"], CultureInfo.InvariantCulture))];
        Assert.That(new double[] { to.dynamicFriction, to.staticFriction, to.bounciness, (int)to.frictionCombine, (int)to.bounceCombine }, Is.EqualTo(expected).Within(1e-6), at);
    }
}

/// <summary>A clip of the package against one of Unity's files: every key of every curve.</summary>
internal static class ClipComparison
{
    public static void Same(string path, Unity.AnimationClip to, string at)
    {
        PrefabFile.Record from = PrefabFile.Read(path).Documents.Values.Single();
        at = $"{at} {System.IO.Path.GetFileName(path)}";
        Assert.That((int)to.wrapMode, Is.EqualTo((int)Number(from, "m_WrapMode")), at);
        int curves = 0;
        foreach ((string kind, string property, string axes) in new[] { ("m_RotationCurves", "localRotation.", "xyzw"), ("m_PositionCurves", "localPosition.", "xyz") })
        {
            for (int i = 0; from.Fields.ContainsKey($"{kind}.{i}.path"); i++)
            {
                foreach (char axis in axes)
                {
                    curves++;
                    Unity.Keyframe[] keys = to.Curves[(from[$"{kind}.{i}.path"], typeof(Unity.Transform), property + axis)].keys;
                    for (int k = 0; k < keys.Length; k++)
                    {
                        string key = $"{kind}.{i}.curve.m_Curve.{k}.";
                        Assert.That(
                            new double[] { keys[k].time, keys[k].value, keys[k].inTangent, keys[k].outTangent },
                            Is.EqualTo(new[] { Number(from, key + "time"), Number(from, $"{key}value.{axis}"), Number(from, $"{key}inSlope.{axis}"), Number(from, $"{key}outSlope.{axis}") }).Within(2e-5),
                            $"{at} {property}{axis} {k}");
                    }

                    Assert.That(from.Fields.ContainsKey($"{kind}.{i}.curve.m_Curve.{keys.Length}.time"), Is.False, at);
                }
            }
        }

        Assert.That(to.Curves, Has.Count.EqualTo(curves), at);
    }

    private static double Number(PrefabFile.Record from, string field) => double.Parse(from[field], CultureInfo.InvariantCulture);
}
