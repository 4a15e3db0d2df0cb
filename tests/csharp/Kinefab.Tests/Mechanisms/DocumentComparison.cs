using System;
using System.Collections;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Text.Json.Nodes;
using Kinefab.Document;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace Kinefab.Tests.Mechanisms;

/// <summary>Holds two documents against each other, every field of every object.</summary>
internal sealed class DocumentComparison
{
    // What is about the file; reports say in other words what was lost.
    private static readonly HashSet<string> LeftOut = [nameof(SceneDocument.Report), nameof(SceneDocument.Generator), nameof(SceneDocument.Version), nameof(SceneDocument.Buffers), nameof(SceneDocument.Source), nameof(SceneDocument.Meshes)];

    // Relative, and of numbers below 1 absolute: files are rounded to twelve digits, and what is worked out from them is not.
    private const double Close = 1e-9;

    // Metres: meshes are in 32 bits.
    private const double Reached = 1e-6;

    private readonly (ValidScene One, ValidScene Other) documents;

    public DocumentComparison(ValidScene one, ValidScene other) => documents = (one, other);

    /// <summary>Where they differ, with both values.</summary>
    public List<string> Apart { get; } = [];

    /// <summary>How many fields were compared.</summary>
    public int Compared { get; private set; }

    public void Same(string at) => Same(documents.One.Document, documents.Other.Document, at);

    private void Same(object? one, object? other, string at)
    {
        switch (one, other)
        {
            case (null, null):
                return;
            case (double x, double y):
                Check(x.Equals(y) || Math.Abs(x - y) <= Close * Math.Max(1, Math.Abs(x)), x, y, at);
                return;
            case (Vector3d x, Vector3d y):
                Check((x - y).Length <= Close * Math.Max(1, x.Length), x, y, at);
                return;
            case (Quaterniond x, Quaterniond y):
                // Near half a turn a rounded w decides about the sign.
                Check(Math.Min(Apartness(x, y, 1), Apartness(x, y, -1)) <= Close, x, y, at);
                return;
            case (string x, string y):
                Check(x == y || (at.EndsWith(nameof(DocumentObject.ExtrasJson), StringComparison.Ordinal) && JsonNode.DeepEquals(JsonNode.Parse(x), JsonNode.Parse(y))), x, y, at);
                return;
            case (Collider x, Collider y) when x is MeshCollider || y is MeshCollider:
                SameShape(x, y, at);
                return;
            case (DocumentObject x, DocumentObject y) when x.GetType() == y.GetType():
                foreach (PropertyInfo field in x.GetType().GetProperties(BindingFlags.Public | BindingFlags.Instance).Where(p => p.GetIndexParameters().Length == 0 && !LeftOut.Contains(p.Name)))
                    Same(field.GetValue(x), field.GetValue(y), $"{at}.{field.Name}");
                return;
            case (IList x, IList y) when x.Count == y.Count:
                for (int i = 0; i < x.Count; i++)
                    Same(x[i], y[i], $"{at}[{i}]");
                return;
            case (IReadOnlyDictionary<string, string> x, IReadOnlyDictionary<string, string> y):
                Check(x.OrderBy(p => p.Key).SequenceEqual(y.OrderBy(p => p.Key)), x, y, at);
                return;
            default:
                Check(Equals(one, other), one, other, at);
                return;
        }
    }

    // Where the export makes a hull, a link's collider is the mesh that Unity makes one of: what collides is the same.
    private void SameShape(Collider one, Collider other, string at)
    {
        const int Directions = 40;
        Check((one is MeshCollider { Convex: true } or BoxCollider) == (other is MeshCollider { Convex: true } or BoxCollider), one, other, at);
        Same((one.IsTrigger, one.Enabled, one.Material, one.Group, one.Id), (other.IsTrigger, other.Enabled, other.Material, other.Group, other.Id), at);
        for (int i = 0; i < Directions; i++)
        {
            double up = 1 - (2 * i + 1.0) / Directions, flat = Math.Sqrt(1 - up * up), turn = i * 2.399963229728653;
            var direction = new Vector3d(flat * Math.Cos(turn), up, flat * Math.Sin(turn));
            double x = Reach(documents.One, one, direction), y = Reach(documents.Other, other, direction);
            Check(Math.Abs(x - y) <= Reached * Math.Max(1, Math.Abs(x)), x, y, $"{at} towards {direction}");
        }
    }

    private static double Reach(ValidScene scene, Collider collider, Vector3d direction)
    {
        if (collider is BoxCollider box)
            return Vector3d.Dot(box.Center, direction) + 0.5 * (Math.Abs(box.Size.X * direction.X) + Math.Abs(box.Size.Y * direction.Y) + Math.Abs(box.Size.Z * direction.Z));
        ReadOnlySpan<float> points = scene.Mesh(((MeshCollider)collider).Mesh).Positions;
        double reach = double.NegativeInfinity;
        for (int i = 0; i < points.Length; i += 3)
            reach = Math.Max(reach, Vector3d.Dot(new Vector3d(points[i], points[i + 1], points[i + 2]), direction));
        return reach;
    }

    private static double Apartness(Quaterniond x, Quaterniond y, double sign) =>
        Math.Abs(x.X - sign * y.X) + Math.Abs(x.Y - sign * y.Y) + Math.Abs(x.Z - sign * y.Z) + Math.Abs(x.W - sign * y.W);

    private void Check(bool isSame, object? one, object? other, string at)
    {
        Compared++;
        if (!isSame)
            Apart.Add($"{at}: {one ?? "nothing"}, {other ?? "nothing"}");
    }
}
